// hdf5_edits.cpp: see hdf5_edits.h. An edit is a byte that chooses what is done, then what that needs.
// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/hdf5_edits.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <vector>

namespace scree::fuzz {
namespace {

struct Object {
  std::string path;
  H5O_type_t type;
};

// In alphabetical order; the same file always gives the same list.
std::vector<Object> objects(hid_t file) {
  std::vector<Object> found;
  auto const visit = [](hid_t, char const* name, H5O_info_t const* info, void* out) -> herr_t {
    static_cast<std::vector<Object>*>(out)->push_back({"/" + std::string(name[0] == '.' ? "" : name), info->type});
    return 0;
  };
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, visit, &found, H5O_INFO_BASIC);
  return found;
}

std::vector<Object> of_type(std::vector<Object> const& all, H5O_type_t type) {
  std::vector<Object> out;
  for (Object const& o : all)
    if (o.type == type) out.push_back(o);
  return out;
}

std::string attribute_name(hid_t object, std::size_t index) {
  char name[256] = "";
  H5Aget_name_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, index, name, sizeof(name), H5P_DEFAULT);
  return name;
}

hdf5::Handle file_type(FuzzInput& in) {
  hid_t const numbers[] = {H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_STD_I32LE, H5T_STD_I64LE, H5T_STD_U8LE, H5T_STD_U64BE};
  int const which = in.byte() % 8;
  if (which < 6) return {H5Tcopy(numbers[which]), H5Tclose, "type"};
  hdf5::Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "type");
  std::size_t const sizes[] = {1, 2, 7, 300, 1 << 20, std::size_t{1} << 31};
  H5Tset_size(type, which == 6 ? sizes[in.index(6)] : H5T_VARIABLE);
  return type;
}

std::vector<hsize_t> extent(FuzzInput& in) {
  hsize_t const sizes[] = {0, 1, 2, 3, 4, 9, 100, 4097, 1 << 16, 1 << 26, hsize_t{1} << 31, hsize_t{1} << 40};
  std::vector<hsize_t> out(static_cast<std::size_t>(in.byte() % 5));
  for (hsize_t& n : out) n = sizes[in.index(12)];
  return out;
}

// Eight bytes of any type: a number that is often wrong somewhere, or raw.
double number(FuzzInput& in) {
  using Limits = std::numeric_limits<double>;
  double const known[] = {0,
                          -1,
                          1,
                          2,
                          3,
                          1 << 24,
                          -(1 << 30),
                          2147483647.0,
                          1e9,
                          0.25,
                          1e-9,
                          1e300,
                          Limits::quiet_NaN(),
                          Limits::infinity(),
                          -Limits::infinity(),
                          Limits::denorm_min()};
  std::size_t const which = static_cast<std::size_t>(in.byte()) % 20;
  return which < 16 ? known[which] : in.number<double>();
}

// A new dataset or attribute in place of an old one; filled where it is small.
void replace_dataset(hid_t file, std::string const& path, FuzzInput& in) {
  hdf5::Handle const type = file_type(in);
  std::vector<hsize_t> const size = extent(in);
  H5Ldelete(file, path.c_str(), H5P_DEFAULT);
  hdf5::Handle const space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose, "space");
  hdf5::Handle const set(H5Dcreate2(file, path.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
                         "dataset");
  hsize_t count = 1;
  for (hsize_t const n : size) count = std::min<hsize_t>(count, 4097) * std::min<hsize_t>(n, 4097);  // capped
  if (count == 0 || count > 4096 || H5Tget_class(type) == H5T_STRING) return;
  std::vector<double> value(count);
  for (double& v : value) v = number(in);
  H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data());
}

void replace_attribute(hid_t object, std::string const& name, FuzzInput& in) {
  hdf5::Handle const type = file_type(in);
  std::vector<hsize_t> size = extent(in);
  for (hsize_t& n : size) n = std::min<hsize_t>(n, 9);  // attributes lie in the header
  if (H5Tget_class(type) == H5T_STRING && !H5Tis_variable_str(type) && H5Tget_size(type) > 1000) return;
  H5Adelete(object, name.c_str());
  hdf5::Handle const space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose, "space");
  hdf5::Handle const attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                               "attribute");
  if (H5Tget_class(type) == H5T_STRING) {
    std::string text = in.text();
    text.resize(H5Tget_size(type) * 10000);
    if (!H5Tis_variable_str(type)) H5Awrite(attribute, type, text.data());
    return;
  }
  std::vector<double> value(6561);
  for (std::size_t i = 0; i < 9; ++i) value[i] = number(in);
  H5Awrite(attribute, H5T_NATIVE_DOUBLE, value.data());
}

// One number of a dataset.
void set_number(hid_t file, std::string const& path, FuzzInput& in) {
  hdf5::Handle const set(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, "dataset");
  hdf5::Handle const space(H5Dget_space(set), H5Sclose, "space");
  hdf5::Handle const type(H5Dget_type(set), H5Tclose, "type");
  hssize_t const count = H5Sget_simple_extent_npoints(space);
  if (H5Tget_class(type) == H5T_STRING || count <= 0 || count > 1 << 16) return;
  std::vector<double> value(static_cast<std::size_t>(count));
  H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data());
  value[in.index(value.size())] = number(in);
  H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data());
}

void edit(hid_t file, FuzzInput& in) {
  int const what = in.byte() % 9;
  std::vector<Object> const all = objects(file), sets = of_type(all, H5O_TYPE_DATASET),
                            groups = of_type(all, H5O_TYPE_GROUP);
  Object const any = all[in.index(all.size())];
  if (what < 2 && sets.empty()) return;
  std::string const set = sets.empty() ? "" : sets[in.index(sets.size())].path;
  if (what == 0) return set_number(file, set, in);
  if (what == 1) return replace_dataset(file, set, in);
  if (what == 2) return void(H5Ldelete(file, any.path.c_str(), H5P_DEFAULT));
  if (what == 3 || what == 4 || what == 5) {
    hdf5::Handle const object(H5Oopen(file, any.path.c_str(), H5P_DEFAULT), H5Oclose, "object");
    H5O_info_t info;
    H5Oget_info2(object, &info, H5O_INFO_NUM_ATTRS);
    std::string const name = attribute_name(object, in.index(info.num_attrs));
    if (name.empty()) return;
    if (what == 3) return void(H5Adelete(object, name.c_str()));
    return replace_attribute(object, name, in);
  }
  // A second name for an object, perhaps inside itself or a mere promise, or another name.
  std::string const into = groups[in.index(groups.size())].path + "/" + in.text();
  if (what == 8) H5Lcreate_soft(any.path.c_str(), file, into.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  if (what == 6) H5Lcreate_hard(file, any.path.c_str(), file, into.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  if (what == 7) H5Lmove(file, any.path.c_str(), file, into.c_str(), H5P_DEFAULT, H5P_DEFAULT);
}

// Until the bytes end.
void apply_edits(hid_t file, FuzzInput& in) {
  for (int i = 0; i < 16 && !in.empty(); ++i) {
    try {
      edit(file, in);
    } catch (std::runtime_error const&) {
      // HDF5 refuses some edits
    }
  }
}

}  // namespace

EditedFile::EditedFile(std::function<void(hid_t)> const& write, FuzzInput& in)
    : name_((std::filesystem::temp_directory_path() / "scree_fuzz_XXXXXX").string()) {
  int const descriptor = ::mkstemp(name_.data());
  must(descriptor >= 0, "there is room for a temporary file");
  ::close(descriptor);
  hdf5::Handle const access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "access");
  H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST);  // as create_file
  hdf5::Handle file(H5Fcreate(name_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, "file");
  write(file);
  apply_edits(file, in);
  file.close("an edited file cannot be written");
}

EditedFile::~EditedFile() { ::unlink(name_.c_str()); }

}  // namespace scree::fuzz

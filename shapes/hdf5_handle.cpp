// hdf5_handle.cpp: see hdf5_handle.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/hdf5_handle.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "shapes/file_container.h"

namespace scree::hdf5 {
namespace {

std::string quoted(char const* name) { return "'" + std::string(name) + "'"; }

void require(bool ok, std::string const& what) {
  if (!ok) throw Error(what);
}

// A file that cannot be written (full disk) cannot be closed either; HDF5 then tries again when the process exits, and
// crashes. We close every file by ourselves. Takes effect when it comes before the first use of HDF5.
[[maybe_unused]] bool const left_alone_at_exit = H5dont_atexit() >= 0;

hsize_t constexpr largest_array = 1 << 26;  // numbers; far above any file of ours, far below what would exhaust memory

Handle scalar_or_vector(int count) {
  hsize_t const dimension = static_cast<hsize_t>(count);
  return {H5Screate_simple(1, &dimension, nullptr), H5Sclose, "cannot make a data space"};
}

Handle open_attribute(hid_t at, char const* name) {
  require(has_attribute(at, name), "attribute " + quoted(name) + " is missing");
  return {H5Aopen(at, name, H5P_DEFAULT), H5Aclose, "cannot open attribute " + quoted(name)};
}

// Number of elements and class of an attribute.
hssize_t elements(hid_t attribute) {
  Handle const space(H5Aget_space(attribute), H5Sclose, "cannot read an attribute's size");
  return H5Sget_simple_extent_npoints(space);
}
bool is_class(hid_t attribute, H5T_class_t wanted) {
  Handle const type(H5Aget_type(attribute), H5Tclose, "cannot read an attribute's type");
  return H5Tget_class(type) == wanted;
}

}  // namespace

Handle::Handle(hid_t id, herr_t (*close)(hid_t), std::string const& what) : id_(id), close_(close) {
  require(id >= 0, what);
}
Handle::~Handle() {
  if (id_ < 0) return;
  QuietErrors const quiet;  // the exception that brought us here has said it
  close_(id_);
}
Handle& Handle::operator=(Handle&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(close_, other.close_);
  return *this;
}
void Handle::close(std::string const& what) {
  hid_t const id = id_;
  id_ = -1;
  require(id < 0 || close_(id) >= 0, what);
}

QuietErrors::QuietErrors() {
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}
QuietErrors::~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

Error::Error(std::string const& what) : std::runtime_error(what), system_(0) {
  // Only the entry of the file driver has it: "..., errno = 28, error message = 'No space left on device', ...".
  auto const visit = [](unsigned, H5E_error2_t const* entry, void* out) -> herr_t {
    char const* const at = entry->desc ? std::strstr(entry->desc, "errno = ") : nullptr;
    if (at) std::sscanf(at, "errno = %d", static_cast<int*>(out));
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, visit, &system_);
}

void rethrow_as_write_error(std::string const& file) {
  try {
    throw;
  } catch (std::system_error const& e) {
    if (std::string(e.what()).starts_with(file)) throw;  // a temporary file's name begins like it, too
    throw std::system_error(e.code(), file);
  } catch (Error const& e) {
    throw std::system_error(e.system() ? e.system() : EIO, std::generic_category(), file + ": " + e.what());
  }
}

Handle create_file(std::string const& file) {
  Handle const creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "cannot set up a file");
  require(H5Pset_userblock(creation, container_block_size) >= 0, "cannot reserve the user block");
  Handle const access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "cannot set up a file");
  // The 1.8 format and later: compact groups and attributes, a third of the size.
  require(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST) >= 0, "cannot set the file format");
  return {H5Fcreate(file.c_str(), H5F_ACC_EXCL, creation, access), H5Fclose,
          "cannot be created; is the folder writable?"};
}

Handle open_file(std::string const& file) {
  return {H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "HDF5 cannot open it"};
}

Handle open_image(void const* bytes, std::size_t size) {
  Handle const access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "cannot set up a file");
  require(H5Pset_fapl_core(access, 1 << 16, 0) >= 0 && H5Pset_file_image(access, const_cast<void*>(bytes), size) >= 0,
          "cannot set up a file in memory");
  return {H5Fopen("in memory", H5F_ACC_RDONLY, access), H5Fclose, "HDF5 cannot open it"};
}

Handle create_group(hid_t file, std::string const& path) {
  if (has_group(file, path)) return open_group(file, path);
  Handle const links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "cannot set up a group");
  require(H5Pset_create_intermediate_group(links, 1) >= 0, "cannot set up a group");
  return {H5Gcreate2(file, path.c_str(), links, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "cannot create group " + path};
}
Handle open_group(hid_t file, std::string const& path) {
  return {H5Gopen2(file, path.c_str(), H5P_DEFAULT), H5Gclose, "group " + path + " is missing"};
}
bool has_group(hid_t file, std::string const& path) {
  if (H5Lexists(file, path.c_str(), H5P_DEFAULT) <= 0) return false;
  H5O_info_t info;
  return H5Oget_info_by_name(file, path.c_str(), &info, H5P_DEFAULT) >= 0 && info.type == H5O_TYPE_GROUP;
}
haddr_t address(hid_t group) {
  H5O_info_t info;
  require(H5Oget_info2(group, &info, H5O_INFO_BASIC) >= 0, "cannot read a group");
  return info.addr;
}
std::vector<std::string> group_names(hid_t group) {
  std::vector<std::string> names;
  auto const visit = [](hid_t at, char const* name, H5L_info_t const*, void* out) -> herr_t {
    if (has_group(at, name)) static_cast<std::vector<std::string>*>(out)->push_back(name);
    return 0;
  };
  require(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &names) >= 0, "cannot list a group");
  std::sort(names.begin(), names.end());
  return names;
}

void write_attribute(hid_t at, char const* name, double const* value, int count) {
  Handle const space = scalar_or_vector(count);
  Handle const attribute(H5Acreate2(at, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "cannot create attribute " + quoted(name));
  require(H5Awrite(attribute, H5T_NATIVE_DOUBLE, value) >= 0, "cannot write attribute " + quoted(name));
}
void write_attribute(hid_t at, char const* name, std::int64_t value) {
  Handle const space = scalar_or_vector(1);
  Handle const attribute(H5Acreate2(at, name, H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "cannot create attribute " + quoted(name));
  require(H5Awrite(attribute, H5T_NATIVE_INT64, &value) >= 0, "cannot write attribute " + quoted(name));
}
void write_attribute(hid_t at, char const* name, std::string const& value) {
  Handle const type(H5Tcopy(H5T_C_S1), H5Tclose, "cannot make a string type");
  require(H5Tset_size(type, value.size() + 1) >= 0 && H5Tset_cset(type, H5T_CSET_UTF8) >= 0,
          "cannot make a string type");
  Handle const space(H5Screate(H5S_SCALAR), H5Sclose, "cannot make a data space");
  Handle const attribute(H5Acreate2(at, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "cannot create attribute " + quoted(name));
  require(H5Awrite(attribute, type, value.c_str()) >= 0, "cannot write attribute " + quoted(name));
}

bool has_attribute(hid_t at, char const* name) { return H5Aexists(at, name) > 0; }

std::vector<double> read_doubles(hid_t at, char const* name, int count) {
  Handle const attribute = open_attribute(at, name);
  hssize_t const n = elements(attribute);
  require(is_class(attribute, H5T_FLOAT), "attribute " + quoted(name) + " is not a floating-point number");
  require(n >= 0 && n < 1024 && (count < 0 || n == count),
          "attribute " + quoted(name) + " has " + std::to_string(n) + " numbers, not " + std::to_string(count));
  std::vector<double> value(static_cast<std::size_t>(n));
  require(H5Aread(attribute, H5T_NATIVE_DOUBLE, value.data()) >= 0, "cannot read attribute " + quoted(name));
  return value;
}
std::int64_t read_integer(hid_t at, char const* name) {
  Handle const attribute = open_attribute(at, name);
  require(is_class(attribute, H5T_INTEGER) && elements(attribute) == 1,
          "attribute " + quoted(name) + " is not one integer");
  std::int64_t value = 0;
  require(H5Aread(attribute, H5T_NATIVE_INT64, &value) >= 0, "cannot read attribute " + quoted(name));
  return value;
}
std::string read_string(hid_t at, char const* name) {
  Handle const attribute = open_attribute(at, name);
  Handle const type(H5Aget_type(attribute), H5Tclose, "cannot read an attribute's type");
  require(H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 && elements(attribute) == 1,
          "attribute " + quoted(name) + " is not a fixed-length string");
  std::size_t const size = H5Tget_size(type);
  require(size < 1 << 20, "attribute " + quoted(name) + " is too long");
  std::string value(size + 1, '\0');
  require(H5Aread(attribute, type, value.data()) >= 0, "cannot read attribute " + quoted(name));
  return value.c_str();
}

namespace {

// In the file, in memory, and in words.
template <class T>
struct NumberType;
template <>
struct NumberType<float> {
  static hid_t file() { return H5T_IEEE_F32LE; }
  static hid_t memory() { return H5T_NATIVE_FLOAT; }
  static H5T_class_t constexpr kind = H5T_FLOAT;
  static char constexpr words[] = "floating-point numbers";
};
template <>
struct NumberType<double> {
  static hid_t file() { return H5T_IEEE_F64LE; }
  static hid_t memory() { return H5T_NATIVE_DOUBLE; }
  static H5T_class_t constexpr kind = H5T_FLOAT;
  static char constexpr words[] = "floating-point numbers";
};
template <>
struct NumberType<int> {
  static hid_t file() { return H5T_STD_I32LE; }
  static hid_t memory() { return H5T_NATIVE_INT; }
  static H5T_class_t constexpr kind = H5T_INTEGER;
  static char constexpr words[] = "whole numbers";
};

}  // namespace

template <class T>
void write_table(hid_t at, char const* name, Table<T> const& array) {
  hsize_t const dimension[2] = {static_cast<hsize_t>(array.rows), static_cast<hsize_t>(std::max(array.columns, 0))};
  Handle const space(H5Screate_simple(array.columns < 0 ? 1 : 2, dimension, nullptr), H5Sclose,
                     "cannot make a data space");
  Handle const dataset(H5Dcreate2(at, name, NumberType<T>::file(), space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       H5Dclose, "cannot create dataset " + quoted(name));
  require(H5Dwrite(dataset, NumberType<T>::memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, array.value.data()) >= 0,
          "cannot write dataset " + quoted(name));
}
bool has_dataset(hid_t at, char const* name) {
  if (H5Lexists(at, name, H5P_DEFAULT) <= 0) return false;
  H5O_info_t info;
  return H5Oget_info_by_name(at, name, &info, H5P_DEFAULT) >= 0 && info.type == H5O_TYPE_DATASET;
}
void require_stored(hid_t dataset, char const* name) {
  Handle const type(H5Dget_type(dataset), H5Tclose, "cannot read the type of dataset " + quoted(name));
  Handle const space(H5Dget_space(dataset), H5Sclose, "cannot read the size of dataset " + quoted(name));
  hssize_t const count = H5Sget_simple_extent_npoints(space);
  hsize_t const stored = H5Dget_storage_size(dataset) / std::max<std::size_t>(H5Tget_size(type), 1);
  require(count >= 0 && static_cast<hsize_t>(count) <= stored,
          "dataset " + quoted(name) + " promises more than it holds");
}
template <class T>
Table<T> read_table(hid_t at, char const* name, int rank) {
  require(has_dataset(at, name), "dataset " + quoted(name) + " is missing");
  Handle const dataset(H5Dopen2(at, name, H5P_DEFAULT), H5Dclose, "cannot open dataset " + quoted(name));
  Handle const type(H5Dget_type(dataset), H5Tclose, "cannot read the type of dataset " + quoted(name));
  Handle const space(H5Dget_space(dataset), H5Sclose, "cannot read the size of dataset " + quoted(name));
  require(H5Tget_class(type) == NumberType<T>::kind,
          "dataset " + quoted(name) + " does not hold " + NumberType<T>::words);
  require(H5Sget_simple_extent_ndims(space) == rank,
          "dataset " + quoted(name) + " does not have rank " + std::to_string(rank));
  hsize_t dimension[2] = {0, 1};
  H5Sget_simple_extent_dims(space, dimension, nullptr);
  require(dimension[0] < largest_array && dimension[1] < largest_array && dimension[0] * dimension[1] < largest_array,
          "dataset " + quoted(name) + " is too large");
  require_stored(dataset, name);
  Table<T> array;
  array.rows = static_cast<int>(dimension[0]);
  array.columns = rank == 2 ? static_cast<int>(dimension[1]) : -1;
  array.value.resize(dimension[0] * dimension[1]);
  if (!array.value.empty())
    require(H5Dread(dataset, NumberType<T>::memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, array.value.data()) >= 0,
            "cannot read dataset " + quoted(name));
  return array;
}

template void write_table(hid_t, char const*, Table<float> const&);
template void write_table(hid_t, char const*, Table<double> const&);
template void write_table(hid_t, char const*, Table<int> const&);
template Table<float> read_table(hid_t, char const*, int);
template Table<double> read_table(hid_t, char const*, int);
template Table<int> read_table(hid_t, char const*, int);

}  // namespace scree::hdf5

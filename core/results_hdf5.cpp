// results_hdf5.cpp: see results_hdf5.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/results_hdf5.h"

#include <algorithm>

namespace scree::results_hdf5 {
namespace {

void require(bool ok, std::string const& what) {
  if (!ok) throw hdf5::Error(what);
}

std::string dataset_named(char const* name) { return "dataset '" + std::string(name) + "'"; }

hdf5::Handle make_space(Extent const& extent, Extent const& largest = {}) {
  hid_t const id = extent.empty() ? H5Screate(H5S_SCALAR)
                                  : H5Screate_simple(static_cast<int>(extent.size()), extent.data(),
                                                     largest.empty() ? nullptr : largest.data());
  return {id, H5Sclose, "cannot make a data space"};
}

hdf5::Handle text_type(std::size_t size) {
  hdf5::Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "cannot make a string type");
  require(H5Tset_size(type, std::max<std::size_t>(size, 1)) >= 0 && H5Tset_strpad(type, H5T_STR_NULLPAD) >= 0 &&
              H5Tset_cset(type, H5T_CSET_UTF8) >= 0,
          "cannot make a string type");
  return type;
}

Extent extent_of(hid_t dataset, char const* name) {
  hdf5::Handle const space(H5Dget_space(dataset), H5Sclose, "cannot read the size of " + dataset_named(name));
  int const rank = H5Sget_simple_extent_ndims(space);
  require(rank >= 0 && rank <= 3, dataset_named(name) + " has a rank that is not ours");
  Extent extent(static_cast<std::size_t>(rank));
  if (rank > 0) H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  return extent;
}

// Text type of a dataset that holds fixed-length strings.
hdf5::Handle checked_text_type(hid_t dataset, char const* name) {
  hdf5::Handle type(H5Dget_type(dataset), H5Tclose, "cannot read the type of " + dataset_named(name));
  require(H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0, dataset_named(name) + " is not a text");
  return type;
}

Extent rows_extent(Extent const& inner, hsize_t count) {
  Extent extent{count};
  extent.insert(extent.end(), inner.begin(), inner.end());
  return extent;
}

// The data space of `dataset` with `count` rows selected.
hdf5::Handle row_selection(hid_t dataset, char const* name, Extent const& inner, hsize_t row, hsize_t count) {
  hdf5::Handle space(H5Dget_space(dataset), H5Sclose, "cannot read the size of " + dataset_named(name));
  Extent start(inner.size() + 1, 0);
  start[0] = row;
  require(
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, rows_extent(inner, count).data(), nullptr) >= 0,
      "cannot select rows of " + dataset_named(name));
  return space;
}

bool is_empty(Extent const& inner) { return std::find(inner.begin(), inner.end(), 0u) != inner.end(); }

}  // namespace

hdf5::Handle open_dataset(hid_t at, char const* name) {
  require(hdf5::has_dataset(at, name), dataset_named(name) + " is missing");
  return {H5Dopen2(at, name, H5P_DEFAULT), H5Dclose, "cannot open " + dataset_named(name)};
}

hsize_t checked_rows(hid_t dataset, char const* name, Extent const& inner) {
  Extent const extent = extent_of(dataset, name);
  bool const fits = extent.size() == inner.size() + 1 && std::equal(inner.begin(), inner.end(), extent.begin() + 1);
  require(fits, dataset_named(name) + " does not have the shape it must have");
  return extent[0];
}

void write_raw(hid_t at, char const* name, hid_t file_type, hid_t memory_type, void const* data, Extent const& extent) {
  hdf5::Handle const space = make_space(extent);
  hdf5::Handle const dataset(H5Dcreate2(at, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
                             "cannot create " + dataset_named(name));
  if (is_empty(extent)) return;
  require(H5Dwrite(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0,
          "cannot write " + dataset_named(name));
}

void read_raw(hid_t dataset, char const* name, hid_t memory_type, void* data) {
  require(H5Dread(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0,
          "cannot read " + dataset_named(name));
}

void write_text(hid_t at, char const* name, std::string const& text) {
  std::string const padded = text.empty() ? std::string(1, '\0') : text;
  hdf5::Handle const type = text_type(padded.size());
  write_raw(at, name, type, type, padded.data(), {});
}

std::string read_text(hid_t at, char const* name) {
  hdf5::Handle const dataset = open_dataset(at, name);
  hdf5::Handle const type = checked_text_type(dataset, name);
  require(extent_of(dataset, name).empty(), dataset_named(name) + " is not one text");
  hdf5::require_stored(dataset, name);
  std::string text(H5Tget_size(type), '\0');
  read_raw(dataset, name, type, text.data());
  text.erase(text.find_last_not_of('\0') + 1);
  return text;
}

void write_texts(hid_t at, char const* name, std::vector<std::string> const& texts) {
  std::size_t width = 1;
  for (std::string const& t : texts) width = std::max(width, t.size());
  std::string packed;
  for (std::string const& t : texts) packed += t + std::string(width - t.size(), '\0');
  hdf5::Handle const type = text_type(width);
  write_raw(at, name, type, type, packed.data(), {texts.size()});
}

std::vector<std::string> read_texts(hid_t at, char const* name) {
  hdf5::Handle const dataset = open_dataset(at, name);
  hdf5::Handle const type = checked_text_type(dataset, name);
  std::size_t const width = H5Tget_size(type), count = checked_rows(dataset, name, {});
  hdf5::require_stored(dataset, name);
  std::string packed(width * count, '\0');
  if (count > 0) read_raw(dataset, name, type, packed.data());
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < count; ++i) {
    std::string text = packed.substr(i * width, width);
    text.erase(text.find_last_not_of('\0') + 1);
    texts.push_back(std::move(text));
  }
  return texts;
}

hdf5::Handle create_series(hid_t at, char const* name, Extent const& inner, hid_t type, hsize_t chunk_rows) {
  Extent const extent = rows_extent(inner, 0), largest = rows_extent(inner, H5S_UNLIMITED);
  // A row of one number a frame would cost a chunk of its own.
  Extent chunk = rows_extent(inner, chunk_rows > 0 ? chunk_rows : inner.empty() ? 256 : 1);
  for (hsize_t& n : chunk) n = std::max<hsize_t>(n, 1);
  hdf5::Handle const space = make_space(extent, largest);
  hdf5::Handle const layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "cannot set up " + dataset_named(name));
  require(H5Pset_chunk(layout, static_cast<int>(chunk.size()), chunk.data()) >= 0,
          "cannot chunk " + dataset_named(name));
  return {H5Dcreate2(at, name, type, space, H5P_DEFAULT, layout, H5P_DEFAULT), H5Dclose,
          "cannot create " + dataset_named(name)};
}

void append_rows(hid_t dataset, char const* name, Extent const& inner, hsize_t row, hsize_t count, hid_t type,
                 void const* data) {
  require(H5Dset_extent(dataset, rows_extent(inner, row + count).data()) >= 0, "cannot grow " + dataset_named(name));
  if (count == 0 || is_empty(inner)) return;
  hdf5::Handle const selection = row_selection(dataset, name, inner, row, count);
  hdf5::Handle const memory = make_space(rows_extent(inner, count));
  require(H5Dwrite(dataset, type, memory, selection, H5P_DEFAULT, data) >= 0, "cannot write " + dataset_named(name));
}

void read_row(hid_t dataset, char const* name, Extent const& inner, hsize_t row, hid_t type, void* data) {
  if (is_empty(inner)) return;
  hdf5::Handle const selection = row_selection(dataset, name, inner, row, 1);
  hdf5::Handle const memory = make_space(rows_extent(inner, 1));
  require(H5Dread(dataset, type, memory, selection, H5P_DEFAULT, data) >= 0, "cannot read " + dataset_named(name));
}

}  // namespace scree::results_hdf5

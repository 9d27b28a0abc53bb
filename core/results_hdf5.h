// results_hdf5.h: arrays, texts and growing series of the results file, as typed reads and writes.
// Every function throws std::runtime_error naming the dataset; the file's name is added by the caller.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "shapes/hdf5_handle.h"

namespace scree::results_hdf5 {

// Element types on file (little-endian) and in memory.
template <class T>
struct Type;
template <>
struct Type<double> {
  static hid_t file() { return H5T_IEEE_F64LE; }
  static hid_t memory() { return H5T_NATIVE_DOUBLE; }
};
template <>
struct Type<std::int32_t> {
  static hid_t file() { return H5T_STD_I32LE; }
  static hid_t memory() { return H5T_NATIVE_INT32; }
};
template <>
struct Type<std::int64_t> {
  static hid_t file() { return H5T_STD_I64LE; }
  static hid_t memory() { return H5T_NATIVE_INT64; }
};
template <>
struct Type<std::uint8_t> {
  static hid_t file() { return H5T_STD_U8LE; }
  static hid_t memory() { return H5T_NATIVE_UINT8; }
};

using Extent = std::vector<hsize_t>;

void write_raw(hid_t at, char const* name, hid_t file_type, hid_t memory_type, void const* data, Extent const& extent);
// Opens the dataset and checks its rank and all extents but the first (-1 there: any). Returns the first extent.
hsize_t checked_rows(hid_t dataset, char const* name, Extent const& inner);
hdf5::Handle open_dataset(hid_t at, char const* name);
void read_raw(hid_t dataset, char const* name, hid_t memory_type, void* data);

// `data` holds the product of `extent` numbers, row-major.
template <class T>
void write_array(hid_t at, char const* name, T const* data, Extent const& extent) {
  write_raw(at, name, Type<T>::file(), Type<T>::memory(), data, extent);
}

// Rows of `inner` numbers each; all rows.
template <class T>
std::vector<T> read_array(hid_t at, char const* name, Extent const& inner = {}) {
  hdf5::Handle const dataset = open_dataset(at, name);
  hsize_t count = checked_rows(dataset, name, inner);
  for (hsize_t const n : inner) count *= n;
  hdf5::require_stored(dataset, name);
  std::vector<T> value(count);
  if (count > 0) read_raw(dataset, name, Type<T>::memory(), value.data());
  return value;
}

// Rows of numbers as Vec3 or Quat.
template <class V>
std::vector<V> as_vectors(std::vector<double> const& flat) {
  std::vector<V> out(flat.size() * sizeof(double) / sizeof(V));
  if (!flat.empty()) std::memcpy(static_cast<void*>(out.data()), flat.data(), flat.size() * sizeof(double));
  return out;
}

void write_text(hid_t at, char const* name, std::string const& text);
std::string read_text(hid_t at, char const* name);
void write_texts(hid_t at, char const* name, std::vector<std::string> const& texts);
std::vector<std::string> read_texts(hid_t at, char const* name);

// A dataset that grows by rows of `inner` numbers, `chunk` rows a chunk (0: one, and 256 of single numbers).
hdf5::Handle create_series(hid_t at, char const* name, Extent const& inner, hid_t type, hsize_t chunk);
// Rows row ... row + count - 1 behind the others.
void append_rows(hid_t dataset, char const* name, Extent const& inner, hsize_t row, hsize_t count, hid_t type,
                 void const* data);
void read_row(hid_t dataset, char const* name, Extent const& inner, hsize_t row, hid_t type, void* data);

template <class T>
class Series {
 public:
  Series() = default;
  Series(hid_t at, char const* name, Extent inner, hsize_t chunk = 0)
      : name_(name), inner_(std::move(inner)), dataset_(create_series(at, name, inner_, Type<T>::file(), chunk)) {}
  void append(T const* row, hsize_t count = 1) {
    append_rows(dataset_, name_.c_str(), inner_, rows_, count, Type<T>::memory(), row);
    rows_ += count;
  }
  hsize_t rows() const { return rows_; }

 private:
  std::string name_;
  Extent inner_;
  hsize_t rows_ = 0;
  hdf5::Handle dataset_;
};

}  // namespace scree::results_hdf5

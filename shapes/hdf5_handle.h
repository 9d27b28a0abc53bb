// hdf5_handle.h: ownership of HDF5 identifiers, and the few reads and writes our files are made of.
// Every function throws Error, a std::runtime_error, naming the object; file names are added by the caller.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace scree::hdf5 {

// Closes its identifier. Construction from a negative identifier throws `what`.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t), std::string const& what);
  ~Handle();
  Handle(Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
  Handle& operator=(Handle&& other) noexcept;
  operator hid_t() const { return id_; }
  // Close now and throw `what` if that fails: closing a file is what writes it.
  void close(std::string const& what);

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

// HDF5 prints its error stack to stderr by default; while this lives it does not. Exceptions carry what went wrong.
class QuietErrors {
 public:
  QuietErrors();
  ~QuietErrors();
  QuietErrors(QuietErrors const&) = delete;
  QuietErrors& operator=(QuietErrors const&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

// What HDF5 refused, and the system's reason for it (errno; 0: none known). All functions here throw it.
class Error : public std::runtime_error {
 public:
  explicit Error(std::string const& what);
  int system() const { return system_; }

 private:
  int system_;
};

// In a handler of whatever went wrong while `file` was written: throws std::system_error with its name and the cause.
[[noreturn]] void rethrow_as_write_error(std::string const& file);

// Does `work`, a part of writing `file`: without HDF5's prints, errors as rethrow_as_write_error has them.
template <class Work>
void write_guarded(std::string const& file, Work const& work) {
  QuietErrors const quiet;
  try {
    work();
  } catch (std::runtime_error const&) {
    rethrow_as_write_error(file);
  }
}

// A new file whose first 512 bytes belong to the container (file_container.h); an existing file that passed its check.
Handle create_file(std::string const& file);
Handle open_file(std::string const& file);
// A file's bytes, copied, to read.
Handle open_image(void const* bytes, std::size_t size);

// Groups by path; create_group makes the missing parents too and opens what exists.
Handle create_group(hid_t file, std::string const& path);
Handle open_group(hid_t file, std::string const& path);
bool has_group(hid_t file, std::string const& path);
haddr_t address(hid_t group);                       // in the file: the same group by whatever name
std::vector<std::string> group_names(hid_t group);  // child groups, in alphabetical order

// Attributes. Reads demand the count (or any count where it is -1); numbers are stored little-endian.
void write_attribute(hid_t at, char const* name, double const* value, int count);
void write_attribute(hid_t at, char const* name, std::int64_t value);
void write_attribute(hid_t at, char const* name, std::string const& value);
bool has_attribute(hid_t at, char const* name);
std::vector<double> read_doubles(hid_t at, char const* name, int count);
std::int64_t read_integer(hid_t at, char const* name);
std::string read_string(hid_t at, char const* name);

// Arrays of rank 1 (columns = -1) or 2, row-major, of float, double or int.
template <class T>
struct Table {
  std::vector<T> value;
  int rows = 0;
  int columns = -1;
};
template <class T>
void write_table(hid_t at, char const* name, Table<T> const& array);
template <class T>
Table<T> read_table(hid_t at, char const* name, int rank);
bool has_dataset(hid_t at, char const* name);
// The file holds as many bytes as the dataset promises: sizes that lie must not ask for memory.
void require_stored(hid_t dataset, char const* name);

using FloatArray = Table<float>;
inline void write_floats(hid_t at, char const* name, FloatArray const& array) { write_table(at, name, array); }
inline FloatArray read_floats(hid_t at, char const* name, int rank) { return read_table<float>(at, name, rank); }

}  // namespace scree::hdf5

// hdf5_edits.h: a sound HDF5 file, made wrong in ways that libhdf5 itself takes: what may lie behind a good CRC.
// Damaged bytes are not tried: libhdf5 1.10 crashes on them, which is what the CRC is for.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "shapes/hdf5_handle.h"
#include "tests/fuzz/fuzz_input.h"

namespace scree::fuzz {

// A temporary file that `write` fills and that is then edited as `in` spells it, until that ends: objects deleted,
// renamed, linked into one another, given other types, extents (promised, not filled, where large) and values.
// Made anew for each input. No image in memory: H5Fget_file_image resets a flag of the superblock but not its checksum
// (libhdf5 1.10.8), so that what it gives cannot be opened.
class EditedFile {
 public:
  EditedFile(std::function<void(hid_t)> const& write, FuzzInput& in);
  ~EditedFile();
  EditedFile(EditedFile const&) = delete;
  EditedFile& operator=(EditedFile const&) = delete;
  std::string const& name() const { return name_; }  // to open it by

 private:
  std::string name_;
};

}  // namespace scree::fuzz

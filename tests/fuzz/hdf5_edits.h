// hdf5_edits.h: a sound HDF5 file, made wrong in ways that libhdf5 itself takes: what may lie behind a good CRC.
// Damaged bytes are not tried: libhdf5 1.10 crashes on them, which is what the CRC is for.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "shapes/hdf5_handle.h"
#include "tests/fuzz/fuzz_input.h"

namespace scree::fuzz {

// The bytes of a file that `write` fills; nothing touches the disk.
std::string image_of(std::function<void(hid_t)> const& write);

// Edits as the bytes spell them, until they end: objects deleted, renamed, linked into one another, given other types,
// extents (promised, not filled, where large) and values.
void apply_edits(hid_t file, FuzzInput& in);

}  // namespace scree::fuzz

// checkpoint_content.h: a checkpoint as the objects of an open HDF5 file: what its file holds behind the user block.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/checkpoint.h"
#include "shapes/hdf5_handle.h"

namespace scree {

char constexpr checkpoint_format[] = "scree.checkpoint";

// Both throw std::runtime_error naming the object.
void write_checkpoint_content(hid_t file, Checkpoint const& checkpoint);
// Whether the content fits a case is for Simulation::restore to say.
Checkpoint read_checkpoint_content(hid_t file);

}  // namespace scree

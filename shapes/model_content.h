// model_content.h: a library as the objects of an open HDF5 file: what a model file holds behind its user block.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/hdf5_handle.h"
#include "shapes/shape.h"

namespace scree {

char constexpr model_format[] = "scree.model";
int constexpr newest_model_version = 2;

// Version 1 knows networks and formulas only; older programs read what needs no more.
int model_version(Library const& library);

// `library` is valid. Throws std::runtime_error naming the object.
void write_model_content(hid_t file, Library const& library);
// Indices are checked, figures are not: ask problems(library). Throws std::runtime_error naming the object.
Library read_model_content(hid_t file);

}  // namespace scree

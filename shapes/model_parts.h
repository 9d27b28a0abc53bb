// model_parts.h: radii, meshes and grids in a model file, written and read side by side.
//   /harmonics/<k>   coefficients f8 [(degree + 1)^2]
//   /mesh/<k>        vertex f8 [n, 3], triangle i4 [m, 3]
//   /grid/<k>        origin (3), cell [d]; points (3) along x, y, z; values f4 [points z * points y, points x]
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/hdf5_handle.h"
#include "shapes/shape.h"

namespace scree {

// True if the library holds any of them: then the file needs version 2 of the format.
bool has_model_parts(Library const& library);

// Into and from an open file. Reading throws std::runtime_error "/mesh/<k>: ..." for what is missing or does not fit
// together; values are judged by problems(library).
void write_model_parts(hid_t file, Library const& library);
void read_model_parts(hid_t file, Library& library);

}  // namespace scree

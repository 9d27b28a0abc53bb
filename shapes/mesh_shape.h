// mesh_shape.h: a closed triangle mesh as a shape of a library.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "shapes/shape.h"

namespace scree {

// Append the solid inside `mesh` (any unit and frame) to the library, normalised by its own exact volume, centroid and
// inertia; box and bounding radius are exact, the Lipschitz bound is 1. Returns the shape's index.
// Throws std::invalid_argument listing the defects of a mesh that does not bound one solid (report_mesh), with the
// repair; self-intersections are not looked for.
int add_mesh_shape(Library& library, std::string const& name, TriangleMesh const& mesh);

// Fill in kind, box, bounding radius and Lipschitz bound of a shape that is the mesh `index` of the library.
void set_mesh(Library const& library, int index, Shape& shape);

}  // namespace scree

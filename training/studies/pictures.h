// pictures.h: meshes that the plotting script draws.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "shapes/phi_batch.h"
#include "shapes/triangle_mesh.h"
#include "shapes/zero_set.h"
#include "training/studies/study.h"

namespace scree {

// <folder>/meshes/<name>.stl; slashes become hyphens. Returns the path relative to the folder.
std::string write_picture_mesh(StudyOptions const& options, std::string name, TriangleMesh const& mesh);

// The zero set within `radius`, on a coarse grid; empty where there is none.
ZeroSet picture_surface(StudyOptions const& options, PhiBatch const& phi, double radius);

}  // namespace scree

// grain_mesh.h: a light triangle mesh of a grain for pictures and export; not for measuring.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/shape.h"
#include "shapes/triangle_mesh.h"

namespace scree {

// Units of d, body frame, counter-clockwise from outside, vertices on phi = 0. A geodesic sphere of at most
// `triangles` faces (at least 20) is drawn along rays onto the surface where every ray meets it once; other shapes get
// the marched zero set, with more triangles. Throws std::runtime_error when there is no surface.
TriangleMesh light_mesh(Library const& library, Shape const& shape, int triangles);

}  // namespace scree

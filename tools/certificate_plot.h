// certificate_plot.h: the picture of a certificate: slices of phi, |grad phi| and the normals' errors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "shapes/mesh/certify_mesh.h"

namespace scree {

// The files that plot_certificate writes, the picture first.
std::vector<std::filesystem::path> plot_files(std::filesystem::path const& picture);

// Writes what is drawn beside the picture (.png or .svg) as CSV, <stem>-slices (phi in the three principal planes),
// -outline (the truth's cuts with them) and -samples (|grad phi| in the band, errors of normals), then draws it.
// `truth` may be null: then there is no truth in it. Lengths in d. Returns "" or what kept the picture from being
// drawn. Throws std::runtime_error for files that cannot be written.
std::string plot_certificate(Library const& library, Shape const& shape, MeshTruth const* truth,
                             std::filesystem::path const& picture, int threads);

}  // namespace scree

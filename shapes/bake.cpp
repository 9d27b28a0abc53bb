// bake.cpp: see bake.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/bake.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "shapes/grid_shape.h"
#include "shapes/mesh_shape.h"
#include "shapes/phi_batch.h"
#include "shapes/support_points.h"
#include "shapes/zero_set.h"

namespace scree {
namespace {

GridFrame frame_around(Shape const& shape, int cells) {
  GridFrame f;
  f.cell = 2 * shape.bounding_radius / cells;
  int* const points[3] = {&f.nx, &f.ny, &f.nz};
  for (int i = 0; i < 3; ++i) {
    double const size = shape.box.max[i] - shape.box.min[i];
    int const across = static_cast<int>(std::ceil(size / f.cell)) + 2;  // at least a cell beyond the box on each side
    *points[i] = across + 1;
    f.origin[i] = 0.5 * (shape.box.min[i] + shape.box.max[i] - across * f.cell);
  }
  return f;
}

}  // namespace

Library bake_grid(Library const& library, Shape const& source, int cells, int threads) {
  if (cells < 4 || cells > 400) throw std::invalid_argument("bake_grid: cells must be in 4..400");
  SdfGrid grid;
  grid.frame = frame_around(source, cells);
  GridFrame const& f = grid.frame;
  // A network knows nothing beyond 1.1 bounding radii: there phi goes on with slope 1 from the nearest point it knows.
  double const known = source.is_net() ? 1.1 * source.bounding_radius : 1e300;
  std::vector<Vec3> point;
  std::vector<double> beyond;
  for (int k = 0; k < f.nz; ++k)
    for (int j = 0; j < f.ny; ++j)
      for (int i = 0; i < f.nx; ++i) {
        Vec3 const x = f.origin + Vec3{double(i), double(j), double(k)} * f.cell;
        double const r = norm(x);
        point.push_back(r > known ? x * (known / r) : x);
        beyond.push_back(r > known ? r - known : 0);
      }
  std::vector<double> phi(point.size());
  fast_phi(library, source, threads)(point, phi, {});
  for (std::size_t i = 0; i < phi.size(); ++i) {
    if (!std::isfinite(phi[i])) throw std::runtime_error("phi is not finite near the body");
    grid.value.push_back(static_cast<float>(phi[i] - beyond[i]));
  }
  Library out;
  out.grid.push_back(std::make_shared<SdfGrid const>(std::move(grid)));
  out.shape.push_back(source);
  set_grid(out, 0, out.shape[0]);
  return out;
}

Library bake_mesh(Library const& library, Shape const& source, int cells, int threads) {
  PhiBatch const phi = surface_phi(library, source, threads);
  ZeroSetOptions const options{1.05 * source.bounding_radius, cells, surface_lipschitz(source)};
  ZeroSet fine = refine(phi, find_zero_set(phi, options));
  sharpen_corners(phi, fine);
  Library out;
  out.mesh.push_back(std::make_shared<MeshTree const>(std::move(fine.mesh)));
  out.shape.push_back(source);
  set_mesh(out, 0, out.shape[0]);
  return out;
}

}  // namespace scree

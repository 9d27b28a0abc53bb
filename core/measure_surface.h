// measure_surface.h: straight lines through the tops of a heap or a bed, seen from the side.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

namespace scree {

// A grain's centroid in the frame of the measurement [m].
struct SurfacePoint {
  double along, across, height;
};

// height = offset + slope along, by least squares.
struct LineFit {
  double slope = std::numeric_limits<double>::quiet_NaN(), offset = slope, rms = slope;  // rms: of the heights [m]
  int points = 0;
};

// The highest point of every cell of `size` by `size`.
std::vector<SurfacePoint> top_layer(std::vector<SurfacePoint> const& points, double size);

// NaN with fewer than two places along.
LineFit fit_line(std::vector<SurfacePoint> const& points);

// ... once more without the points that lie farther than `reach` off the first line: grains in flight [m].
LineFit fit_surface(std::vector<SurfacePoint> const& points, double reach);

// The flank of a heap. Points are seen from its axis: `along` is the distance from it (radial), or from a line, with
// either sign (one-dimensional: both flanks count). Cells one `bin` wide along (rings) and across (arcs of the ring, or
// `across`) each give their highest point; rings whose mean top lies between the shares `low` and `high` of the height
// of the highest ring above `base` are the flank; the line goes through all their points, so that no point is chosen by
// its own height. radial: `across` is an angle [rad].
struct HeapFit {
  LineFit line;                                           // slope against |along|: negative for a heap
  double top = std::numeric_limits<double>::quiet_NaN();  // mean of the highest ring [m]
};
HeapFit fit_heap(std::vector<SurfacePoint> const& points, bool radial, double bin, double base, double low,
                 double high);

}  // namespace scree

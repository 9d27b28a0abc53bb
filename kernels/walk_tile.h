// walk_tile.h: several steps of the walks of one tile with the fused network: a ray's phi need not leave the device.
// For a block of lanes, as mlp_fused.h.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/ball_walk.h"
#include "kernels/sdf/mlp_fused.h"

namespace scree::sdf_fused {

// A WalkBatch where the block can read it.
struct Walks {
  Span<const double> lipschitz;  // of each shape
  Span<const Vec3> origin, direction;
  Span<const double> end;
  Span<double> at;
  Span<int> step;
  Span<Vec3> point;  // Queries::point of the same launch
};

template <class Block, template <class> class Act, int W>
class WalkTile {
 public:
  // Queries without gradients; the others as FusedTile has them.
  SCREE_HD WalkTile(Block const& block, Networks const& networks, Queries const& queries, Walks const& walks,
                    Tile const& tile, float* weight, float* column, int* ints)
      : block_(block),
        queries_(queries),
        walks_(walks),
        tile_(tile),
        fused_(block, networks, queries, tile, weight, column, ints),
        list_(ints + tile_points),
        masks_(ints + 2 * tile_points) {}

  // At most `most` steps of each walk. Those that are over are asked again where they stand while others go on.
  SCREE_HD void run(int most) {
    for (int k = 0; k < most; ++k) {
      if (block_.compact(Going{*this}, list_, masks_) == 0) return;
      block_.each([&](int lane) {
        for (int p = 0; p < points_a_lane; ++p) {
          int const i = p * lanes + lane, w = tile_.first + i;
          if (i < tile_.count) walks_.point[w] = walks_.origin[w] + walks_.direction[w] * walks_.at[w];
        }
      });
      block_.sync();  // lanes beyond the end read the last point
      fused_.run(gradient_lanes);
      block_.each([&](int lane) {  // a lane's own points: it wrote their phi
        for (int p = 0; p < points_a_lane; ++p) {
          int const i = p * lanes + lane, w = tile_.first + i;
          if (i >= tile_.count || walks_.step[w] < 0) continue;
          double const lipschitz = walks_.lipschitz[queries_.shape_of[queries_.partner[w]]];
          walk_on(queries_.phi[w], lipschitz, walks_.end[w], walks_.at[w], walks_.step[w]);
        }
      });
    }
  }

 private:
  struct Going {
    WalkTile const& tile;
    SCREE_HD bool operator()(int i) const {
      return i < tile.tile_.count && tile.walks_.step[tile.tile_.first + i] >= 0;
    }
  };

  Block const& block_;
  Queries const& queries_;
  Walks const& walks_;
  Tile const tile_;
  FusedTile<Block, Act, W> fused_;
  int* const list_;
  int* const masks_;
};

}  // namespace scree::sdf_fused

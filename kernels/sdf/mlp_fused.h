// mlp_fused.h: the fused network on one tile of queries: transform, network, compaction, gradient, write back.
// Written against a block of lanes with shared storage. mlp_cuda.cu runs it with a CUDA thread block; a plain loop over
// the lanes (Lanes below) runs the same text under g++, which is how it is tested where there is no GPU.
//
// A lane owns its points: their activations lie in the lane's own column of the shared store, all neurons of a layer
// are accumulated in registers, and weights of one layer at a time are shared. A weight quad is one broadcast read for
// 4 points_a_lane multiply-adds. Lanes never exchange activations, so a point's bits depend on nothing else: the
// operations and their order are those of mlp_cpu_block.h, and phi and gradient equal the CPU's bit for bit wherever
// both round a b + c once.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "kernels/base/config.h"
#include "kernels/base/span.h"
#include "kernels/network_frame.h"
#include "kernels/sdf/mlp_activation.h"

#if defined(__CUDACC__)
#define SCREE_UNROLL _Pragma("unroll")
#define SCREE_UNROLL_4 _Pragma("unroll 4")
#else
#define SCREE_UNROLL
#define SCREE_UNROLL_4
#endif

namespace scree::sdf_fused {

int constexpr lanes = 128;        // of a block: four warps, of which several blocks fit a multiprocessor
int constexpr points_a_lane = 2;  // forward: 2 W accumulators; three would spill at W = 64
int constexpr tile_points = lanes * points_a_lane;
int constexpr max_hidden = 8;       // hidden layers
int constexpr gradient_lanes = 32;  // the least number of points whose gradients are made at once

// One network in the block of floats that all share, hidden widths padded with zeros to W:
//   forward (hidden x W x W: [layer][input][output]) | hidden biases (hidden x W; those of layer 0 are the bias rows)
//   | backward (hidden x W x W: [layer][output][input]) | last forward (W) | last backward (W)
struct NetworkRecord {
  std::size_t first = 0;           // float
  std::size_t first_bias = 0;      // float, of Networks::bias: its rows of W
  int hidden = 0;                  // layers
  int width[max_hidden + 1] = {};  // {3, hidden...}
  float last_bias = 0, slope = 0;
};
// Floats of one network.
inline std::size_t network_floats(int hidden, int w) {
  return std::size_t(hidden) * (2 * w * w + w) + 2 * std::size_t(w);
}

// All networks of one padded width and activation.
struct Networks {
  Span<const NetworkRecord> net;
  float const* weight = nullptr;  // 16-byte aligned
  float const* bias = nullptr;    // rows of W
};

// Queries and where their results go. See sdf_queries.h for frames and units.
struct Queries {
  Span<const NetworkFrame> frame;  // of each shape
  Span<const int> shape_of;        // (n_solids)
  Span<const double> diameter;     // [m] (n_solids)
  double cohesion_reach = 0;       // [m], see SceneView
  double gradient_from = 0;        // gradients are made where phi * diameter > gradient_from [m]; -infinity: everywhere
  Span<const Vec3> point;          // (n)
  Span<const int> partner;         // (n), all >= 0
  Span<double> phi;                // (n)
  Span<Vec3> gradient;             // (n) or empty: phi only
};

// Consecutive queries of one network, at most tile_points.
struct Tile {
  int net = 0;  // of Networks
  int first = 0, count = 0;
};

// Shared storage of a block, in floats and in ints.
SCREE_HD inline int column_rows(int w, int hidden) { return w * (1 + hidden); }  // of a gradient lane
inline int column_floats(int w, int hidden, bool with_gradient) {
  int const forward = tile_points * w, gradient = with_gradient ? gradient_lanes * column_rows(w, hidden) : 0;
  return forward > gradient ? forward : gradient;
}
SCREE_HD constexpr int weight_floats(int w) { return w * w + w; }
int constexpr shared_ints = 2 * tile_points + tile_points / 32 + 4;  // bias rows, list of active points, masks

// One float as the vector of mlp_activation.h.
struct Lane {
  float v;

  static SCREE_INLINE Lane broadcast(float const& x) { return {x}; }
  static SCREE_INLINE Lane constant(float x) { return {x}; }
  static SCREE_INLINE Lane fma(Lane a, Lane b, Lane c) { return {::fmaf(a.v, b.v, c.v)}; }
  static SCREE_INLINE Lane maximum(Lane a, Lane b) { return {a.v > b.v ? a.v : b.v}; }
  static SCREE_INLINE Lane divide(Lane a, Lane b) { return {a.v / b.v}; }
  static SCREE_INLINE Lane positive(Lane s, Lane a, Lane b) { return {s.v > 0.0f ? a.v : b.v}; }
  static SCREE_INLINE Lane flip_odd(Lane a, Lane t) { return from_bits(bits(a) ^ (bits(t) << 31)); }
  static SCREE_INLINE Lane exponent_shift(Lane a, Lane t) { return from_bits(bits(a) + (bits(t) << 23)); }
  friend SCREE_INLINE Lane operator+(Lane a, Lane b) { return {a.v + b.v}; }
  friend SCREE_INLINE Lane operator-(Lane a, Lane b) { return {a.v - b.v}; }
  friend SCREE_INLINE Lane operator*(Lane a, Lane b) { return {a.v * b.v}; }

  static SCREE_INLINE std::uint32_t bits(Lane a) {
    std::uint32_t u;
    std::memcpy(&u, &a.v, 4);
    return u;
  }
  static SCREE_INLINE Lane from_bits(std::uint32_t u) {
    Lane a;
    std::memcpy(&a.v, &u, 4);
    return a;
  }
};

// Loads and stores of N floats at once.
template <int N>
struct alignas(4 * N) Pack {
  float v[N];
};
template <int N>
SCREE_HD inline Pack<N> load(float const* p) {
  return *reinterpret_cast<Pack<N> const*>(p);
}

// The lanes of a block as a plain loop, for g++.
struct Lanes {
  template <class Step>
  void each(Step const& step) const {
    for (int lane = 0; lane < lanes; ++lane) step(lane);
  }
  void sync() const {}
  // Positions i with flag(i), ascending, into `list`; their number. Every lane gets the same answer.
  template <class Flag>
  int compact(Flag const& flag, int* list, int*) const {
    int n = 0;
    for (int i = 0; i < tile_points; ++i)
      if (flag(i)) list[n++] = i;
    return n;
  }
};

// One tile. Act<Lane> of mlp_activation.h; W: padded width, a multiple of 8.
template <class Block, template <class> class Act, int W>
class FusedTile {
 public:
  // weight, column: shared storage of weight_floats(W) and column_floats(W, ...), 16-byte aligned; ints: shared_ints.
  SCREE_HD FusedTile(Block const& block, Networks const& networks, Queries const& queries, Tile const& tile,
                     float* weight, float* column, int* ints)
      : block_(block),
        networks_(networks),
        net_(networks.net[tile.net]),
        q_(queries),
        tile_(tile),
        act_(net_),
        weight_(weight),
        column_(column),
        row_(ints),
        list_(ints + tile_points),
        masks_(ints + 2 * tile_points) {}

  // column_lanes: points whose gradients the store holds at once.
  SCREE_HD void run(int column_lanes) {
    forward();
    if (q_.gradient.empty()) return;
    int const active = block_.compact(Wanted{*this}, list_, masks_);
    for (int first = 0; first < active; first += column_lanes) {
      int const rest = active - first;
      gradients(first, rest < column_lanes ? rest : column_lanes, column_lanes);
    }
  }

 private:
  struct Wanted {
    FusedTile const& tile;
    SCREE_HD bool operator()(int i) const {
      if (i >= tile.tile_.count) return false;
      int const item = tile.tile_.first + i;
      return tile.q_.phi[item] * tile.q_.diameter[tile.q_.partner[item]] > tile.q_.gradient_from;
    }
  };

  SCREE_HD NetworkFrame const& frame(int item) const { return q_.frame[q_.shape_of[q_.partner[item]]]; }
  SCREE_HD float const* forward_weight(int l) const { return networks_.weight + net_.first + l * W * W; }
  SCREE_HD float const* hidden_bias(int l) const { return forward_weight(net_.hidden) + l * W; }
  SCREE_HD float const* backward_weight(int l) const { return hidden_bias(net_.hidden) + l * W * W; }
  SCREE_HD float const* last_forward() const { return backward_weight(net_.hidden); }

  // Weights of a layer, and a row behind them, into the shared store. Nobody reads the old ones any more.
  SCREE_HD void share(float const* from, int depth, float const* row) {
    block_.sync();
    block_.each([&](int lane) {
      for (int i = 4 * lane; i < depth * W; i += 4 * lanes)
        *reinterpret_cast<Pack<4>*>(weight_ + i) = load<4>(from + i);
      if (row && 4 * lane < W) *reinterpret_cast<Pack<4>*>(weight_ + W * W + 4 * lane) = load<4>(row + 4 * lane);
    });
    block_.sync();
  }

  // sum[j][p] += weight[k][j] in[k][p], in the order of k. `in` is the lane's column, rows `pitch` floats apart.
  template <int P>
  SCREE_HD void accumulate(float (&sum)[W][P], int depth, float const* in, int pitch) const {
    SCREE_UNROLL_4
    for (int k = 0; k < depth; ++k) {
      Pack<P> const x = load<P>(in + k * pitch);
      float const* const w = weight_ + k * W;
      SCREE_UNROLL
      for (int j = 0; j < W; j += 4) {
        Pack<4> const quad = load<4>(w + j);
        SCREE_UNROLL
        for (int i = 0; i < 4; ++i) SCREE_UNROLL
        for (int p = 0; p < P; ++p) sum[j + i][p] = ::fmaf(quad.v[i], x.v[p], sum[j + i][p]);
      }
    }
  }

  // One hidden layer of a lane, from `in` to `out` (may be the same); `record` is null or what the way back needs.
  template <int P>
  SCREE_HD void hidden_layer(int l, int const (&item_in_tile)[P], float const* in, float* out, float* record,
                             int pitch) const {
    float sum[W][P];
    SCREE_UNROLL
    for (int p = 0; p < P; ++p) {
      float const* const bias =
          l == 0 ? networks_.bias + net_.first_bias + std::size_t(row_[item_in_tile[p]]) * W : weight_ + W * W;
      SCREE_UNROLL
      for (int j = 0; j < W; j += 4) {
        Pack<4> const quad = load<4>(bias + j);
        SCREE_UNROLL
        for (int i = 0; i < 4; ++i) sum[j + i][p] = quad.v[i];
      }
    }
    accumulate<P>(sum, net_.width[l], in, pitch);
    SCREE_UNROLL
    for (int j = 0; j < W; ++j) {
      Pack<P> h;
      SCREE_UNROLL
      for (int p = 0; p < P; ++p) {
        Lane kept;
        if (record && !Act<Lane>::remembers_value) {
          h.v[p] = act_.value_and_record({sum[j][p]}, kept).v;
          record[j * pitch + p] = kept.v;
        } else {
          h.v[p] = act_.value({sum[j][p]}).v;
        }
      }
      *reinterpret_cast<Pack<P>*>(out + j * pitch) = h;
    }
  }

  // Coordinates of a lane's points into the first three rows of its column; beyond the tile's end: the last point.
  template <int P>
  SCREE_HD void gather(int const (&item_in_tile)[P], float* column, int pitch) const {
    SCREE_UNROLL
    for (int p = 0; p < P; ++p) {
      int const item = tile_.first + item_in_tile[p];
      Vec3f const x = to_network(frame(item), q_.cohesion_reach, q_.point[item]);
      column[p] = x.x, column[pitch + p] = x.y, column[2 * pitch + p] = x.z;
    }
  }

  // Neighbouring lanes take neighbouring points, so that their reads are one.
  SCREE_HD void items_of(int lane, int (&item_in_tile)[points_a_lane]) const {
    SCREE_UNROLL
    for (int p = 0; p < points_a_lane; ++p) {
      int const i = p * lanes + lane;
      item_in_tile[p] = i < tile_.count ? i : tile_.count - 1;
    }
  }

  SCREE_HD void forward() {
    int constexpr P = points_a_lane, pitch = lanes * P;
    block_.sync();  // the store of the tile before
    block_.each([&](int lane) {
      int item[P];
      items_of(lane, item);
      gather<P>(item, column_ + lane * P, pitch);
      SCREE_UNROLL
      for (int p = 0; p < P; ++p) row_[p * lanes + lane] = frame(tile_.first + item[p]).bias_row;
    });
    for (int l = 0; l < net_.hidden; ++l) {
      share(forward_weight(l), net_.width[l], l > 0 ? hidden_bias(l) : nullptr);
      block_.each([&](int lane) {
        int item[P];
        items_of(lane, item);
        float* const column = column_ + lane * P;
        hidden_layer<P>(l, item, column, column, nullptr, pitch);
      });
    }
    share(last_forward(), 1, nullptr);
    block_.each([&](int lane) {
      int item[P];
      items_of(lane, item);
      float const* const in = column_ + lane * P;
      float sum[4][P] = {};  // four partial sums, as mlp_cpu_block.h has them
      SCREE_UNROLL_4
      for (int k = 0; k < W; k += 4) SCREE_UNROLL
      for (int i = 0; i < 4; ++i) SCREE_UNROLL
      for (int p = 0; p < P; ++p) sum[i][p] = ::fmaf(weight_[k + i], in[(k + i) * pitch + p], sum[i][p]);
      SCREE_UNROLL
      for (int p = 0; p < P; ++p) {
        if (p * lanes + lane >= tile_.count) continue;
        float const net_phi = ((sum[0][p] + sum[1][p]) + (sum[2][p] + sum[3][p])) + net_.last_bias;
        int const at = tile_.first + item[p];
        from_network(frame(at), q_.cohesion_reach, q_.point[at], net_phi, nullptr, q_.phi[at], nullptr);
      }
    });
  }

  // Gradients of the points list_[first .. first + count), one a lane, by the way back through the layers. The lane's
  // column: W rows of coordinates, activations or their derivatives, then W rows of record for each hidden layer.
  SCREE_HD void gradients(int first, int count, int pitch) {
    bool constexpr in_record = Act<Lane>::remembers_value;  // the record doubles as the activations
    block_.sync();
    block_.each([&](int lane) {
      if (lane >= count) return;
      int const item[1] = {list_[first + lane]};
      gather<1>(item, column_ + lane, pitch);
    });
    for (int l = 0; l < net_.hidden; ++l) {
      share(forward_weight(l), net_.width[l], l > 0 ? hidden_bias(l) : nullptr);
      block_.each([&](int lane) {
        if (lane >= count) return;
        int const item[1] = {list_[first + lane]};
        float* const column = column_ + lane;
        float* const record = column + (1 + l) * W * pitch;
        float const* const in = in_record && l > 0 ? record - W * pitch : column;
        hidden_layer<1>(l, item, in, in_record ? record : column, record, pitch);
      });
    }
    share(last_forward() + W, 1, nullptr);  // last backward
    block_.each([&](int lane) {
      if (lane >= count) return;
      float* const column = column_ + lane;
      float const* const record = column + net_.hidden * W * pitch;
      SCREE_UNROLL_4
      for (int k = 0; k < W; ++k) column[k * pitch] = act_.backward({weight_[k]}, {record[k * pitch]}).v;
    });
    for (int l = net_.hidden - 1; l > 0; --l) {
      share(backward_weight(l), net_.width[l + 1], nullptr);
      block_.each([&](int lane) {
        if (lane >= count) return;
        float* const column = column_ + lane;
        float const* const record = column + l * W * pitch;  // of layer l - 1
        float sum[W][1] = {};
        accumulate<1>(sum, net_.width[l + 1], column, pitch);
        SCREE_UNROLL
        for (int j = 0; j < W; ++j) column[j * pitch] = act_.backward({sum[j][0]}, {record[j * pitch]}).v;
      });
    }
    share(backward_weight(0), net_.width[1], nullptr);
    block_.each([&](int lane) {
      if (lane >= count) return;
      float const* const column = column_ + lane;
      Vec3f g;
      for (int k = 0; k < net_.width[1]; ++k) {
        float const x = column[k * pitch];
        g.x = ::fmaf(weight_[k * W], x, g.x), g.y = ::fmaf(weight_[k * W + 1], x, g.y);
        g.z = ::fmaf(weight_[k * W + 2], x, g.z);
      }
      int const at = tile_.first + list_[first + lane];
      NetworkFrame const& of = frame(at);
      q_.gradient[at] = transposed_times(of.rotation, to_double(g));
      bool const outside = norm2(q_.point[at]) > of.bounding_radius * of.bounding_radius;
      double unused = 0;
      if (outside && q_.cohesion_reach > 0)
        continue_outside(q_.point[at], of.bounding_radius, unused, &q_.gradient[at]);
    });
  }

  Block const& block_;
  Networks const& networks_;
  NetworkRecord const net_;
  Queries const& q_;
  Tile const tile_;
  Act<Lane> const act_;
  float* const weight_;
  float* const column_;
  int* const row_;
  int* const list_;
  int* const masks_;
};

}  // namespace scree::sdf_fused

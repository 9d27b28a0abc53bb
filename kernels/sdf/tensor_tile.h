// tensor_tile.h: the fused network of mlp_fused.h for tensor cores: activations stay in registers, in half precision.
//
// A warp takes 16 M points through all layers. Points are the rows of A, so that the accumulators of a layer, activated
// and rounded where they are, are the A of the next one; weights are B, packed at load in the order lanes read them
// (tensor_image.h). They are read through the first-level cache instead of being staged in shared memory: that is the
// same memory at the same speed, needs no barrier, so that warps run apart, and takes networks of any size.
//
// fp16x3 (`terms` = 3): both factors are split into two halves, high + low, and high high + high low + low high keeps
// 22 bits of the product (Markidis et al. 2018; what is dropped is 2^-22 of it). The small products come first, on
// accumulators that start at zero: tensor cores round toward zero, and every rounding but the last few is then of a
// small number (Ootomo and Yokota 2022 leave the tensor core for that). Biases therefore join in the multiply-add that
// takes the scales off again. fp16 (`terms` = 1) drops the low parts. First and last layer are fp32 multiply-adds:
// three inputs fill no tile, and errors of the first layer would pass through all others.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sdf/tensor_layout.h"
#include "kernels/sdf/tensor_warp.h"

namespace scree::sdf_fused {

// What the way back needs of a hidden layer: a bit an element where the activation's sign says it (leaky ReLU: a word
// a lane), else a float an element. In words of a warp with 16 points.
template <template <class> class Act, int W>
SCREE_HD constexpr int record_words(int hidden) {
  return (hidden - 1) * warp_lanes * (Act<Lane>::remembers_value ? 1 : W / 2);
}
int constexpr tensor_warps = lanes / warp_lanes;

// One tile of queries. Block as in mlp_fused.h, with `each_warp` and a `Warp` (tensor_warp.h).
template <class Block, template <class> class Act, int W, int terms>
class TensorTile {
 public:
  // record: shared storage, tensor_warps times record_words, 16-byte aligned; ints: shared_ints.
  SCREE_HD TensorTile(Block const& block, Tensors const& tensors, Queries const& queries, Tile const& tile,
                      float* record, int* ints)
      : block_(block),
        tensors_(tensors),
        net_(tensors.net[tile.net]),
        q_(queries),
        tile_(tile),
        act_(net_),
        record_(record),
        list_(ints + tile_points),
        masks_(ints + 2 * tile_points) {}

  // phi alone, or phi and gradient. Gradients of some points only: fp16 sorts out those that are surely not among them;
  // they keep an upper bound of phi, at most twice filter_bound above it, and the others are done anew with all terms.
  SCREE_HD void run() {
    bool const gradients = !q_.gradient.empty();
    if (terms == 3 && !gradients) {
      each_group<terms, 2, false>(nullptr, tile_.count, 0);
      return;
    }
    int const* list = nullptr;
    int count = tile_.count;
    if (!gradients || q_.gradient_from != -INFINITY) {
      each_group<1, 2, false>(nullptr, count, terms == 1 ? 0 : net_.filter_bound);
      if (!gradients) return;
      count = block_.compact(Wanted{*this}, list_, masks_);
      list = list_;
    }
    each_group<terms, 1, true>(list, count, 0);  // called once: calls are inlined, and nvcc takes its time
  }

 private:
  using Warp = typename Block::Warp;
  template <class T>
  using Own = typename Warp::template Own<T>;
  static int constexpr blocks = W / 8;  // of 8 neurons
  static bool constexpr masks_only = Act<Lane>::remembers_value;

  struct Wanted {
    TensorTile const& tile;
    SCREE_HD bool operator()(int i) const {
      if (i >= tile.tile_.count) return false;
      int const item = tile.tile_.first + i;
      return tile.q_.phi[item] * tile.q_.diameter[tile.q_.partner[item]] > tile.q_.gradient_from;
    }
  };

  // 16 M points of a warp. Element i of a lane: row g + 8 (i / 2) of 16, column 2 t + i % 2 of 8.
  template <int M>
  struct Operand {
    Own<Half2> high[M][blocks][2], low[M][blocks][2];
  };
  template <int M>
  struct Group {
    Operand<M> a;          // what the last layer put out
    Own<float> phi[M][2];  // of a row: this lane's columns only
    Own<float> gradient[M][2][3];
    Own<std::uint32_t> mask[M];  // bit 4 block + i: this layer's record
    float* record;               // of this warp
  };

  SCREE_HD NetworkFrame const& frame(int item) const { return q_.frame[q_.shape_of[q_.partner[item]]]; }
  SCREE_HD float const* first_forward() const { return tensors_.number + net_.first_number; }
  SCREE_HD float const* bias(int l) const { return first_forward() + (2 + l) * W; }
  SCREE_HD float const* last_forward() const { return bias(net_.hidden); }
  SCREE_HD float const* last_backward() const { return last_forward() + W; }
  SCREE_HD float const* first_backward() const { return last_backward() + W; }
  SCREE_HD Half2 const* forward_words(int l) const {
    return tensors_.word + net_.first_word + std::size_t(l - 1) * 2 * plane_words(W);
  }
  SCREE_HD Half2 const* backward_words(int l) const { return forward_words(net_.hidden + l - 1); }

  // All points of `list` (null: of the tile), 16 M a warp at a time.
  template <int T, int M, bool gradient>
  SCREE_HD void each_group(int const* list, int count, float raise) const {
    block_.each_warp([&](Warp const& warp, int w) {
      for (int first = 16 * M * w; first < count; first += 16 * M * tensor_warps)
        group<T, M, gradient>(warp, record_ + w * record_words<Act, W>(net_.hidden), list, first, count, raise);
    });
  }

  template <int T, int M, bool gradient>
  SCREE_HD void group(Warp const& warp, float* record, int const* list, int first, int count, float raise) const {
    Group<M> s;
    s.record = record;
    Own<int> item;  // a lane's own point; beyond the end: the last one
    gather<M>(warp, list, first, count, item, s);
    first_layer<T, M, gradient>(warp, item, s);
    for (int l = 1; l < net_.hidden; ++l) hidden_layer<T, M, gradient>(warp, l, s);
    if constexpr (gradient)
      for (int l = net_.hidden - 1; l > 0; --l) backward_layer<T, M>(warp, l, s);
    put<M, gradient>(warp, item, first, count, raise, s);
  }

  template <int M>
  SCREE_HD void gather(Warp const& warp, int const* list, int first, int count, Own<int>& item, Group<M>& s) const {
    warp.each([&](int lane) {
      int const p = first + lane % (16 * M), at = p < count ? p : count - 1;
      item[lane] = tile_.first + (list ? list[at] : at);
      SCREE_UNROLL
      for (int m = 0; m < M; ++m) {
        s.mask[m][lane] = 0;
        SCREE_UNROLL
        for (int r = 0; r < 2; ++r) {
          s.phi[m][r][lane] = 0;
          SCREE_UNROLL
          for (int k = 0; k < 3; ++k) s.gradient[m][r][k][lane] = 0;
        }
      }
    });
  }

  // Coordinates go from each point's lane to the four of its row; the code is folded into the point's bias row.
  template <int T, int M, bool gradient>
  SCREE_HD void first_layer(Warp const& warp, Own<int> const& item, Group<M>& s) const {
    Own<float> own[3];
    Own<int> own_row;
    warp.each([&](int lane) {
      NetworkFrame const& of = frame(item[lane]);
      Vec3f const x = to_network(of, q_.cohesion_reach, q_.point[item[lane]]);
      own[0][lane] = x.x, own[1][lane] = x.y, own[2][lane] = x.z;
      own_row[lane] = of.bias_row;
    });
    Own<float> x[M][2][3];
    Own<int> row[M][2];
    SCREE_UNROLL
    for (int m = 0; m < M; ++m) SCREE_UNROLL
    for (int r = 0; r < 2; ++r) {
      SCREE_UNROLL
      for (int k = 0; k < 3; ++k) warp.from_row(own[k], 16 * m + 8 * r, x[m][r][k]);
      warp.from_row(own_row, 16 * m + 8 * r, row[m][r]);
    }
    SCREE_UNROLL
    for (int n = 0; n < blocks; ++n)
      warp.each([&](int lane) {
        int const j = 8 * n + fragment_column(lane);
        Pack<2> w[3];
        SCREE_UNROLL
        for (int k = 0; k < 3; ++k) w[k] = warp.floats_2(first_forward() + k * W + j);
        SCREE_UNROLL
        for (int m = 0; m < M; ++m) {
          float z[4];
          SCREE_UNROLL
          for (int r = 0; r < 2; ++r) {
            Pack<2> const b = warp.floats_2(tensors_.bias + net_.first_bias + std::size_t(row[m][r][lane]) * W + j);
            SCREE_UNROLL
            for (int c = 0; c < 2; ++c) {
              float sum = b.v[c];
              SCREE_UNROLL
              for (int k = 0; k < 3; ++k) sum = ::fmaf(w[k].v[c], x[m][r][k][lane], sum);
              z[2 * r + c] = sum;
            }
          }
          activate<T, M, gradient>(lane, 0, m, n, z, net_.first_scale, s);
        }
      });
    if constexpr (gradient) store_mask<M>(warp, 0, s);
  }

  template <int T, int M, bool gradient>
  SCREE_HD void hidden_layer(Warp const& warp, int l, Group<M>& s) const {
    Operand<M> const in = s.a;
    SCREE_UNROLL
    for (int n = 0; n < blocks; ++n) {
      Own<Accumulator> sum[M];
      product<T, M>(warp, forward_words(l), n, in, sum);
      warp.each([&](int lane) {
        Pack<2> const b = warp.floats_2(bias(l) + 8 * n + fragment_column(lane));
        SCREE_UNROLL
        for (int m = 0; m < M; ++m) {
          float z[4];
          SCREE_UNROLL
          for (int i = 0; i < 4; ++i) z[i] = ::fmaf(sum[m][lane].v[i], net_.down[l], b.v[i % 2]);
          activate<T, M, gradient>(lane, l, m, n, z, 1, s);
        }
      });
    }
    if constexpr (gradient) store_mask<M>(warp, l, s);
  }

  // d phi / d z of layer l - 1 from that of layer l.
  template <int T, int M>
  SCREE_HD void backward_layer(Warp const& warp, int l, Group<M>& s) const {
    load_mask<M>(warp, l - 1, s);
    Operand<M> const in = s.a;
    SCREE_UNROLL
    for (int n = 0; n < blocks; ++n) {
      Own<Accumulator> sum[M];
      product<T, M>(warp, backward_words(l), n, in, sum);
      warp.each([&](int lane) {
        SCREE_UNROLL
        for (int m = 0; m < M; ++m) {
          float g[4], kept[4];
          recall<M>(lane, l - 1, m, n, kept, s);
          SCREE_UNROLL
          for (int i = 0; i < 4; ++i) g[i] = act_.backward({sum[m][lane].v[i] * net_.back_down[l]}, {kept[i]}).v;
          pass_back<T, M>(lane, l - 1, m, n, g, s);
        }
      });
    }
  }

  // Columns 8 n ... 8 n + 7 of a layer's product, scaled.
  template <int T, int M>
  SCREE_HD void product(Warp const& warp, Half2 const* words, int n, Operand<M> const& in,
                        Own<Accumulator> (&sum)[M]) const {
    Own<Half2> high[blocks], low[blocks];
    fetch(warp, words, n, high);
    if constexpr (T == 3) fetch(warp, words + plane_words(W), n, low);
    warp.each([&](int lane) {
      SCREE_UNROLL
      for (int m = 0; m < M; ++m) sum[m][lane] = {{0, 0, 0, 0}};
    });
    if constexpr (T == 3) {
      multiply<M>(warp, in.low, high, sum);
      multiply<M>(warp, in.high, low, sum);
    }
    multiply<M>(warp, in.high, high, sum);
  }
  SCREE_HD void fetch(Warp const& warp, Half2 const* plane, int n, Own<Half2> (&b)[blocks]) const {
    warp.each([&](int lane) {
      SCREE_UNROLL
      for (int k = 0; k + 1 < blocks; k += 2)
        warp.words_2(plane + fragment_word(blocks, n, k) + 2 * lane, b[k][lane], b[k + 1][lane]);
      if constexpr (blocks % 2 == 1)
        b[blocks - 1][lane] = warp.word(plane + fragment_word(blocks, n, blocks - 1) + lane);
    });
  }
  template <int M>
  SCREE_HD void multiply(Warp const& warp, Own<Half2> const (&a)[M][blocks][2], Own<Half2> const (&b)[blocks],
                         Own<Accumulator> (&sum)[M]) const {
    SCREE_UNROLL
    for (int k = 0; k + 1 < blocks; k += 2) SCREE_UNROLL
    for (int m = 0; m < M; ++m) warp.multiply_16(sum[m], a[m][k], a[m][k + 1], b[k], b[k + 1]);
    if constexpr (blocks % 2 == 1) SCREE_UNROLL
    for (int m = 0; m < M; ++m) warp.multiply_8(sum[m], a[m][blocks - 1], b[blocks - 1]);
  }

  // Four elements of hidden layer l: into the next A; of the last one: into phi and, if wanted, on the way back.
  template <int T, int M, bool gradient>
  SCREE_HD void activate(int lane, int l, int m, int n, float const (&z)[4], float scale, Group<M>& s) const {
    float h[4], kept[4];
    SCREE_UNROLL
    for (int i = 0; i < 4; ++i) {
      Lane record{0};
      h[i] = scale * (gradient ? act_.value_and_record({z[i]}, record) : act_.value({z[i]})).v;
      kept[i] = record.v;
    }
    if (l + 1 < net_.hidden) {
      if constexpr (gradient) remember<M>(lane, l, m, n, kept, s);
      to_operand<T, M>(lane, m, n, h, s);
      return;
    }
    int const j = 8 * n + fragment_column(lane);
    Pack<2> const w = Warp::floats_2(last_forward() + j);
    SCREE_UNROLL
    for (int i = 0; i < 4; ++i) s.phi[m][i / 2][lane] = ::fmaf(w.v[i % 2], h[i], s.phi[m][i / 2][lane]);
    if constexpr (gradient) {
      Pack<2> const back = Warp::floats_2(last_backward() + j);
      float g[4];
      SCREE_UNROLL
      for (int i = 0; i < 4; ++i) g[i] = act_.backward({back.v[i % 2]}, {kept[i]}).v;
      pass_back<T, M>(lane, l, m, n, g, s);
    }
  }

  // Four elements of d phi / d z of layer l: into the next A; of layer 0: into the gradient.
  template <int T, int M>
  SCREE_HD void pass_back(int lane, int l, int m, int n, float const (&g)[4], Group<M>& s) const {
    if (l > 0) {
      to_operand<T, M>(lane, m, n, g, s);
      return;
    }
    SCREE_UNROLL
    for (int k = 0; k < 3; ++k) {
      Pack<2> const w = Warp::floats_2(first_backward() + k * W + 8 * n + fragment_column(lane));
      SCREE_UNROLL
      for (int i = 0; i < 4; ++i) {
        float& sum = s.gradient[m][i / 2][k][lane];
        sum = ::fmaf(w.v[i % 2], g[i], sum);
      }
    }
  }

  template <int T, int M>
  SCREE_HD void to_operand(int lane, int m, int n, float const (&h)[4], Group<M>& s) const {
    SCREE_UNROLL
    for (int r = 0; r < 2; ++r) {
      if constexpr (T == 3)
        split_halves(h[2 * r], h[2 * r + 1], s.a.high[m][n][r][lane], s.a.low[m][n][r][lane]);
      else
        s.a.high[m][n][r][lane] = pack_halves(h[2 * r], h[2 * r + 1]);
    }
  }

  // Records lie as lanes hold them, so that a lane reads what it wrote and neighbours touch neighbouring banks. With
  // masks a layer's bits gather in a register first.
  template <int M>
  SCREE_HD static Pack<4>& kept_at(Group<M>& s, int lane, int l, int m, int n) {
    return *reinterpret_cast<Pack<4>*>(s.record + 4 * (((l * M + m) * blocks + n) * warp_lanes + lane));
  }
  template <int M>
  SCREE_HD static float& mask_at(Group<M>& s, int lane, int l, int m) {
    return s.record[(l * M + m) * warp_lanes + lane];
  }
  template <int M>
  SCREE_HD void remember(int lane, int l, int m, int n, float const (&kept)[4], Group<M>& s) const {
    if constexpr (masks_only) {
      std::uint32_t bits = 0;
      SCREE_UNROLL
      for (int i = 0; i < 4; ++i)
        if (kept[i] > 0.0f) bits |= 1u << i;
      s.mask[m][lane] |= bits << (4 * n);
    } else {
      kept_at<M>(s, lane, l, m, n) = {{kept[0], kept[1], kept[2], kept[3]}};
    }
  }
  template <int M>
  SCREE_HD void recall(int lane, int l, int m, int n, float (&kept)[4], Group<M>& s) const {
    if constexpr (masks_only) {
      std::uint32_t const bits = s.mask[m][lane] >> (4 * n);
      SCREE_UNROLL
      for (int i = 0; i < 4; ++i) kept[i] = bits & 1u << i ? 1.0f : -1.0f;
    } else {
      Pack<4> const from = kept_at<M>(s, lane, l, m, n);
      SCREE_UNROLL
      for (int i = 0; i < 4; ++i) kept[i] = from.v[i];
    }
  }
  template <int M>
  SCREE_HD void store_mask(Warp const& warp, int l, Group<M>& s) const {
    if (!masks_only || l + 1 == net_.hidden) return;
    warp.each([&](int lane) {
      SCREE_UNROLL
      for (int m = 0; m < M; ++m) {
        mask_at<M>(s, lane, l, m) = Lane::from_bits(s.mask[m][lane]).v;
        s.mask[m][lane] = 0;
      }
    });
  }
  template <int M>
  SCREE_HD void load_mask(Warp const& warp, int l, Group<M>& s) const {
    if (!masks_only) return;
    warp.each([&](int lane) {
      SCREE_UNROLL
      for (int m = 0; m < M; ++m) s.mask[m][lane] = Lane::bits({mask_at<M>(s, lane, l, m)});
    });
  }

  // Sums over a row's four lanes, from there to the lane that owns the point, and out. phi is raised by `raise`.
  template <int M, bool gradient>
  SCREE_HD void put(Warp const& warp, Own<int> const& item, int first, int count, float raise, Group<M>& s) const {
    Own<float> phi, g[3];
    collect<M>(
        warp, [&](int m, int r) -> Own<float>& { return s.phi[m][r]; }, phi);
    if constexpr (gradient) SCREE_UNROLL
    for (int k = 0; k < 3; ++k)
      collect<M>(
          warp, [&](int m, int r) -> Own<float>& { return s.gradient[m][r][k]; }, g[k]);
    warp.each([&](int lane) {
      if (lane >= 16 * M || first + lane >= count) return;
      int const at = item[lane];
      NetworkFrame const& of = frame(at);
      float const net_phi = phi[lane] + net_.last_bias + raise;
      if constexpr (gradient) {
        Vec3f const net_gradient{g[0][lane], g[1][lane], g[2][lane]};
        from_network(of, q_.cohesion_reach, q_.point[at], net_phi, &net_gradient, q_.phi[at], &q_.gradient[at]);
      } else {
        from_network(of, q_.cohesion_reach, q_.point[at], net_phi, nullptr, q_.phi[at], nullptr);
      }
    });
  }
  template <int M, class Sums>
  SCREE_HD void collect(Warp const& warp, Sums const& sums, Own<float>& out) const {
    SCREE_UNROLL
    for (int m = 0; m < M; ++m) SCREE_UNROLL
    for (int r = 0; r < 2; ++r) {
      Own<float> of_row;
      warp.quad_sum(sums(m, r));
      warp.to_owner(sums(m, r), of_row);
      warp.each([&](int lane) {
        if (lane % (16 * M) / 8 == 2 * m + r) out[lane] = of_row[lane];
      });
    }
  }

  Block const& block_;
  Tensors const& tensors_;
  TensorRecord const& net_;
  Queries const& q_;
  Tile const tile_;
  Act<Lane> const act_;
  float* const record_;
  int* const list_;
  int* const masks_;
};

}  // namespace scree::sdf_fused

// mlp_cpu_block.h: the fused network on one block of points, as a template over the vector type of an ISA.
// Points sit in SIMD lanes. A register tile is `vectors` vectors of points times `panel` neurons: AVX2 3 x 4 = 12
// accumulators, 3 loads and 4 broadcasts for 12 FMA, all 16 registers in use. The last block of a batch is as narrow as
// its points allow: small networks of many shapes ask few points each. Every lane runs the same operations in
// the same order whatever its neighbours are, hence the same bits at every position.
// Included by the ISA files only, which define a vector type V in a namespace of their own: what mlp_activation.h asks
// for, and V::size, vectors, panel, load, store, broadcast (from memory).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kernels/sdf/mlp_activation.h"
#include "kernels/sdf/mlp_cpu.h"

namespace scree::sdf_cpu {
namespace {  // one private copy for each ISA file: its flags must not leak

using namespace sdf_activation;

// Points of a block that is N vectors wide.
template <class V, int N>
constexpr int lanes = N* V::size;

// The register tile: sum[p][v] += panel[k][p] * in[k][v] over k, in the order of k.
template <class V, int N, int P>
SCREE_INLINE void accumulate(V (&sum)[P][N], int depth, float const* panel, float const* in) {
#pragma GCC unroll 4
  for (int k = 0; k < depth; ++k, panel += P, in += lanes<V, N>) {
    V x[N];
#pragma GCC unroll 8
    for (int v = 0; v < N; ++v) x[v] = V::load(in + v * V::size);
#pragma GCC unroll 16
    for (int p = 0; p < P; ++p) {
      V const w = V::broadcast(panel[p]);
#pragma GCC unroll 8
      for (int v = 0; v < N; ++v) sum[p][v] = V::fma(w, x[v], sum[p][v]);
    }
  }
}

// One hidden layer. `bias`: a number a neuron, or with mixed rows a row of lanes a neuron. `record` is null or what
// the backward pass will need; with Act::remembers_value that is `out` itself.
template <class V, int N, class Act, bool mixed, bool recording>
SCREE_INLINE void hidden_layer(Act const& act, int depth, int neurons, float const* panel, float const* bias,
                               float const* in, float* out, float* record) {
  constexpr int P = V::panel;
  for (int j = 0; j < neurons; j += P, panel += depth * P) {
    V sum[P][N];
#pragma GCC unroll 16
    for (int p = 0; p < P; ++p)
#pragma GCC unroll 8
      for (int v = 0; v < N; ++v)
        sum[p][v] = mixed ? V::load(bias + (j + p) * lanes<V, N> + v * V::size) : V::broadcast(bias[j + p]);
    accumulate<V, N, P>(sum, depth, panel, in);
#pragma GCC unroll 16
    for (int p = 0; p < P; ++p)
#pragma GCC unroll 8
      for (int v = 0; v < N; ++v) {
        int const at = (j + p) * lanes<V, N> + v * V::size;
        if constexpr (recording && !Act::remembers_value) {
          V kept;
          V::store(out + at, act.value_and_record(sum[p][v], kept));
          V::store(record + at, kept);
        } else {
          V::store(out + at, act.value(sum[p][v]));
        }
      }
  }
}

// phi = last weights . h + bias, as four partial sums over k mod 4: one chain would wait for the FMA latency.
template <class V, int N>
SCREE_INLINE void last_layer(PackedView const& net, float const* in, float* phi) {
  V sum[4][N];
#pragma GCC unroll 4
  for (int p = 0; p < 4; ++p)
#pragma GCC unroll 8
    for (int v = 0; v < N; ++v) sum[p][v] = V::constant(0.0f);
  for (int k = 0; k < net.padded[net.hidden]; k += 4)
#pragma GCC unroll 4
    for (int p = 0; p < 4; ++p) {
      V const w = V::broadcast(net.last_forward[k + p]);
#pragma GCC unroll 8
      for (int v = 0; v < N; ++v) sum[p][v] = V::fma(w, V::load(in + (k + p) * lanes<V, N> + v * V::size), sum[p][v]);
    }
#pragma GCC unroll 8
  for (int v = 0; v < N; ++v)
    V::store(phi + v * V::size, ((sum[0][v] + sum[1][v]) + (sum[2][v] + sum[3][v])) + V::broadcast(net.last_bias));
}

// d phi / d z of the layer below, over a panel of its neurons: sum over the outputs, times the activation's slope.
template <class V, int N, class Act>
SCREE_INLINE void backward_layer(Act const& act, int depth, int neurons, float const* panel, float const* in,
                                 float const* record, float* out) {
  constexpr int P = V::panel;
  for (int j = 0; j < neurons; j += P, panel += depth * P) {
    V sum[P][N];
#pragma GCC unroll 16
    for (int p = 0; p < P; ++p)
#pragma GCC unroll 8
      for (int v = 0; v < N; ++v) sum[p][v] = V::constant(0.0f);
    accumulate<V, N, P>(sum, depth, panel, in);
#pragma GCC unroll 16
    for (int p = 0; p < P; ++p)
#pragma GCC unroll 8
      for (int v = 0; v < N; ++v) {
        int const at = (j + p) * lanes<V, N> + v * V::size;
        V::store(out + at, act.backward(sum[p][v], V::load(record + at)));
      }
  }
}

// Coordinates (and bias, where rows differ) from points to lanes; the last point fills the tail.
template <class V, int N>
SCREE_INLINE void gather(PackedView const& net, BlockJob const& job, bool mixed, float* coordinate, float* bias) {
  for (int i = 0; i < lanes<V, N>; ++i) {
    int const from = i < job.count ? i : job.count - 1;
    for (int c = 0; c < 3; ++c) coordinate[c * lanes<V, N> + i] = job.point[3 * from + c];
    if (!mixed) continue;
    float const* row = job.bias_rows + static_cast<long>(job.row[from]) * net.padded[1];
    for (int j = 0; j < net.padded[1]; ++j) bias[j * lanes<V, N> + i] = row[j];
  }
}

SCREE_INLINE bool rows_differ(BlockJob const& job) {
  if (!job.row) return false;
  int different = 0;
  for (int i = 1; i < job.count; ++i) different |= job.row[i] ^ job.row[0];
  return different != 0;
}

SCREE_INLINE int widest(PackedView const& net) {
  int w = 0;
  for (int l = 1; l <= net.hidden; ++l) w = net.padded[l] > w ? net.padded[l] : w;
  return w;
}

// Scratch in rows of lanes: 3 coordinates | mixed bias | two activation buffers | one record a hidden layer.
template <class V, int N, class Act, bool with_gradient>
void evaluate_block(PackedView const& net, BlockJob const& job) {
  Act const act(net);
  int const buffer = widest(net) * lanes<V, N>;
  float* const coordinate = job.scratch;
  float* const bias = coordinate + 3 * lanes<V, N>;
  float* const ping[2] = {bias + buffer, bias + 2 * buffer};
  float* const records = bias + 3 * buffer;
  bool const mixed = rows_differ(job);
  gather<V, N>(net, job, mixed, coordinate, bias);

  constexpr bool in_record = with_gradient && Act::remembers_value;  // the record doubles as the activations
  float const* in = coordinate;
  for (int l = 0; l < net.hidden; ++l) {
    float* const record = with_gradient ? records + l * buffer : nullptr;
    float* const out = in_record ? record : ping[l & 1];
    int const depth = net.width[l], neurons = net.padded[l + 1];
    if (l == 0 && mixed)
      hidden_layer<V, N, Act, true, with_gradient>(act, depth, neurons, net.forward[0], bias, in, out, record);
    else
      hidden_layer<V, N, Act, false, with_gradient>(
          act, depth, neurons, net.forward[l],
          l > 0 ? net.bias[l] : job.bias_rows + (job.row ? static_cast<long>(job.row[0]) * net.padded[1] : 0), in, out,
          record);
    in = out;
  }
  last_layer<V, N>(net, in, coordinate);  // coordinates are no longer needed
  for (int i = 0; i < job.count; ++i) job.phi[i] = coordinate[i];

  if constexpr (with_gradient) {
    float const* record = records + (net.hidden - 1) * buffer;
    float* g = ping[0];
    for (int k = 0; k < net.padded[net.hidden]; ++k) {
      V const w = V::broadcast(net.last_backward[k]);
      for (int at = k * lanes<V, N>; at < (k + 1) * lanes<V, N>; at += V::size)
        V::store(g + at, act.backward(w, V::load(record + at)));
    }
    for (int l = net.hidden - 1; l > 0; --l) {
      float* const below = g == ping[0] ? ping[1] : ping[0];
      backward_layer<V, N>(act, net.width[l + 1], net.padded[l], net.backward[l], g, records + (l - 1) * buffer, below);
      g = below;
    }
    V sum[3][N];
    for (auto& row : sum)
      for (V& s : row) s = V::constant(0.0f);
    accumulate<V, N, 3>(sum, net.width[1], net.backward[0], g);
    for (int c = 0; c < 3; ++c)
      for (int v = 0; v < N; ++v) V::store(coordinate + c * lanes<V, N> + v * V::size, sum[c][v]);
    for (int i = 0; i < job.count; ++i)
      for (int c = 0; c < 3; ++c) job.gradient[3 * i + c] = coordinate[c * lanes<V, N> + i];
  }
}

// Functions of a block N vectors wide; the order is that of enum Activation.
template <class V, int N>
constexpr BlockFunctions block_functions = {
    {evaluate_block<V, N, LeakyRelu<V>, false>, evaluate_block<V, N, Sine<V>, false>,
     evaluate_block<V, N, Softplus<V>, false>},
    {evaluate_block<V, N, LeakyRelu<V>, true>, evaluate_block<V, N, Sine<V>, true>,
     evaluate_block<V, N, Softplus<V>, true>}};

// The table of an ISA.
template <class V>
constexpr Isa make_isa(char const* name) {
  static_assert(V::vectors == 2 || V::vectors == 3);
  Isa isa{name, V::size, V::vectors, V::panel, {block_functions<V, 1>, block_functions<V, 2>}};
  if constexpr (V::vectors == 3) isa.blocks[2] = block_functions<V, 3>;
  return isa;
}

}  // namespace
}  // namespace scree::sdf_cpu

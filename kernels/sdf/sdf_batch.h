// sdf_batch.h: contract of the fused batch evaluation of one network at many points.
// The hot loop of the engine. CPU: mlp_cpu*.cpp (SIMD, ISA chosen at run time).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernels/base/queue.h"
#include "kernels/base/span.h"
#include "kernels/base/vec.h"
#include "kernels/sdf/mlp.h"

namespace scree {

// A network in the layout its evaluator likes (padded panels, activation constants folded). Immutable; shareable
// between threads. One object serves every shape of a decoder: what differs between shapes is the first-layer bias.
class PackedMlp {
 public:
  // Throws std::invalid_argument listing problems(net), or when a hidden width exceeds 64, a leaky_relu slope 1, or
  // omega or beta is zero. sine: right for |omega z| < 1e7, far beyond what float can resolve.
  explicit PackedMlp(Mlp const& net);
  ~PackedMlp();
  PackedMlp(PackedMlp&&) noexcept;
  PackedMlp& operator=(PackedMlp&&) noexcept;

  Mlp const& net() const;
  // Numbers of one first-layer bias row as evaluate() takes it (>= width[1], padded).
  int bias_stride() const;
  // Convert a row from fold_code() into evaluator layout, appended to `rows`; returns the row's index.
  int append_bias(Span<const float> first_bias, std::vector<float>& rows) const;

  struct Data;
  Data const& data() const { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

// phi[i] = net(point[i]; bias row row[i]).
//   point  network frame (n);  row  index into `bias_rows` (n), or empty: row 0 for all
//   bias_rows  bias_stride() floats a row, from append_bias
// phi of a point has the same bits at any position, batch size, tail and thread count, and from either function.
// Error against evaluate_reference <= 1e-5 of the network's unit. Cost: 2 * sum(width_in * width_out) FLOP a point;
// the gradient is reverse mode, twice the forward cost again. Fastest when neighbours share a row.
void sdf_forward(Queue const& queue, PackedMlp const& net, Span<const float> bias_rows, Span<const Vec3f> point,
                 Span<const int> row, Span<float> phi);
void sdf_forward_gradient(Queue const& queue, PackedMlp const& net, Span<const float> bias_rows,
                          Span<const Vec3f> point, Span<const int> row, Span<float> phi, Span<Vec3f> gradient);

// Name of the instruction set in use ("avx512", "avx2", "generic"). SCREE_ISA in the environment overrides the choice.
// The choice falls when a PackedMlp is made. Throws std::invalid_argument when this CPU does not offer it.
std::string sdf_isa();

// All that this CPU offers, best first.
std::vector<std::string> sdf_isas();

}  // namespace scree

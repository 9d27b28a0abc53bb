// mlp_cpu.cpp: packing, choice of the instruction set, argument checks and chunking of the CPU batch evaluator.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sdf/mlp_cpu.h"

#include <omp.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "kernels/base/profile.h"
#include "kernels/sdf/mlp_fold.h"
#include "kernels/sdf/sdf_batch.h"

namespace scree {

namespace {

int constexpr max_width = 64;        // a block's activations must stay in L1
int constexpr blocks_per_task = 16;  // 384 points with AVX2, some 50 us: repays handing it to a thread

using sdf_cpu::Isa;

std::vector<Isa const*> supported_isas() {  // best first
  std::vector<Isa const*> isas;
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f")) isas.push_back(&sdf_cpu::avx512_isa);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) isas.push_back(&sdf_cpu::avx2_isa);
#endif
  isas.push_back(&sdf_cpu::generic_isa);
  return isas;
}

Isa const& chosen_isa() {
  auto const isas = supported_isas();
  char const* const wanted = std::getenv("SCREE_ISA");
  if (!wanted || !*wanted) return *isas.front();
  std::string names;
  for (Isa const* isa : isas) {
    if (std::string(wanted) == isa->name) return *isa;
    names += std::string(names.empty() ? "" : ", ") + isa->name;
  }
  throw std::invalid_argument("SCREE_ISA=" + std::string(wanted) + ": this CPU offers " + names);
}

// Floats on cache line boundaries.
struct alignas(64) Line {
  float value[16];
};
float* aligned(std::vector<Line>& lines, std::size_t floats) {
  if (lines.size() * 16 < floats) lines.resize((floats + 15) / 16);
  return lines.empty() ? nullptr : lines.front().value;
}

int round_up(int n, int step) { return (n + step - 1) / step * step; }

}  // namespace

struct PackedMlp::Data {
  Mlp net;
  Isa const* isa = nullptr;
  Fold fold;
  std::vector<int> width, padded;  // width as net's, but 3 inputs: the code is folded away
  std::vector<Line> storage;       // every panel and bias, one after the other
  std::vector<float const*> forward, bias, backward;
  sdf_cpu::PackedView view;
  int scratch = 0;  // floats a block needs

  void pack();
};

namespace {

// Panels of `panel` outputs: target[(j / panel) * depth * panel + k * panel + j % panel] = factor * weight(k, j).
template <class Weight>
void pack_panels(int depth, int outputs, int panel, double factor, Weight const& weight, float* target) {
  for (int j = 0; j < round_up(outputs, panel); ++j)
    for (int k = 0; k < depth; ++k)
      target[std::size_t(j / panel) * depth * panel + std::size_t(k) * panel + j % panel] =
          j < outputs ? static_cast<float>(factor * weight(k, j)) : 0.0f;
}

}  // namespace

void PackedMlp::Data::pack() {
  int const hidden = net.layers() - 1, panel = isa->panel;
  width = net.width;
  width.front() = 3;
  padded = width;
  for (int l = 1; l <= hidden; ++l) padded[l] = round_up(padded[l], panel);
  int const widest = *std::max_element(padded.begin() + 1, padded.end());
  scratch = sdf_cpu::scratch_rows(hidden, widest) * isa->lanes();

  std::size_t const layer_floats = std::size_t(widest) * widest;  // an upper bound, a whole number of lines
  std::size_t const padded_layer = (layer_floats + 15) / 16 * 16, padded_row = std::size_t(round_up(widest, 16));
  float* next = aligned(storage, (2 * hidden) * padded_layer + (hidden + 2) * padded_row);
  auto const take = [&](std::size_t floats) { return std::exchange(next, next + floats); };
  for (int l = 0; l < hidden; ++l) {
    int const in = width[l], out = width[l + 1];
    auto const& w = net.weight[l];
    float* const f = take(padded_layer);
    pack_panels(
        in, out, panel, l == 0 ? fold.first : fold.middle, [&](int k, int j) { return w[std::size_t(k) * out + j]; },
        f);
    forward.push_back(f);
    float* const b = take(padded_row);
    for (int j = 0; j < out; ++j) b[j] = static_cast<float>(fold.hidden_bias * net.bias[l][j]);
    bias.push_back(b);
    float* const r = take(padded_layer);
    pack_panels(
        out, in, l == 0 ? 3 : panel, l == 0 ? fold.backward_first : fold.backward_middle,
        [&](int k, int j) { return w[std::size_t(j) * out + k]; }, r);
    backward.push_back(r);
  }
  float* const last_forward = take(padded_row);
  float* const last_backward = take(padded_row);
  for (int k = 0; k < width[hidden]; ++k) {
    last_forward[k] = static_cast<float>(fold.last * net.weight[hidden][k]);
    last_backward[k] = static_cast<float>(fold.backward_last * net.weight[hidden][k]);
  }
  view = {hidden,          width.data(), padded.data(), forward.data(),      bias.data(),
          backward.data(), last_forward, last_backward, net.bias[hidden][0], static_cast<float>(net.parameter)};
}

PackedMlp::PackedMlp(Mlp const& net) : data_(std::make_unique<Data>()) {
  auto found = problems(net);
  for (std::size_t l = 1; l + 1 < net.width.size(); ++l)
    if (net.width[l] > max_width)
      found.push_back("hidden width " + std::to_string(net.width[l]) + " exceeds " + std::to_string(max_width));
  if (net.activation == Activation::leaky_relu && net.parameter > 1)
    found.push_back("the leaky_relu slope must be 0..1");
  if (net.activation != Activation::leaky_relu && !(net.parameter > 0))
    found.push_back(std::string("the parameter of ") + to_string(net.activation) + " must be positive");
  std::string text;
  for (auto const& f : found) text += (text.empty() ? "PackedMlp: " : "; ") + f;
  if (!text.empty()) throw std::invalid_argument(text);
  data_->net = net;
  data_->isa = &chosen_isa();
  data_->fold = fold_of(net);
  data_->pack();
}
PackedMlp::~PackedMlp() = default;
PackedMlp::PackedMlp(PackedMlp&&) noexcept = default;
PackedMlp& PackedMlp::operator=(PackedMlp&&) noexcept = default;

Mlp const& PackedMlp::net() const { return data_->net; }

int PackedMlp::bias_stride() const { return data_->padded[1]; }

int PackedMlp::append_bias(Span<const float> first_bias, std::vector<float>& rows) const {
  if (first_bias.size() != net().width[1])
    throw std::invalid_argument("append_bias: the row has " + std::to_string(first_bias.size()) +
                                " numbers, the first hidden layer " + std::to_string(net().width[1]));
  if (rows.size() % bias_stride() != 0)
    throw std::invalid_argument("append_bias: rows are not whole rows of this network");
  std::size_t const row = rows.size() / bias_stride();
  for (float b : first_bias) rows.push_back(static_cast<float>(data_->fold.hidden_bias * b));
  rows.resize((row + 1) * bias_stride(), 0.0f);
  return static_cast<int>(row);
}

namespace {

void check(char const* who, Queue const& queue, PackedMlp const& net, Span<const float> bias_rows,
           Span<const Vec3f> point, Span<const int> row, int phi, int gradient) {
  auto const fail = [&](std::string const& what) { throw std::invalid_argument(std::string(who) + ": " + what); };
  if (queue.backend != Backend::cpu) fail("this evaluator runs on the CPU backend only");
  int const n = point.size(), stride = net.bias_stride(), rows = bias_rows.size() / stride;
  if (phi != n) fail("phi holds " + std::to_string(phi) + " numbers for " + std::to_string(n) + " points");
  if (gradient != n)
    fail("gradient holds " + std::to_string(gradient) + " vectors for " + std::to_string(n) + " points");
  if (!row.empty() && row.size() != n)
    fail("row holds " + std::to_string(row.size()) + " indices for " + std::to_string(n) + " points");
  if (bias_rows.size() % stride != 0 || (n > 0 && rows == 0))
    fail("bias_rows holds " + std::to_string(bias_rows.size()) + " numbers, not rows of " + std::to_string(stride));
  unsigned largest = 0;  // a negative index is a very large one
  for (int r : row) largest = std::max(largest, static_cast<unsigned>(r));
  if (!row.empty() && largest >= static_cast<unsigned>(rows))
    fail("a row index is outside 0.." + std::to_string(rows - 1));
}

void evaluate(Queue const& queue, PackedMlp const& net, Span<const float> bias_rows, Span<const Vec3f> point,
              Span<const int> row, Span<float> phi, Vec3f* gradient) {
  static_assert(sizeof(Vec3f) == 3 * sizeof(float));
  auto const& data = net.data();
  int const n = point.size(), lanes = data.isa->lanes();
  int const blocks = (n + lanes - 1) / lanes, tasks = (blocks + blocks_per_task - 1) / blocks_per_task;
  int const threads = std::clamp(queue.threads, 1, tasks);
  auto const which = static_cast<int>(data.net.activation);
  thread_local std::vector<Line> lines;  // kept: a fresh allocation a call would fault its pages in again
  std::size_t const stride = std::size_t(round_up(data.scratch, 16)) + 16;  // a line apart: threads share none
  float* const scratch = aligned(lines, stride * threads);

  auto const run = [&](int task, int thread) {
    for (int b = task * blocks_per_task; b < std::min(blocks, (task + 1) * blocks_per_task); ++b) {
      int const first = b * lanes, count = std::min(lanes, n - first);
      sdf_cpu::BlockFunctions const& wide = data.isa->blocks[(count - 1) / data.isa->size];
      auto const function = gradient ? wide.gradient[which] : wide.forward[which];
      function(data.view, {&point.data[first].x, row.empty() ? nullptr : row.data + first, bias_rows.data, count,
                           phi.data + first, gradient ? &gradient[first].x : nullptr, scratch + stride * thread});
    }
  };
  if (threads == 1) {
    for (int t = 0; t < tasks; ++t) run(t, 0);
    return;
  }
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (int t = 0; t < tasks; ++t) run(t, omp_get_thread_num());
}

}  // namespace

void sdf_forward(Queue const& queue, PackedMlp const& net, Span<const float> bias_rows, Span<const Vec3f> point,
                 Span<const int> row, Span<float> phi) {
  check("sdf_forward", queue, net, bias_rows, point, row, phi.size(), point.size());
  if (point.empty()) return;
  ScopedTimer const timer(queue.profile, "sdf_net/forward", point.size());
  evaluate(queue, net, bias_rows, point, row, phi, nullptr);
}

void sdf_forward_gradient(Queue const& queue, PackedMlp const& net, Span<const float> bias_rows,
                          Span<const Vec3f> point, Span<const int> row, Span<float> phi, Span<Vec3f> gradient) {
  check("sdf_forward_gradient", queue, net, bias_rows, point, row, phi.size(), gradient.size());
  if (point.empty()) return;
  ScopedTimer const timer(queue.profile, "sdf_net/gradient", point.size());
  evaluate(queue, net, bias_rows, point, row, phi, gradient.data);
}

std::string sdf_isa() { return chosen_isa().name; }

std::vector<std::string> sdf_isas() {
  std::vector<std::string> names;
  for (Isa const* isa : supported_isas()) names.push_back(isa->name);
  return names;
}

}  // namespace scree

// generate.cpp: see generate.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/generate.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "shapes/normalise.h"
#include "shapes/roundness.h"
#include "shapes/solid_check.h"
#include "shapes/zero_set.h"

namespace scree {
namespace {

int constexpr check_points = 2000;  // gradients and interior: percentiles to a few per cent of their spread
int constexpr lipschitz_samples = 20000;
int constexpr hopeless_after = 200;

// Streams of one seed for every try (Steele et al. 2014, splitmix64's finaliser).
std::uint64_t stream_seed(std::uint64_t seed, int attempt) {
  std::uint64_t z = seed + 0x9e3779b97f4a7c15u * (static_cast<std::uint64_t>(attempt) + 1);
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
  z = (z ^ z >> 27) * 0x94d049bb133111ebu;
  return z ^ z >> 31;
}

// work(i) for i < n on `threads` threads; what one throws is thrown again here.
template <class Work>
void for_each(int n, int threads, Work const& work) {
  std::exception_ptr thrown;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (int i = 0; i < n; ++i) {
    try {
      work(i);
    } catch (...) {
#pragma omp critical(scree_generate)
      thrown = std::current_exception();
    }
  }
  if (thrown) std::rethrow_exception(thrown);
}

Verdict judge(Candidate const& c, ShapeLimits const& limits) {
  Certificate const& measured = c.shape.certificate;
  if (measured.components != 1) return Verdict::parts;
  if (c.euler != 2) return Verdict::holes;
  if (!(measured.gradient_p1 >= limits.gradient.low && measured.gradient_p99 <= limits.gradient.high))
    return Verdict::gradient;
  if (!(c.falling <= limits.falling)) return Verdict::falling;
  std::pair<double, std::pair<Interval, Verdict>> const screens[] = {
      {c.volume_ratio, {limits.volume, Verdict::volume}},
      {c.form.sphericity, {limits.sphericity, Verdict::sphericity}},
      {c.form.convexity, {limits.convexity, Verdict::convexity}},
      {c.form.elongation, {limits.elongation, Verdict::elongation}},
      {c.form.flatness, {limits.flatness, Verdict::flatness}},
      {c.roundness, {limits.roundness, Verdict::roundness}}};
  for (auto const& [value, screen] : screens)
    if (!screen.first.contains(value)) return screen.second;
  return Verdict::accepted;
}

// The zero set must end before the edge of the ball: beyond, a network grows solid that nobody asked for.
bool leaves(Shape const& shape, CodeFrame const& frame) {
  Vec3 const centre = shape.query.shift;  // of the shape in the network's frame
  return norm(centre) + shape.query.scale * shape.bounding_radius > 0.999 * frame.radius;
}

}  // namespace

char const* to_string(Verdict verdict) {
  static char const* const names[verdicts] = {"accepted",   "no solid", "leaves ball", "parts",      "holes",
                                              "gradient",   "falling",  "volume",      "sphericity", "convexity",
                                              "elongation", "flatness", "roundness"};
  return names[static_cast<int>(verdict)];
}

CodeFrame code_frame(Library const& library, int net) {
  CodeFrame frame;
  frame.net = net;
  int known = 0;
  for (Shape const& s : library.shape) {
    if (!s.is_net() || s.net != net) continue;
    // 1.1 bounding radii is what training samples, and what a shape promises (Shape::bounding_radius).
    frame.radius = std::max(frame.radius, norm(s.query.shift) + 1.1 * s.query.scale * s.bounding_radius);
    frame.diameter += s.query.scale;
    ++known;
  }
  if (known == 0) throw std::invalid_argument("code_frame: no shape uses network " + std::to_string(net));
  frame.diameter /= known;
  return frame;
}

Candidate judge_code(Library const& library, CodeFrame const& frame, std::vector<float> code, ShapeLimits const& limits,
                     std::string name, std::string source) {
  Candidate c;
  Library alone;  // so that threads share nothing
  alone.net.push_back(library.net.at(static_cast<std::size_t>(frame.net)));
  alone.shape.emplace_back();
  Shape& shape = alone.shape[0];
  shape.name = std::move(name);
  shape.kind = ShapeKind::net;
  shape.net = 0;
  shape.code = std::move(code);
  shape.certificate.source = std::move(source);
  try {
    normalise_net(alone, 0, frame.radius, {.cells = limits.cells, .lipschitz_samples = lipschitz_samples});
  } catch (std::runtime_error const&) {
    c.shape = shape;
    return c;
  }
  c.volume_ratio = std::pow(shape.query.scale / frame.diameter, 3);
  if (leaves(shape, frame)) {
    c.verdict = Verdict::leaves_ball;
  } else {
    PhiBatch const phi = fast_phi(alone, shape);
    ZeroSet const set = find_zero_set(phi, {1.05 * shape.bounding_radius, limits.cells, shape.lipschitz});
    SolidCheck const solid = check_solid(phi, set, shape.bounding_radius, check_points);
    Certificate& certificate = shape.certificate;
    certificate.components = set.components;
    certificate.euler = set.euler_characteristic;
    certificate.falling = solid.falling;
    certificate.gradient_p1 = solid.gradient_p1, certificate.gradient_p5 = solid.gradient_p5;
    certificate.gradient_p95 = solid.gradient_p95, certificate.gradient_p99 = solid.gradient_p99;
    c.euler = set.euler_characteristic;
    c.falling = solid.falling;
    c.form = describe(set.mesh);
    c.roundness = roundness(set.mesh, set.normal);
    c.shape = shape;
    c.verdict = judge(c, limits);
  }
  c.shape = shape;
  c.shape.net = frame.net;
  return c;
}

std::string tally(std::array<int, verdicts> const& count) {
  std::string text = std::to_string(count[0]) + " accepted", rejected;
  for (int v = 1; v < verdicts; ++v)
    if (count[v] > 0) {
      rejected += rejected.empty() ? ", rejected: " : ", ";
      rejected += std::string(to_string(static_cast<Verdict>(v))) + " " + std::to_string(count[v]);
    }
  return text + rejected;
}

Generation sample_shapes(Library const& library, SampleOptions const& options) {
  if (options.count < 1) throw std::invalid_argument("sample_shapes: count must be positive");
  if (!(options.truncate > 0)) throw std::invalid_argument("sample_shapes: truncate must be positive");
  Generation made;
  made.gaussian = fit_codes(library, options.category, options.shrinkage);
  CodeFrame const frame = code_frame(library, made.gaussian.net);
  // Where none of the first tries passes, thousands more would only take time.
  auto const limit = [&] {
    if (options.max_tries > 0) return options.max_tries;
    return made.accepted.empty() ? hopeless_after : std::max(hopeless_after, 50 * options.count);
  };
  std::string const prefix = options.prefix.empty() ? options.category + "/" : options.prefix;
  while (static_cast<int>(made.accepted.size()) < options.count && made.tries < limit()) {
    // Tries between two looks at what has passed; any number gives the same shapes.
    int const missing = options.count - static_cast<int>(made.accepted.size());
    int const first = made.tries, n = std::min(std::max(std::min(missing, 64), options.threads), limit() - first);
    std::vector<Candidate> candidate(n);
    for_each(n, options.threads, [&](int i) {
      Random random(stream_seed(options.seed, first + i));
      candidate[i] = judge_code(library, frame, draw_code(made.gaussian, options.truncate, random), options.limits, "",
                                "sample of " + options.category + ", seed " + std::to_string(options.seed) + ", try " +
                                    std::to_string(first + i));
    });
    for (int i = 0; i < n && static_cast<int>(made.accepted.size()) < options.count; ++i) {
      ++made.tries;
      ++made.count[static_cast<int>(candidate[i].verdict)];
      if (candidate[i].verdict != Verdict::accepted) continue;
      candidate[i].shape.name = prefix + std::to_string(made.accepted.size());
      candidate[i].shape.certificate.seed = static_cast<std::int64_t>(options.seed);
      made.accepted.push_back(std::move(candidate[i]));
    }
  }
  if (static_cast<int>(made.accepted.size()) < options.count)
    throw std::invalid_argument("asked for " + std::to_string(options.count) + " samples of " + options.category +
                                ", " + std::to_string(made.tries) + " tries gave " + tally(made.count) +
                                "; widen the limits that reject most, or ask for fewer");
  return made;
}

std::vector<Candidate> interpolate_shapes(Library const& library, Shape const& from, Shape const& to,
                                          std::vector<double> const& t, ShapeLimits const& limits, int threads) {
  std::vector<std::vector<float>> code;
  for (double s : t) code.push_back(interpolate_codes(from, to, s));
  CodeFrame const frame = code_frame(library, from.net);
  int const n = static_cast<int>(t.size());
  std::vector<Candidate> made(n);
  for_each(n, threads, [&](int i) {
    made[i] = judge_code(library, frame, code[i], limits, "step/" + std::to_string(i),
                         "t = " + std::to_string(t[i]) + " from " + from.name + " to " + to.name);
  });
  return made;
}

}  // namespace scree

// sampled_grains.cpp: see sampled_grains.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/sampled_grains.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "core/nearest_name.h"
#include "core/placement.h"

namespace scree {
namespace {

FormScreen constexpr screen_table[] = {
    {"sphericity", &SampleCase::sphericity, &ShapeLimits::sphericity, "area of the equal-volume sphere over the area"},
    {"convexity", &SampleCase::convexity, &ShapeLimits::convexity, "volume over that of the convex hull"},
    {"elongation", &SampleCase::elongation, &ShapeLimits::elongation, "EI = b / a"},
    {"flatness", &SampleCase::flatness, &ShapeLimits::flatness, "FI = c / b"},
    {"roundness", &SampleCase::roundness, &ShapeLimits::roundness, "corner radii over the inscribed radius"},
};

ShapeLimits gate_of(LimitsCase const& limits) {
  ShapeLimits gate;
  gate.gradient = {limits.gradient_low, limits.gradient_high};
  gate.falling = limits.falling;
  return gate;
}

MadeShapes draw_shapes(Library const& from, SampleCase const& wanted, int count, ShapeLimits gate, std::uint64_t seed,
                       int threads) {
  for (FormScreen const& s : screen_table) gate.*s.limit = wanted.*s.wanted;
  SampleOptions options;
  options.category = wanted.category;
  options.count = count;
  options.truncate = wanted.truncate;
  options.seed = seed;
  options.limits = gate;
  options.threads = threads;
  Generation made = sample_shapes(from, options);
  MadeShapes out;
  for (Candidate& c : made.accepted) out.shape.push_back(std::move(c.shape));
  out.note = fmt::format("{} tries of {}: {}", made.tries, wanted.category, tally(made.count));
  return out;
}

Shape const& shape_called(Library const& library, std::string const& name) {
  std::vector<std::string> known;
  for (Shape const& s : library.shape) {
    if (s.name == name) return s;
    if (!s.code.empty()) known.push_back(s.name);
  }
  throw std::invalid_argument(
      fmt::format("no shape '{}'{}; `scree info` lists what the library has", name, did_you_mean(name, known)));
}

// Every t of a fixed line has to be a grain.
MadeShapes shapes_on_line(Library const& from, InterpolateCase const& line, int count, ShapeLimits const& gate,
                          int threads) {
  std::vector<double> t{line.low};
  if (line.low < line.high)
    for (int i = 1; i < count; ++i) t.push_back(line.low + (line.high - line.low) * i / (count - 1));
  std::vector<Candidate> made =
      interpolate_shapes(from, shape_called(from, line.from), shape_called(from, line.to), t, gate, threads);
  std::string failed;
  int constexpr named = 5;  // of those that fail
  int failures = 0;
  MadeShapes out;
  for (std::size_t i = 0; i < made.size(); ++i) {
    if (made[i].verdict == Verdict::accepted)
      out.shape.push_back(std::move(made[i].shape));
    else if (++failures <= named)
      failed += fmt::format("{}t = {:.4g}: {}", failures > 1 ? ", " : "", t[i], to_string(made[i].verdict));
  }
  if (failures > 0)
    throw std::invalid_argument(
        fmt::format("{} of {} shapes from '{}' to '{}' do not pass the gate ({}{}); choose "
                    "another t, or t = \"random\", which draws again",
                    failures, t.size(), line.from, line.to, failed, failures > named ? ", ..." : ""));
  out.note = fmt::format("{} shapes from '{}' to '{}', t = {:.4g} ... {:.4g}", t.size(), line.from, line.to, line.low,
                         t.back());
  return out;
}

MadeShapes random_shapes_on_line(Library const& from, InterpolateCase const& line, int count, ShapeLimits const& gate,
                                 std::mt19937_64 random, int threads) {
  int constexpr hopeless_after = 200;
  Shape const &a = shape_called(from, line.from), &b = shape_called(from, line.to);
  MadeShapes out;
  std::array<int, verdicts> counted{};
  int tries = 0;
  while (static_cast<int>(out.shape.size()) < count) {
    // As many as are missing: none is drawn in vain, so the threads do not decide what comes next.
    std::vector<double> t(std::min(count - out.shape.size(), std::size_t{64}));
    for (double& x : t) x = line.low + (line.high - line.low) * uniform(random);
    for (Candidate& c : interpolate_shapes(from, a, b, t, gate, threads)) {
      ++tries;
      ++counted[static_cast<int>(c.verdict)];
      if (c.verdict == Verdict::accepted) out.shape.push_back(std::move(c.shape));
    }
    if (out.shape.empty() ? tries >= hopeless_after : tries >= std::max(hopeless_after, 50 * count))
      throw std::invalid_argument(
          fmt::format("{} tries between '{}' and '{}' gave {}, of {} wanted; choose other shapes", tries, line.from,
                      line.to, tally(counted), count));
  }
  out.note = fmt::format("{} tries between '{}' and '{}': {}", tries, line.from, line.to, tally(counted));
  return out;
}

}  // namespace

Span<FormScreen const> form_screens() { return {screen_table, static_cast<int>(std::size(screen_table))}; }

MadeShapes make_shapes(Library const& from, GrainsCase const& grains, LimitsCase const& limits, std::uint64_t seed,
                       int group, int threads) {
  MadeShapes out;
  if (grains.count == 0) return out;
  std::mt19937_64 random = random_stream(seed, group, Draw::codes);
  ShapeLimits const gate = gate_of(limits);
  if (grains.sample)
    out = draw_shapes(from, *grains.sample, grains.count, gate, random(), threads);
  else if (grains.interpolate->random)
    out = random_shapes_on_line(from, *grains.interpolate, grains.count, gate, random, threads);
  else
    out = shapes_on_line(from, *grains.interpolate, grains.count, gate, threads);
  out.note = fmt::format("grains '{}': {}", grains.name, out.note);
  return out;
}

std::string made_category(GrainsCase const& grains) {
  auto const kind_of = [](std::string const& shape) {
    std::string const category = category_of(shape);
    return category.empty() ? shape : category;
  };
  std::string kind;
  if (grains.sample) {
    kind = grains.sample->category;
  } else {
    std::string const from = kind_of(grains.interpolate->from), to = kind_of(grains.interpolate->to);
    kind = from == to ? from : from + "-" + to;
  }
  return kind.empty() ? grains.name : kind + "/" + grains.name;
}

}  // namespace scree

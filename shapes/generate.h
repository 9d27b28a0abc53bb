// generate.h: grains that never existed: a code becomes a normalised shape, is described, and passes the gate or not.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "shapes/descriptors.h"
#include "shapes/latent.h"
#include "shapes/shape.h"

namespace scree {

struct Interval {
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool contains(double x) const { return x >= low && x <= high; }
  bool operator==(Interval const&) const = default;
};

// What a generated shape has to be. The first group is the gate and always on, the second the screening by form.
struct ShapeLimits {
  int cells = 48;  // across the ball in which the zero set is sought: what is thinner than a cell goes unseen
  Interval gradient{0.5, 2};      // 1st and 99th percentile of |grad phi| within 0.05 d of the surface
  double falling = 0.02;          // largest share of the interior at which phi does not rise inwards
  Interval volume{0.7, 1 / 0.7};  // before normalisation, over that of the category's known shapes
  Interval sphericity, convexity, elongation, flatness, roundness;  // shapes/descriptors.h, shapes/roundness.h
};

// The verdict on a code: the first test it failed, in this order.
enum class Verdict {
  accepted,
  no_solid,     // no zero set, or one that encloses no volume
  leaves_ball,  // the zero set reaches the edge of the ball in which the network was trained
  parts,        // several components, or a void
  holes,        // Euler characteristic other than 2: a handle
  gradient,
  falling,
  volume,
  sphericity,
  convexity,
  elongation,
  flatness,
  roundness
};
int constexpr verdicts = 13;
char const* to_string(Verdict verdict);

struct Candidate {
  Shape shape;  // normalised and certified by what phi tells, unless there is no solid; its network is the library's
  Descriptors form;
  double roundness = 0;
  int euler = 0;            // Euler characteristic of the zero set
  double falling = -1;      // solid_check.h
  double volume_ratio = 0;  // before normalisation, over pi/6 times the cubed mean diameter of the known shapes
  Verdict verdict = Verdict::no_solid;
};

// The ball in which a decoder may be asked, and the size of what it was trained on, from the shapes that are known.
struct CodeFrame {
  int net = -1;
  double radius = 0;    // of the ball, about the origin of the network's frame [network's unit]
  double diameter = 0;  // mean equal-volume diameter [network's unit]
};
CodeFrame code_frame(Library const& library, int net);

// One code through all of it. `name` and `source` go into the shape. Deterministic, serial; about 0.5 s for a 6x64
// network.
Candidate judge_code(Library const& library, CodeFrame const& frame, std::vector<float> code, ShapeLimits const& limits,
                     std::string name, std::string source);

struct SampleOptions {
  std::string category;
  int count = 1;
  double truncate = 2;   // of the whitened coordinates [standard deviations]
  double shrinkage = 0;  // fit_codes
  std::uint64_t seed = 1;
  ShapeLimits limits;
  int max_tries = 0;   // 0: 50 times count, and at least 200; but 200 when none of those passes
  std::string prefix;  // of the shapes' names: prefix + "0", ...; empty: "<category>/"
  int threads = 1;
};

struct Generation {
  std::vector<Candidate> accepted;    // in the order of their tries
  std::array<int, verdicts> count{};  // of every verdict
  int tries = 0;
  CodeGaussian gaussian;
};

// `count` shapes that pass. Try k draws from its own stream of the seed, and the first ones that pass are taken: the
// result depends neither on threads nor on max_tries, and a smaller count gives the beginning of a larger one.
// Throws std::invalid_argument for a bad option or category, and with the counts when the tries run out.
Generation sample_shapes(Library const& library, SampleOptions const& options);

// The shape at every t of the line between two codes; all are returned, with their verdicts.
std::vector<Candidate> interpolate_shapes(Library const& library, Shape const& from, Shape const& to,
                                          std::vector<double> const& t, ShapeLimits const& limits, int threads = 1);

// "34 accepted, rejected: convexity 812, parts 3".
std::string tally(std::array<int, verdicts> const& count);

}  // namespace scree

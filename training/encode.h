// encode.h: the latent code of a body that a decoder has never seen; the decoder stays as it is.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "shapes/shape.h"
#include "training/dataset.h"

namespace scree {

struct EncodeOptions {
  int samples = 8000;   // of phi, on both sides of the surface and some in the ball
  int trial = 500;      // of them, for the first iterations from every start
  int nearest = 2;      // known codes to start from, of each turn those that fit best
  int finalists = 4;    // best trials that go on with all samples
  int iterations = 60;  // at most, of the finalists
  int test = 8000;      // points of the paper's shell, others than the samples, at which errors are stated
  std::uint64_t seed = 1;
  int threads = 2;
};

// One start and where it led. Errors: mean |phi - distance| at the test points [d].
struct EncodeStart {
  std::string name;   // "mean", "mean of ballast", "ballast/3"
  int turn = 0;       // the body's principal frame: 0 as it is, 1, 2, 3 by half a turn about x, y, z
  double before = 0;  // of the start itself
  double after = 0;   // of where it ended, after a trial or to the end
  bool finalist = false;
};

struct Encoding {
  Shape shape;                     // code and query; not normalised, its network is the library's
  std::vector<EncodeStart> start;  // the one that won first, then by `after`
};

// Levenberg and Marquardt on the code and on where the body lies in the network's frame (turn, shift and size: 7
// numbers more, since principal axes say little of a nearly round body) for the smallest mean sqrt(r^2 + w^2) of the
// residual r = phi - distance, w = 1e-3 d, by reweighting. Principal axes are known up to four proper turns, and the
// error has many valleys, so that it starts from the mean of all codes, that of each category, and the known codes that
// fit best, each in all four turns. Deterministic, whatever the threads; about a minute for a 6x64 decoder on two
// cores. Throws std::invalid_argument when the library has no codes, or codes of several networks.
Encoding encode(Library const& library, Body const& body, EncodeOptions const& options);

}  // namespace scree

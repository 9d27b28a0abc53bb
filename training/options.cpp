// options.cpp: validity of training options.
// SPDX-License-Identifier: Apache-2.0
#include "training/options.h"

#include <cmath>

namespace scree {

std::vector<std::string> problems(TrainOptions const& o) {
  std::vector<std::string> result;
  auto const require = [&](bool ok, char const* text) {
    if (!ok) result.emplace_back(text);
  };
  require(o.activation == Activation::sine || o.activation == Activation::leaky_relu,
          "activation must be sine or leaky_relu: these two are trained and run fast");
  require(std::isfinite(o.parameter) && o.parameter > 0, "activation parameter must be positive");
  require(o.layers >= 1 && o.layers <= 16, "layers must be 1..16");
  require(o.width >= 8 && o.width <= 64, "width must be 8..64: wider networks are not evaluated fast");
  require(o.code_size >= 0 && o.code_size <= 64, "code size must be 0..64");
  require(o.steps >= 1, "steps must be at least 1");
  require(o.rows >= 1 && o.units >= 1 && o.units <= 64, "rows must be at least 1 and units 1..64");
  require(o.rate > 0 && o.code_rate > 0, "rates must be positive");
  require(o.code_spread >= 0 && o.code_penalty >= 0 && o.slope_weight >= 0,
          "code spread, code penalty and slope weight must not be negative");
  require(o.test_count >= 1, "test count must be at least 1");
  require(o.threads >= 1 && o.threads <= 256, "threads must be 1..256");
  SamplingOptions const& s = o.samples;
  require(s.count >= 1, "samples must be at least 1");
  require(s.share_surface >= 0 && s.share_interior >= 0 && s.share_surface + s.share_interior <= 1,
          "sampling shares must not be negative nor exceed 1 together");
  require(s.band > 0, "sampling band must be positive");
  return result;
}

}  // namespace scree

// options.cpp: validity of training options, and the recipes.
// SPDX-License-Identifier: Apache-2.0
#include "training/options.h"

#include <algorithm>
#include <cmath>

namespace scree {

std::vector<std::string> problems(TrainOptions const& o) {
  std::vector<std::string> result;
  auto const require = [&](bool ok, char const* text) {
    if (!ok) result.emplace_back(text);
  };
  require(std::isfinite(o.parameter) && o.parameter > 0, "activation parameter must be positive");
  require(o.layers >= 1 && o.layers <= 16, "layers must be 1..16");
  require(o.width >= 8 && o.width <= 64, "width must be 8..64: wider networks are not evaluated fast");
  require(o.code_size >= 0 && o.code_size <= 64, "code size must be 0..64");
  require(o.steps >= 1, "steps must be at least 1");
  require(o.rows >= 1 && o.units >= 1 && o.units <= 64, "rows must be at least 1 and units 1..64");
  require(o.rate > 0 && o.code_rate > 0, "rates must be positive");
  require(o.second_moment > 0 && o.second_moment < 1, "the second moment's decay must lie between 0 and 1");
  require(o.code_spread >= 0 && o.code_penalty >= 0 && o.slope_weight >= 0 && o.eikonal_weight >= 0,
          "code spread, code penalty, slope weight and eikonal weight must not be negative");
  require(o.code_limit > 0, "code limit must be positive");
  require(o.finish.iterations >= 0 && o.finish.history >= 1 && o.finish.samples >= 1,
          "finish: iterations must not be negative, history and samples at least 1");
  require(o.test_count >= 1, "test count must be at least 1");
  require(o.threads >= 1 && o.threads <= 256, "threads must be 1..256");
  require(o.device == "cpu" || o.device == "cuda" || o.device == "auto", "device must be cpu, cuda or auto");
  SamplingOptions const& s = o.samples;
  require(s.count >= 1, "samples must be at least 1");
  require(s.share_surface >= 0 && s.share_curved >= 0 && s.share_interior >= 0 &&
              s.share_surface + s.share_curved + s.share_interior <= 1,
          "sampling shares must not be negative nor exceed 1 together");
  require(s.band > 0, "sampling band must be positive");
  return result;
}

TrainOptions default_single_options() { return {}; }

TrainOptions default_coded_options() {
  TrainOptions o;
  o.code_size = 10;
  o.code_spread = 0.02;  // codes that begin far apart are hashed by the sine: nothing lies between two grains
  o.layers = 6;
  o.width = 64;
  o.steps = 24000;
  o.rows = 1000;
  o.rate = 1.2e-2;
  return o;
}

int steps_of_epochs(TrainOptions const& options, int shapes, int epochs) {
  int const rows = std::max(1, options.rows / shapes);
  return epochs * std::max(1, options.samples.count / rows / options.units);
}

TrainOptions paper_single_options() {
  TrainOptions o;
  o.activation = Activation::leaky_relu;
  o.parameter = 0.01;
  o.rows = 128;
  o.units = 1;
  o.schedule = Schedule::constant;
  o.rate = 1e-3;
  o.second_moment = 0.999;
  o.slope_weight = 0;
  o.samples.count = 10000;
  o.samples.region = SampleRegion::paper_shell;
  o.samples.share_surface = o.samples.share_curved = o.samples.share_interior = 0;
  o.steps = steps_of_epochs(o, 1, 100);
  return o;
}

TrainOptions paper_coded_options(int shapes) {
  TrainOptions o = paper_single_options();
  o.layers = 6;
  o.code_size = 10;
  o.code_rule = CodeRule::gradient;
  o.code_start = CodeStart::uniform;
  o.code_spread = 1;
  o.code_rate = 1e-3;
  o.code_penalty = 0;
  o.steps = steps_of_epochs(o, shapes, 100);
  return o;
}

}  // namespace scree

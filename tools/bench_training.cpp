// bench_training.cpp: samples per second of a training and the time it takes to stated errors, for one body.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>

#include "kernels/base/build_info.h"
#include "shapes/analytic_shapes.h"
#include "tools/guarded.h"
#include "tools/measured_on.h"
#include "training/train.h"

namespace scree::bench {
namespace {

struct Options {
  std::string body = "superellipsoid:1:0.8:0.6:0.6", output;
  std::vector<double> errors{3e-3, 1e-3, 5e-4, 3e-4};
  TrainOptions train = default_single_options();
};

int run(Options const& o) {
  TrainedNet const trained = train({make_body(o.body, builtin_shape(o.body))}, o.train);
  double const samples = static_cast<double>(o.train.rows) * o.train.units * trained.history.back().step;
  double best = trained.history[0].mean_mae;
  for (EpochRecord const& r : trained.history) best = std::min(best, r.mean_mae);
  std::string text = fmt::format(
      "{{\n  \"benchmark\": \"bench_training\", \"commit\": \"{}\", \"compiler\": \"{}\", \"date\": \"{}\",\n"
      "  \"machine\": \"{}\", \"libraries\": \"{}\", \"body\": \"{}\",\n"
      "  \"layers\": {}, \"width\": {}, \"steps\": {}, \"samples\": {}, \"threads\": {},\n"
      "  \"seconds\": {:.2f}, \"samples_per_second\": {:.4g}, \"mae\": {:.3e},\n  \"seconds_to_mae\": {{",
      build_info().commit, build_info().compiler, utc_date(), cpu_name(), trained.libraries, o.body, o.train.layers,
      o.train.width, o.train.steps, samples, o.train.threads, trained.seconds, samples / trained.seconds, best);
  char const* comma = "";
  for (double const error : o.errors) {
    double seconds = -1;  // never
    for (auto r = trained.history.rbegin(); r != trained.history.rend(); ++r)
      if (r->mean_mae <= error) seconds = r->seconds;
    text += fmt::format("{}\"{:g}\": {}", comma, error, seconds < 0 ? "null" : fmt::format("{:.2f}", seconds));
    comma = ", ";
  }
  text += "}\n}\n";
  fmt::print("{}", text);
  if (!o.output.empty()) fmt::output_file(o.output).print("{}", text);
  return 0;
}

}  // namespace
}  // namespace scree::bench

int main(int argc, char** argv) {
  scree::bench::Options o;
  CLI::App app("Samples per second of the training of one network, and seconds to stated mean errors of phi (JSON)");
  app.add_option("--body", o.body, "formula, as for scree-train fit")->capture_default_str();
  app.add_option("--errors", o.errors, "mean errors of phi on the test points [d]; null: never reached")
      ->delimiter(',');
  app.add_option("--layers", o.train.layers, "hidden layers")->check(CLI::Range(1, 16))->capture_default_str();
  app.add_option("--width", o.train.width, "neurons a hidden layer")->check(CLI::Range(8, 64))->capture_default_str();
  app.add_option("--steps", o.train.steps, "optimiser steps")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--samples", o.train.samples, "training samples")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--threads", o.train.threads, "threads")->check(CLI::Range(1, 256));
  app.add_option("-o,--output", o.output, "JSON file");
  CLI11_PARSE(app, argc, argv);
  return scree::guarded("bench_training", [&] { return scree::bench::run(o); });
}

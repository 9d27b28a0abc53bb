// shape_sample.cpp: `scree-shape sample`: grains that never existed, drawn from the codes of a category.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "shapes/generate.h"
#include "shapes/model_file.h"
#include "tools/guarded.h"
#include "tools/shape_commands.h"
#include "tools/shape_input.h"
#include "tools/shape_strip.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct SampleArguments {
  fs::path library, output, stl;
  SampleOptions options;
  std::vector<double> sphericity, convexity, elongation, flatness, roundness, volume, gradient;
  bool force = false;
};

void set_interval(char const* name, std::vector<double> const& given, Interval& interval) {
  if (given.empty()) return;
  if (!(given[0] <= given[1]))
    throw std::invalid_argument(
        fmt::format("--{} {:g},{:g}: the first number must not exceed the second", name, given[0], given[1]));
  interval = {given[0], given[1]};
}

// Smallest, mean and largest value of the accepted shapes.
template <class Value>
void print_range(char const* name, std::vector<Candidate> const& made, Value const& value) {
  double low = value(made[0]), high = low, sum = 0;
  for (Candidate const& c : made) {
    low = std::min(low, value(c)), high = std::max(high, value(c));
    sum += value(c);
  }
  fmt::print("  {:<22}{:9.3f}{:9.3f}{:9.3f}\n", name, low, sum / static_cast<double>(made.size()), high);
}

int sample(SampleArguments& a) {
  check_output(a.output, a.force);
  ShapeLimits& limits = a.options.limits;
  set_interval("sphericity", a.sphericity, limits.sphericity);
  set_interval("convexity", a.convexity, limits.convexity);
  set_interval("elongation", a.elongation, limits.elongation);
  set_interval("flatness", a.flatness, limits.flatness);
  set_interval("roundness", a.roundness, limits.roundness);
  set_interval("volume", a.volume, limits.volume);
  set_interval("gradient", a.gradient, limits.gradient);
  Library const library = read_input([&] { return read_model(a.library); });
  Generation const made = sample_shapes(library, a.options);
  fmt::print("{}: {} codes of {} span {} of {} dimensions{}\n", a.library.string(), made.gaussian.samples,
             a.options.category, made.gaussian.axis.size(), made.gaussian.mean.size(),
             a.options.shrinkage > 0 ? fmt::format(", shrinkage {:g}", a.options.shrinkage) : "");
  fmt::print("{} tries: {}; acceptance {:.1f} %\n", made.tries, tally(made.count),
             100.0 * static_cast<double>(made.accepted.size()) / made.tries);
  fmt::print("  {:<22}{:>9}{:>9}{:>9}\n", "accepted", "least", "mean", "most");
  print_range("sphericity", made.accepted, [](Candidate const& c) { return c.form.sphericity; });
  print_range("convexity", made.accepted, [](Candidate const& c) { return c.form.convexity; });
  print_range("elongation b/a", made.accepted, [](Candidate const& c) { return c.form.elongation; });
  print_range("flatness c/b", made.accepted, [](Candidate const& c) { return c.form.flatness; });
  print_range("roundness", made.accepted, [](Candidate const& c) { return c.roundness; });
  print_range("volume before scaling", made.accepted, [](Candidate const& c) { return c.volume_ratio; });
  print_range("|grad phi| p1", made.accepted, [](Candidate const& c) { return c.shape.certificate.gradient_p1; });
  print_range("|grad phi| p99", made.accepted, [](Candidate const& c) { return c.shape.certificate.gradient_p99; });
  print_range("falling share", made.accepted, [](Candidate const& c) { return c.falling; });
  write_strip(library, made.accepted, a.output, a.stl, a.force);
  return exit_ok;
}

}  // namespace

void add_sample(CLI::App& app, std::function<int()>& chosen) {
  auto const a = std::make_shared<SampleArguments>();
  SampleOptions& o = a->options;
  o.count = 100;
  o.threads = 2;
  CLI::App* const c = app.add_subcommand("sample", "Draw new shapes from the latent codes of a category");
  c->add_option("library", a->library, "Model file with a shared decoder (.h5)")->required();
  c->add_option("--category", o.category, "What stands before the last slash of the shapes' names")->required();
  c->add_option("-o,--output", a->output, "Model file to write (.h5)")->required();
  c->add_option("--count", o.count, "Shapes that have to pass the gate")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  c->add_option("--truncate", o.truncate, "Cut the Gaussian at so many standard deviations")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  c->add_option("--shrinkage", o.shrinkage, "Share of an isotropic part in the covariance, in [0, 1)")
      ->check(CLI::Range(0.0, 0.999))
      ->capture_default_str();
  c->add_option("--seed", o.seed, "Seed of the draws")->capture_default_str();
  auto const interval = [&](std::string const& name, std::vector<double>& value, std::string const& text) {
    c->add_option("--" + name, value, text + ": lowest,highest")->delimiter(',')->expected(2);
  };
  interval("sphericity", a->sphericity, "Wadell's sphericity");
  interval("convexity", a->convexity, "Volume over that of the convex hull");
  interval("elongation", a->elongation, "EI = b / a");
  interval("flatness", a->flatness, "FI = c / b");
  interval("roundness", a->roundness, "Corner radii over the inscribed radius");
  interval("volume", a->volume, "Volume before scaling over that of the known shapes (default 0.7,1.43)");
  interval("gradient", a->gradient, "1st and 99th percentile of |grad phi| (default 0.5,2)");
  c->add_option("--tries", o.max_tries, "Give up after so many draws (default: 50 times count, at least 200)")
      ->check(CLI::PositiveNumber);
  c->add_option("--threads", o.threads, "CPU threads; do not change the result")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  c->add_option("--stl", a->stl, "Also write a mesh a shape into this folder");
  c->add_flag("--force", a->force, "Replace existing output files");
  c->callback([a, &chosen] { chosen = [a] { return sample(*a); }; });
}

}  // namespace scree

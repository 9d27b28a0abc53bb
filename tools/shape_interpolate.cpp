// shape_interpolate.cpp: `scree-shape interpolate`: the shapes on the line between two codes.
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

struct InterpolateArguments {
  fs::path library, output, stl;
  std::string from, to;
  int steps = 7;
  int threads = 2;
  bool force = false;
};

Shape const& shape_called(Library const& library, fs::path const& file, std::string const& name) {
  auto const at =
      std::find_if(library.shape.begin(), library.shape.end(), [&](Shape const& s) { return s.name == name; });
  if (at == library.shape.end())
    throw std::invalid_argument(file.string() + " has no shape '" + name + "'; scree info lists what it has");
  return *at;
}

int interpolate(InterpolateArguments const& a) {
  check_output(a.output, a.force);
  Library const library = read_input([&] { return read_model(a.library); });
  std::vector<double> t;
  for (int i = 0; i < a.steps; ++i) t.push_back(static_cast<double>(i) / (a.steps - 1));
  std::vector<Candidate> const made =
      interpolate_shapes(library, shape_called(library, a.library, a.from), shape_called(library, a.library, a.to), t,
                         ShapeLimits{}, a.threads);
  fmt::print("{:>7}{:>7}{:>7}{:>9}{:>9}{:>9}{:>12}{:>11}{:>10}{:>10}{:>9}  {}\n", "t", "parts", "euler", "|g|p1",
             "|g|p99", "falling", "sphericity", "convexity", "EI", "FI", "round", "verdict");
  for (int i = 0; i < a.steps; ++i) {
    Candidate const& c = made[i];
    Certificate const& m = c.shape.certificate;
    fmt::print("{:7.3f}{:7d}{:7d}{:9.3f}{:9.3f}{:9.4f}{:12.3f}{:11.3f}{:10.3f}{:10.3f}{:9.3f}  {}\n", t[i],
               m.components, c.euler, m.gradient_p1, m.gradient_p99, c.falling, c.form.sphericity, c.form.convexity,
               c.form.elongation, c.form.flatness, c.roundness, to_string(c.verdict));
  }
  write_strip(library, made, a.output, a.stl, a.force);
  return exit_ok;
}

}  // namespace

void add_interpolate(CLI::App& app, std::function<int()>& chosen) {
  auto const a = std::make_shared<InterpolateArguments>();
  CLI::App* const c = app.add_subcommand("interpolate", "Shapes on the line between two latent codes");
  c->add_option("library", a->library, "Model file with a shared decoder (.h5)")->required();
  c->add_option("from", a->from, "Shape at t = 0")->required();
  c->add_option("to", a->to, "Shape at t = 1")->required();
  c->add_option("-o,--output", a->output, "Model file to write (.h5); steps that fail the gate are left out")
      ->required();
  c->add_option("--steps", a->steps, "Shapes, both ends included")->check(CLI::Range(2, 10000))->capture_default_str();
  c->add_option("--threads", a->threads, "CPU threads; do not change the result")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  c->add_option("--stl", a->stl, "Also write a mesh a shape into this folder");
  c->add_flag("--force", a->force, "Replace existing output files");
  c->callback([a, &chosen] { chosen = [a] { return interpolate(*a); }; });
}

}  // namespace scree

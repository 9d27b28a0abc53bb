// shape_points.cpp: `scree-shape points`: points of a body's surface, with normals.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include "shapes/text_lines.h"
#include "tools/guarded.h"
#include "tools/shape_commands.h"
#include "tools/shape_input.h"
#include "tools/shape_source.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct PointsArguments {
  fs::path source, output;
  std::string shape, spread = "area";
  int count = 10000, threads = 2;
  bool force = false;
};

int points(PointsArguments const& a) {
  std::string const extension = lower_extension(a.output);
  if (extension != ".ply" && extension != ".xyz")
    throw std::invalid_argument(a.output.string() + ": write a .ply or .xyz file");
  check_output(a.output, a.force);
  ShapeSource const source = open_source(a.source, a.shape, a.threads);
  if (source.is_cloud()) throw std::invalid_argument(source.title + " holds points already; give a model or a mesh");
  fmt::print("{}: even over {}\n", source.title, a.spread);
  PointCloud cloud;
  try {
    cloud = surface_points(source, a.count, a.spread == "area" ? SampleSpread::area : SampleSpread::directions);
  } catch (std::invalid_argument const& error) {
    throw std::invalid_argument(source.title + ": " + error.what() + "; use --spread area");
  }
  move_by(cloud, source.centre);
  write_points(a.output, cloud);
  fmt::print("{}: {} points with normals\n", a.output.string(), cloud.position.size());
  return exit_ok;
}

}  // namespace

void add_points(CLI::App& app, std::function<int()>& chosen) {
  auto const a = std::make_shared<PointsArguments>();
  CLI::App* const c = app.add_subcommand("points", "Sample the surface of a model's shape or a mesh");
  c->add_option("source", a->source, "Model (.h5) or closed mesh (.stl, .obj, .ply)")->required();
  c->add_option("-o,--output", a->output, "Points to write (.ply, .xyz)")->required();
  c->add_option("--shape", a->shape, "Shape of the model");
  c->add_option("--count", a->count, "Points")->check(CLI::Range(1, 2000000))->capture_default_str();
  c->add_option("--spread", a->spread, "Even over the area, or over directions from the centre (star-shaped bodies)")
      ->check(CLI::IsMember({"area", "directions"}))
      ->capture_default_str();
  c->add_option("--threads", a->threads, "CPU threads")->check(CLI::Range(1, 256))->capture_default_str();
  c->add_flag("--force", a->force, "Replace an existing output file");
  c->callback([a, &chosen] { chosen = [a] { return points(*a); }; });
}

}  // namespace scree

// shape_inspect.cpp: `scree-shape inspect`: print certificates, measure gradients, volume, parts and nodes from phi.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "shapes/model_file.h"
#include "shapes/phi_batch.h"
#include "shapes/surface_nodes.h"
#include "shapes/zero_set.h"
#include "tools/guarded.h"
#include "tools/shape_commands.h"
#include "tools/shape_input.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct InspectArguments {
  fs::path file;
  std::string shape;  // only this one; empty: all
  int nodes = 4000;
  int threads = 2;
};

// Measured now, from phi alone.
struct Measured {
  double gradient_p1 = 0, gradient_p99 = 0;  // of |grad phi| at points within 0.05 d of the surface
  double volume_error = 0;                   // of the normalised zero set against pi/6, relative
  int components = 0, euler_characteristic = 0;
  int nodes = 0;
  double gap = 0;          // [d]
  double closure = 0;      // |sum A n| / sum A
  double volume_gate = 0;  // |sum A x.n / (3 V) - 1|
};

Measured measure(Library const& library, Shape const& shape, InspectArguments const& a) {
  PhiBatch const phi = fast_phi(library, shape, a.threads);
  ZeroSetOptions options;
  options.radius = 1.1 * shape.bounding_radius;
  ZeroSet const set = find_zero_set(phi, options);
  Measured m;
  m.components = set.components;
  m.euler_characteristic = set.euler_characteristic;
  m.volume_error = zero_set_mass(phi, set).volume * 6 / std::numbers::pi - 1;

  std::vector<Vec3> point;
  for (std::size_t i = 0; i < set.mesh.vertex.size(); ++i)  // both sides by turns, at golden-ratio depths
    point.push_back(set.mesh.vertex[i] +
                    set.normal[i] * (0.1 * (std::fmod(static_cast<double>(i) * std::numbers::phi, 1.0) - 0.5)));
  std::vector<double> value(point.size());
  std::vector<Vec3> gradient(point.size());
  phi(point, value, gradient);
  std::vector<double> slope;
  for (Vec3 const& g : gradient) slope.push_back(norm(g));
  std::sort(slope.begin(), slope.end());
  m.gradient_p1 = slope[slope.size() / 100];
  m.gradient_p99 = slope[slope.size() - 1 - slope.size() / 100];

  SurfaceNodes const nodes = make_surface_nodes(library, shape, a.nodes);
  m.nodes = nodes.n_surface;
  m.gap = nodes.largest_gap;
  Vec3 sum;
  double area = 0, moment = 0;
  for (int i = 0; i < nodes.n_surface; ++i) {
    sum += nodes.normal[i] * nodes.area[i];
    area += nodes.area[i];
    moment += nodes.area[i] * dot(nodes.position[i], nodes.normal[i]);
  }
  m.closure = norm(sum) / area;
  m.volume_gate = std::abs(moment / (3 * shape.volume) - 1);
  return m;
}

std::string figure(double value, char const* format = "{:.1e}") {
  return value < 0 ? std::string("-") : fmt::format(fmt::runtime(format), value);
}

int inspect(InspectArguments const& a) {
  Library const library = read_input([&] { return read_model(a.file); });
  std::vector<Shape const*> chosen;
  for (Shape const& shape : library.shape)
    if (a.shape.empty() || shape.name == a.shape) chosen.push_back(&shape);
  if (chosen.empty()) throw std::invalid_argument(a.file.string() + " has no shape '" + a.shape + "'");
  for (std::size_t k = 0; k < library.net.size(); ++k) {
    std::string width;
    for (int w : library.net[k].width) width += (width.empty() ? "" : "-") + std::to_string(w);
    fmt::print("network {}: {} {} ({:g})\n", k, width, to_string(library.net[k].activation), library.net[k].parameter);
  }
  fmt::print(
      "\ncertificate, units of d (-: not "
      "measured)\n{:<14}{:>9}{:>9}{:>9}{:>9}{:>7}{:>7}{:>8}{:>8}{:>9}{:>9}{:>9}{:>6}\n",
      "shape", "MAE", "p99", "max", "band", "n50", "n95", "|g|p1", "|g|p99", "volume", "inertia", "hausd.", "seed");
  for (Shape const* s : chosen) {
    Certificate const& c = s->certificate;
    fmt::print("{:<14}{:>9}{:>9}{:>9}{:>9}{:>7}{:>7}{:>8}{:>8}{:>9}{:>9}{:>9}{:>6}\n", s->name, figure(c.mae),
               figure(c.p99), figure(c.max), figure(c.band_mae), figure(c.normal_p50, "{:.2f}"),
               figure(c.normal_p95, "{:.2f}"), figure(c.gradient_p1, "{:.3f}"), figure(c.gradient_p99, "{:.3f}"),
               figure(c.volume_error), figure(c.inertia_error), figure(c.hausdorff),
               c.seed < 0 ? "-" : std::to_string(c.seed));
  }
  fmt::print(
      "\nmeasured now from phi (gates: parts 1, euler 2, volume and nodes 1e-3, gap 3e-3)\n"
      "{:<14}{:>8}{:>8}{:>7}{:>10}{:>6}{:>6}{:>8}{:>9}{:>10}{:>10}\n",
      "shape", "|g|p1", "|g|p99", "L", "volume", "parts", "euler", "nodes", "gap", "sum A n", "sum A x.n");
  for (Shape const* s : chosen) {
    Measured const m = measure(library, *s, a);
    fmt::print("{:<14}{:8.3f}{:8.3f}{:7.2f}{:10.1e}{:6d}{:6d}{:8d}{:9.1e}{:10.1e}{:10.1e}\n", s->name, m.gradient_p1,
               m.gradient_p99, s->lipschitz, m.volume_error, m.components, m.euler_characteristic, m.nodes, m.gap,
               m.closure, m.volume_gate);
    std::fflush(stdout);
  }
  fmt::print("\nmade with {}\n", chosen.front()->certificate.made_with);
  return exit_ok;
}

}  // namespace

void add_inspect(CLI::App& app, std::function<int()>& chosen) {
  auto const a = std::make_shared<InspectArguments>();
  CLI::App* const c =
      app.add_subcommand("inspect", "Print certificates and measure gradients, volume, parts and nodes");
  c->add_option("file", a->file, "Model file (.h5)")->required();
  c->add_option("--shape", a->shape, "Only this shape");
  c->add_option("--nodes", a->nodes, "Surface nodes to measure")->check(CLI::Range(4, 1000000))->capture_default_str();
  c->add_option("--threads", a->threads, "CPU threads")->check(CLI::Range(1, 256))->capture_default_str();
  c->callback([a, &chosen] { chosen = [a] { return inspect(*a); }; });
}

}  // namespace scree

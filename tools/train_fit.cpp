// train_fit.cpp: scree-train fit and coded: one network for one mesh, or one decoder for the procedural grains.
// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "shapes/analytic_shapes.h"
#include "shapes/file_hash.h"
#include "shapes/mesh/procedural_grains.h"
#include "tools/shape_input.h"
#include "tools/train_commands.h"

namespace scree {
namespace {

int fit(TrainArguments const& a) {
  check_output(a.output, a.force);
  if (is_builtin_shape(a.mesh.string())) {
    std::string const formula = a.mesh.string();
    return train_and_write(a, {make_body(a.name.empty() ? formula : a.name, builtin_shape(formula))});
  }
  std::string const name = a.name.empty() ? a.mesh.stem().string() : a.name;
  TriangleMesh mesh = read_closed_mesh(a.mesh, a.repair);
  std::string const source = "mesh " + a.mesh.filename().string();
  return train_and_write(a, {make_body(name, std::move(mesh), source, file_hash(a.mesh))});
}

int coded(TrainArguments const& a) {
  check_output(a.output, a.force);
  std::vector<Body> bodies;
  for (ProceduralGrain& grain : procedural_grains(a.set_seed))
    bodies.push_back(make_body(grain.name, std::move(grain.mesh), grain.formula));
  return train_and_write(a, bodies);
}

}  // namespace

void add_fit_command(CLI::App& app, std::function<int()>& chosen) {
  auto const a = std::make_shared<TrainArguments>();
  a->train = default_single_options();
  CLI::App* const c = app.add_subcommand("fit", "One network for one closed mesh or formula (SingleNetSDF)");
  c->add_option("mesh", a->mesh,
                "Closed mesh (.stl, .obj, .ply), any unit (--repair mends simple defects), or a formula with exact "
                "distances: ellipsoid:1:0.8:0.6, superellipsoid:1:0.8:0.6:0.5, box:1:1:2")
      ->required();
  c->add_option("--name", a->name, "Name of the shape (default: the file's)");
  c->add_flag("--repair", a->repair, "First repair a mesh that bounds no solid, as scree-shape import does");
  add_training_options(*c, *a);
  c->callback([a, &chosen] { chosen = [a] { return fit(*a); }; });
}

void add_coded_command(CLI::App& app, std::function<int()>& chosen) {
  auto const a = std::make_shared<TrainArguments>();
  a->train = default_coded_options();
  CLI::App* const c = app.add_subcommand("coded", "One decoder and a latent code a shape (CodedNetSDF)");
  c->add_option("--set", a->set, "grains20: five each of ballast, cobble, ellipsoid, sand")
      ->check(CLI::IsMember({"grains20"}))
      ->capture_default_str();
  c->add_option("--set-seed", a->set_seed, "Seed of the procedural grains")->capture_default_str();
  TrainOptions& t = a->train;
  c->add_option("--code-size", t.code_size, "Latent numbers a shape")->check(CLI::Range(1, 64))->capture_default_str();
  c->add_option("--code-rate", t.code_rate, "First learning rate of the codes")->capture_default_str();
  c->add_option("--code-spread", t.code_spread,
                "Standard deviation of the first codes; far apart, a sine network puts nothing between two grains")
      ->capture_default_str();
  c->add_option("--code-penalty", t.code_penalty, "Weight of the mean squared code in the loss")->capture_default_str();
  add_training_options(*c, *a);
  c->callback([a, &chosen] { chosen = [a] { return coded(*a); }; });
}

}  // namespace scree

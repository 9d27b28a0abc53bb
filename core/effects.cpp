// effects.cpp: see effects.h. A line an effect, a line a stage.
// SPDX-License-Identifier: Apache-2.0
#include "core/effects.h"

#include <algorithm>

#include "core/wall_bodies.h"

namespace scree {

Effects effects_of(Case const& c, Scene const& scene) {
  auto const grain_end = scene.shape.begin() + scene.templates();
  auto const any_shape = [&](auto test) { return std::any_of(scene.shape.begin(), grain_end, test); };
  auto const any_wall = [&](auto test) { return std::any_of(grain_end, scene.shape.end(), test); };
  auto const any_contact = [&](auto test) { return std::any_of(scene.contact.begin(), scene.contact.end(), test); };
  bool const spheres = any_shape([](ShapeRecord const& s) { return s.closed_form_sphere; });
  bool const others = any_shape([](ShapeRecord const& s) { return !s.closed_form_sphere; });
  auto const any_sdf = [&](SdfKind kind) { return any_shape([&](ShapeRecord const& s) { return s.sdf == kind; }); };
  Effects e;
  e.sphere_contacts = spheres;
  e.node_contacts =
      others || (spheres && any_wall([](ShapeRecord const& w) { return !meets_spheres_in_closed_form(w); }));
  e.networks = any_sdf(SdfKind::net);
  e.harmonics = any_sdf(SdfKind::harmonics);
  e.grids = any_sdf(SdfKind::grid);
  e.meshes = any_sdf(SdfKind::mesh) || any_wall([](ShapeRecord const& w) { return w.sdf == SdfKind::mesh; });
  bool const formulas = any_sdf(SdfKind::analytic) || !scene.plane.empty() ||
                        any_wall([](ShapeRecord const& w) { return w.sdf == SdfKind::analytic; });
  e.analytic_nodes = e.node_contacts && formulas;
  e.friction = any_contact([](ContactParameters const& p) { return p.friction > 0; });
  e.rolling = scene.rolling;
  e.cohesion = scene.cohesion_reach > 0;
  e.damping = any_contact([](ContactParameters const& p) { return p.damping_nodes > 0; });
  e.gravity = c.gravity && norm2(*c.gravity) > 0;
  e.force = std::any_of(c.force.begin(), c.force.end(), [](ForceCase const& f) {
    auto const& factor = f.table.value;
    bool const scaled =
        f.table.empty() || std::any_of(factor.begin(), factor.end(), [](double value) { return value != 0; });
    return scaled && (norm2(f.force) > 0 || norm2(f.torque) > 0);
  });
  e.drag = c.drag && c.drag->density * c.drag->coefficient > 0;
  e.global_damping = c.damping && c.damping->rate > 0;
  e.insertion = std::any_of(c.grains.begin(), c.grains.end(),
                            [](GrainsCase const& g) { return g.insert.kind == InsertCase::Kind::rate && g.count > 0; });
  e.deletion = !c.deletion.empty();
  e.wall_motion =
      std::any_of(scene.wall.begin(), scene.wall.end(), [](WallBody const& w) { return w.motion.has_value(); });
  e.measures = !c.measure.empty();
  e.settle = c.time.settle.has_value();
  e.settle_damping = e.settle && c.time.settle->damping > 0;
  return e;
}

std::vector<std::string> stages_of(Effects const& e) {
  std::vector<std::string> stages;
  auto const add = [&](bool wanted, char const* name) {
    if (wanted) stages.push_back(name);
  };
  add(e.wall_motion, "wall_motion");
  add(e.insertion, "insertion");
  add(true, "bounds");
  add(true, "broad_phase");
  add(e.node_contacts, "node_gather");
  add(e.networks, "sdf_net");
  add(e.harmonics, "sdf_harmonics");
  add(e.grids, "sdf_grid");
  add(e.meshes, "sdf_mesh");
  add(e.analytic_nodes, "sdf_analytic");
  add(e.sphere_contacts, "sphere_contacts");
  add(e.node_contacts, "contact_reduce");
  add(e.gravity, "gravity");
  add(e.force, "force");
  add(true, "integrate");
  add(e.drag, "drag");
  add(e.global_damping, "damping");
  add(e.settle_damping, "global_damping");
  add(e.deletion, "delete");
  add(true, "watch");
  add(e.measures, "measure");
  return stages;
}

std::vector<std::string> names_of(Effects const& e) {
  std::vector<std::string> names;
  if (e.gravity) names.push_back("gravity");
  if (e.force) names.push_back("force");
  if (e.drag) names.push_back("drag");
  if (e.global_damping) names.push_back("global damping");
  if (e.insertion) names.push_back("insertion");
  if (e.deletion) names.push_back("deletion");
  if (e.friction) names.push_back("friction");
  if (e.rolling) names.push_back("rolling resistance");
  if (e.cohesion) names.push_back("cohesion");
  if (e.damping) names.push_back("damping");
  if (e.wall_motion) names.push_back("wall motion");
  if (e.settle) names.push_back("settle");
  return names;
}

std::vector<std::string> ledger_columns_of(Effects const& e) {
  std::vector<std::string> columns;
  if (e.rolling) columns.insert(columns.end(), {"elastic_rolling", "rolling"});
  if (e.insertion) columns.push_back("inserted");
  if (e.deletion) columns.push_back("deleted");
  if (e.force) columns.push_back("applied");
  if (e.drag) columns.push_back("drag");
  if (e.global_damping || e.settle_damping) columns.push_back("global_damping");
  return columns;
}

}  // namespace scree

// simulation_report.cpp: what a Simulation tells: plan, frames, header of the results. See simulation.h.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/certificate_gate.h"
#include "core/grain_entries.h"
#include "core/insertion.h"
#include "core/simulation_impl.h"
#include "core/unique_grains.h"
#include "core/wall_record.h"
#include "core/wall_surface.h"

namespace scree {
namespace {

template <class T>
std::int64_t bytes(std::vector<T> const& v) {
  return static_cast<std::int64_t>(v.size() * sizeof(T));
}

std::string normal_law_in_words(PressureLaw const& law) {
  switch (law.kind) {
    case ContactLaw::winkler:
      return fmt::format("winkler kappa {:.4g} N/m3", law.modulus);
    case ContactLaw::linear:
      return fmt::format("linear pressure {:.4g} Pa from overlap {:.3g} m on", law.modulus, law.onset);
    case ContactLaw::hertz:
      return fmt::format("hertz E* {:.4g} Pa, on nodes linear below overlap {:.3g} m", law.modulus * SphereLaw::pi,
                         law.onset);
  }
  throw std::invalid_argument("this ContactLaw does not exist");
}

std::string law_of(Simulation::Impl const& s, int a, int b) {
  ContactParameters const& p = s.scene.contact[a * s.scene.material.size() + b];
  std::string text = fmt::format("{} - {}: {}, k_t/k_n {:.3g}", s.scene.material[a], s.scene.material[b],
                                 normal_law_in_words(p.normal), p.tangential);
  if (p.friction > 0) text += fmt::format(", friction {:.3g}", p.friction);
  if (p.cohesion.traction > 0)
    text += fmt::format(", cohesion {:.4g} Pa within {:.3g} m", p.cohesion.traction, p.cohesion.range);
  if (p.rolling > 0)
    text += fmt::format(", rolling friction {:.3g}, stiffness ratio {:.3g}, damping {:.3g}", p.rolling, p.rolling_ratio,
                        p.rolling_damping);
  if (p.damping_nodes > 0) text += fmt::format(", damping ratio {:.3g}", p.damping_nodes);
  return text;
}

std::vector<Plan::Array> arrays_of(Simulation::Impl const& s) {
  std::vector<Plan::Array> arrays = {{"state", bytes(s.state.position) + bytes(s.state.velocity) +
                                                   bytes(s.state.orientation) + bytes(s.state.angular_momentum)},
                                     {"boxes", bytes(s.work.box) + bytes(s.work.broad_phase.node)},
                                     {"pairs", bytes(s.work.pair) + bytes(s.work.result) + bytes(s.work.in_contact)}};
  auto const add = [&](bool wanted, char const* name, std::int64_t size) {
    if (wanted) arrays.push_back({name, size});
  };
  add(s.effects.node_contacts, "surface nodes",
      bytes(s.scene.node_position) + bytes(s.scene.node_area) + bytes(s.scene.block_centre) +
          bytes(s.scene.block_radius) + bytes(s.scene.block_first));
  CompactBytes const compact = compact_bytes(s.scene);
  add(compact.grains > 0, "compact nodes", static_cast<std::int64_t>(compact.nodes + compact.culling));
  add(s.effects.node_contacts, "shape records", bytes(s.scene.shape) + bytes(s.scene.compact.record));
  std::int64_t weights = 0;
  for (PackedMlp const& net : s.scene.networks.net)
    for (auto const& w : net.net().weight) weights += bytes(w);
  for (auto const& rows : s.scene.networks.bias_rows) weights += bytes(rows);
  add(s.effects.networks, "networks", weights);
  add(s.effects.harmonics, "radii", bytes(s.scene.coefficient));
  add(s.effects.grids, "grids", bytes(s.scene.grid_value));
  add(s.effects.meshes, "meshes", bytes(s.scene.mesh_node) + bytes(s.scene.mesh_corner) + bytes(s.scene.mesh_normal));
  add(s.effects.node_contacts, "node lists", bytes(s.work.gather.lists.node) + bytes(s.work.gather.lists.side));
  add(s.effects.friction, "contact history",
      bytes(s.state.node_history.xi) + bytes(s.state.node_history.node) + bytes(s.state.sphere_history.xi));
  add(s.effects.force, "applied forces", bytes(s.work.applied) + bytes(s.state.work_applied));
  add(!s.scene.world_of.empty(), "worlds", bytes(s.scene.world_of));
  add(!s.state.activity.empty(), "activity", bytes(s.state.activity) + bytes(s.state.insertion));
  add(s.effects.drag, "drag", bytes(s.state.removed_by_drag));
  add(s.effects.rolling, "rolling history",
      bytes(s.state.rolling_history.angle) + bytes(s.state.rolling_history.stiffness) + bytes(s.work.rolling));
  return arrays;
}

// Seeds under which single runs repeat the replicas; of many only the first few.
std::string replica_note(Case const& c) {
  int constexpr named = 16;
  std::string seeds;
  for (int r = 0; r < std::min(named, c.replicas); ++r)
    seeds += fmt::format("{}{}", r > 0 ? ", " : "", replica_seed(c.seed, r));
  return fmt::format("{} replicas, each by itself the case with seed {}{}", c.replicas, seeds,
                     c.replicas > named ? ", ..." : "");
}

std::string precision_note(Precision precision, bool on_gpu) {
  if (on_gpu) return fmt::format("networks on the GPU in {}", to_string(precision));
  if (precision == Precision::fp32) return "networks on the CPU in fp32";
  return fmt::format(
      "device.precision = \"{}\" is for networks on a GPU; without one they are evaluated on the CPU, in fp32",
      to_string(precision));
}

}  // namespace

QueryCounts Simulation::Impl::counts() const {
  ActiveNodes const& active = work.active;
  NodeLists const& lists = work.gather.lists;
  return {active.nodes, active.listed,       active.queries,
          active.fresh, lists.block_queries, active.due.flop + active.again.flop + work.gather.query.flop};
}

QueryCounts Simulation::query_counts() const { return impl_->counts() - impl_->counts_before; }

Plan Simulation::plan() const {
  Impl const& s = *impl_;
  Plan plan;
  plan.stages = stages_of(s.effects);
  plan.effects = names_of(s.effects);
  int const materials = static_cast<int>(s.scene.material.size());
  for (int a = 0; a < materials; ++a)
    for (int b = a; b < materials; ++b)
      if (s.scene.contact[a * materials + b].normal.modulus > 0)
        plan.law += (plan.law.empty() ? "" : "\n") + law_of(s, a, b);
  plan.arrays = arrays_of(s);
  plan.bodies = s.scene.bodies();
  plan.shapes = s.scene.templates();
  plan.networks = static_cast<int>(s.scene.networks.net.size());
  for (int i = 0; i < plan.shapes; ++i) plan.nodes_max = std::max(plan.nodes_max, s.scene.shape[i].nodes);
  plan.step = s.state.time_step;
  plan.steps = static_cast<std::int64_t>(std::ceil(s.c.time.end / s.state.time_step));
  plan.notes = s.scene.notes;
  for (std::string const& line : limits_set(s.c.limits)) plan.notes.push_back(line);
  if (CompactBytes const b = compact_bytes(s.scene); b.grains > 0)
    plan.notes.push_back(fmt::format(
        "{} compact grains of {} bytes each: nodes {}, culling {}, folded bias {}, records {}, code and mass {}",
        b.grains, b.total() / b.grains, b.nodes / b.grains, b.culling / b.grains, b.bias / b.grains,
        b.record / b.grains, b.host / b.grains));
  for (std::string& note : insertion_notes(s.c)) plan.notes.push_back(std::move(note));
  if (s.c.replicas > 1) plan.notes.push_back(replica_note(s.c));
  if (s.c.device && plan.networks > 0)
    plan.notes.push_back(precision_note(s.c.device->precision, s.options.network_device != nullptr));
  if (plan.bodies == 0) plan.notes.push_back("the case has no grains");
  if (std::isfinite(s.estimate.critical)) {
    double const share = s.state.time_step / s.estimate.critical;
    plan.notes.push_back(fmt::format(
        "critical step {:.3g} s from a worst impact of {:.3g} m/s (overlap {:.2g} d); the step "
        "is {:.2f} of it{}",
        s.estimate.critical, s.estimate.speed, s.estimate.overlap, share,
        share > 1     ? ": contacts are unstable, the run stops at the first that cannot work; use step = \"auto\""
        : share > 0.5 ? ": above 0.5 the energy ledger suffers; use step = \"auto\" or a smaller one"
                      : ""));
    double const load = load_in_grain_weights(s.c, s.scene);
    plan.notes.push_back(
        fmt::format("load check: at an overlap of 0.01 d the softest grain carries {:.3g} grain weights{}", load,
                    load < 20 ? "; a taller pile sinks in: raise the stiffness" : ""));
  }
  return plan;
}

ResultsHeader Simulation::results_header() const {
  Impl const& s = *impl_;
  ResultsHeader header;
  header.case_text = to_toml(s.c);
  header.library = s.scene.library;
  for (std::size_t i = header.library.shape.size(); i < std::size_t(s.scene.templates()); ++i)
    header.library.shape.push_back(s.scene.template_shape(static_cast<int>(i)));
  for (Shape const& shape : header.library.shape) header.shape_name.push_back(shape.name);
  int const n = s.scene.bodies();
  header.shape.assign(s.scene.shape_of.begin(), s.scene.shape_of.begin() + n);
  header.diameter.assign(s.scene.diameter.begin(), s.scene.diameter.begin() + n);
  header.material.assign(s.scene.material_of.begin(), s.scene.material_of.begin() + n);
  header.group = s.scene.group_of;
  for (GrainEntry const& e : entries_of(s.c)) header.replica.insert(header.replica.end(), e.count, e.replica);
  header.world = s.scene.world_of;
  for (PlaneRecord const& plane : s.scene.plane) header.wall.push_back(recorded_plane(s.c.wall[plane.wall], plane));
  header.wall_body = recorded_wall_bodies(s.c, s.scene);
  header.activity = !s.state.activity.empty();
  header.ledger = ledger_columns_of(s.effects);
  Box& domain = header.domain;
  domain = {{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  for (int i = 0; i < s.scene.bodies(); ++i) {
    if (!s.state.is_active(i)) continue;
    double const r = s.scene.shape[s.scene.shape_of[i]].bounding_radius * s.scene.diameter[i];
    for (int k = 0; k < 3; ++k) {
      domain.min[k] = std::min(domain.min[k], s.state.position[i][k] - r);
      domain.max[k] = std::max(domain.max[k], s.state.position[i][k] + r);
    }
  }
  auto const include = [&](Vec3 low, Vec3 high) {
    for (int k = 0; k < 3; ++k) {
      domain.min[k] = std::min(domain.min[k], low[k]);
      domain.max[k] = std::max(domain.max[k], high[k]);
    }
  };
  for (GrainsCase const& grains : s.c.grains)
    if (grains.insert.kind == InsertCase::Kind::rate) include(grains.insert.box.min, grains.insert.box.max);
  for (WallCase const& wall : s.c.wall) {
    if (wall.kind == WallKind::plane) include(wall.point, wall.point);
    if (wall.kind == WallKind::box) include(wall.min, wall.max);
  }
  for (ResultsWallBody const& wall : header.wall_body) {
    Mat3 const rotation = to_matrix(wall.orientation);
    include(wall.position, wall.position);
    for (Vec3 const& v : wall_surface(wall).vertex) {
      Vec3 const at = wall.position + rotation * v;
      include(at, at);
    }
  }
  if (s.scene.bodies() == 0 && s.c.wall.empty()) domain = {};
  return header;
}

Frame Simulation::frame() const {
  Impl const& s = *impl_;
  auto const of_grains = [&](auto const& v) { return std::vector(v.begin(), v.begin() + s.scene.bodies()); };
  Frame frame{s.state.time,
              s.state.step,
              of_grains(s.state.position),
              of_grains(s.state.orientation),
              of_grains(s.state.velocity),
              {},
              s.state.activity,
              {},
              {}};
  for (int i = 0; i < s.scene.bodies(); ++i)
    frame.spin.push_back(spin_of(to_matrix(s.state.orientation[i]), s.scene.inertia[i], s.state.angular_momentum[i]));
  for (std::size_t w = 0; w < s.scene.wall.size(); ++w) {
    if (!s.scene.wall[w].motion) continue;
    frame.wall_position.push_back(s.state.position[s.scene.bodies() + w]);
    frame.wall_orientation.push_back(s.state.orientation[s.scene.bodies() + w]);
  }
  return frame;
}

}  // namespace scree

// time_step.cpp: see time_step.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/time_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/travel.h"
#include "core/wall_motion.h"
#include "kernels/contact_laws.h"

namespace scree {
namespace {

double constexpr pi = 3.141592653589793;

// Height a grain can fall, along gravity: from the highest start to the lowest wall or grain [m].
double fall_height(Vec3 down, Scene const& scene, Placement const& placement) {
  double highest = 1e300, lowest = -1e300;  // along `down`: the highest has the smallest coordinate
  for (int i = 0; i < scene.bodies(); ++i) {
    double const r = scene.shape[scene.shape_of[i]].bounding_radius * scene.diameter[i];
    highest = std::min(highest, dot(down, placement.position[i]) - r);
    lowest = std::max(lowest, dot(down, placement.position[i]) + r);
  }
  for (PlaneRecord const& plane : scene.plane) {
    if (dot(plane.normal, down) > -0.5) continue;  // a floor faces up
    for (Vec3 const& x : placement.position) {
      // Where the vertical through x meets the plane.
      double const depth = dot(plane.normal, plane.point - x) / dot(plane.normal, down);
      lowest = std::max(lowest, dot(down, x) + depth);
    }
  }
  for (WallBody const& wall : scene.wall) lowest = std::max(lowest, dot(down, wall.position) + wall.reach);
  return std::max(0.0, lowest - highest);
}

// Squared speed that the applied forces can give a grain on its way to the lowest wall or grain along them, at most
// what their whole impulse gives [m2/s2].
double speed2_of_forces(Case const& c, Scene const& scene, Placement const& placement) {
  double speed2 = 0;
  for (ForceCase const& f : c.force) {
    if (!(norm2(f.force) > 0)) continue;
    double strongest = f.table.empty() ? 1 : 0;
    for (double const factor : f.table.value) strongest = std::max(strongest, std::abs(factor));
    double lightest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < scene.bodies(); ++i)
      if (c.grains[scene.group_of[i]].name == f.grains) lightest = std::min(lightest, scene.mass[i]);
    double const a = strongest * norm(f.force) / lightest;
    double const seconds = f.stop ? std::min(*f.stop, c.time.end) - f.start : c.time.end;
    double const by_impulse = a * std::max(0.0, seconds);
    Vec3 const along = normalized(f.force);
    double const way = std::max(fall_height(along, scene, placement), fall_height(-along, scene, placement));
    speed2 += std::min(by_impulse * by_impulse, 2 * a * way);
  }
  return speed2;
}

double inertia_mean(Vec3 i) { return (i.x + i.y + i.z) / 3; }

// Overlap at which a smooth contact stores m v^2 / 2 [m].
double impact_overlap(SphereLaw const& law, double m, double speed2) {
  if (law.law.kind == ContactLaw::winkler)  // m v^2 / 2 = pi R kappa overlap^3 / 3
    return std::cbrt(1.5 * m * speed2 / (pi * law.radius * law.law.modulus));
  double low = 0, high = law.radius;  // deeper than this no law holds
  for (int i = 0; i < 60; ++i) {
    double const mid = 0.5 * (low + high);
    (law.energy(mid) < 0.5 * m * speed2 ? low : high) = mid;
  }
  return high;
}

// Energy error a step may make as one node enters, in kinetic energies of its grain. Entering between two steps costs
// about p'(0) A (v dt)^2 / 4 of either sign, so the share depends on p'(0) A dt^2 / m alone, not on the speed. Measured
// (ellipsoids, 1,000 nodes): 6e-5 keeps an undamped collision to 1e-4. A scene that dissipates is held to the ledger's
// 1e-3 instead.
double constexpr entry_error_conservative = 6e-5, entry_error_dissipative = 1e-3;

// Step at which a closed-form sphere of these laws may enter: their stiffness rises at once, and half way through a
// step that costs K (v dt)^2 / 8 of either sign, with K at the overlap v dt. Winkler's sphere starts softly and needs
// none.
double entry_step(SphereLaw const& law, double m, double speed, double entry_error) {
  double dt = std::sqrt(4 * entry_error * m / law.stiffness(law.radius));
  for (int i = 0; i < 40; ++i) {  // K grows slower than the overlap: a contraction
    double const stiffness = law.stiffness(std::max(speed * dt, 1e-6 * law.radius));
    dt = std::sqrt(4 * entry_error * m / stiffness);
  }
  return dt;
}

// Largest flat face a shape can land on [d^2]: a box has one; of other bodies contact stays round or small. A baked box
// keeps its formula beside its grid or mesh.
double flat_face(Shape const& shape) {
  if (shape.analytic.kind != AnalyticKind::box) return 0;
  Vec3 const h = shape.analytic.half_size;
  return 4 * std::max({h.x * h.y, h.y * h.z, h.x * h.z});
}

}  // namespace

StepEstimate estimate_critical_step(Case const& c, Scene const& scene, Placement const& placement) {
  StepEstimate out;
  out.critical = out.accurate = std::numeric_limits<double>::infinity();
  double fastest = 0;
  for (int i = 0; i < scene.bodies(); ++i) {
    double const r = scene.shape[scene.shape_of[i]].bounding_radius * scene.diameter[i];
    fastest = std::max(fastest, norm(placement.velocity[i]) + r * norm(placement.spin[i]));
  }
  if (c.drag && c.drag->density * c.drag->coefficient > 0) fastest += norm(c.drag->fluid_velocity);
  // Two grains may meet head-on, or a wall comes towards one.
  double driven = 0;
  for (WallBody const& wall : scene.wall)
    if (wall.motion) driven = std::max(driven, scree::fastest(*wall.motion, wall.position, wall.reach));
  double speed2 = std::max(4 * fastest * fastest, (fastest + driven) * (fastest + driven));
  if (c.gravity && norm(*c.gravity) > 0)
    speed2 += 2 * norm(*c.gravity) * fall_height(normalized(*c.gravity), scene, placement);
  speed2 += speed2_of_forces(c, scene, placement);
  out.speed = std::sqrt(speed2);
  if (out.speed > 0) out.accurate = largest_travel * least_half_thickness(scene) / out.speed;
  for (int i = 0; i < scene.bodies(); ++i) {
    Shape const shape = scene.template_shape(scene.shape_of[i]);
    double const d = scene.diameter[i], m = scene.mass[i];
    Vec3 const inertia = scene.inertia[i];
    for (int material = 0; material < static_cast<int>(scene.material.size()); ++material) {
      ContactParameters const& p =
          scene.contact[scene.material_of[i] * static_cast<int>(scene.material.size()) + material];
      if (!(p.normal.modulus > 0)) continue;
      double const radius = d / 2;  // round impact on a plane
      SphereLaw const law{law_at_radius(p.normal, radius), radius};
      double const steepest = law.law.slope(0);
      double const adhesive = 2 * pi * radius * p.cohesion.traction;  // |K| of a closed form [N/m]
      // Adhesion speeds grains up on their last way, by 2 pi R traction range^2 / 2 at most.
      double const impact2 = speed2 + 2 * adhesive * p.cohesion.reach() * p.cohesion.reach() / m;
      double const overlap = std::max(impact_overlap(law, m, impact2), 1e-3 * d);
      double const stiffness =
          adhesive + std::max(law.stiffness(overlap), steepest * flat_face(shape) * d * d) *
                         std::max(1.0, p.tangential * law.tangential(overlap) / law.stiffness(overlap));
      double const least = std::min({inertia.x, inertia.y, inertia.z});
      double const turning = p.rolling_ratio * stiffness * p.rolling * p.rolling * radius * radius;
      double const omega2 = 2 * (stiffness * (1 / m + radius * radius / least) + turning / least);  // both bodies
      // A grain that turns by itself feels the damping of one that rolls, design physics.md section 4.
      double const rolling =
          p.rolling > 0 ? p.rolling_damping * std::sqrt((inertia_mean(inertia) + m * radius * radius) / least) : 0;
      double const zeta = std::max({p.damping_nodes, p.damping_sphere, rolling});
      double const critical = 2 / std::sqrt(omega2) * (std::sqrt(1 + zeta * zeta) - zeta);
      if (critical < out.critical) out.critical = critical, out.overlap = overlap / d;
      double const spacing = scene.shape[scene.shape_of[i]].node_spacing * d;
      double const entry_error = zeta > 0 ? entry_error_dissipative : entry_error_conservative;
      if (scene.shape[scene.shape_of[i]].closed_form_sphere && law.law.kind != ContactLaw::winkler)
        out.accurate = std::min(out.accurate, entry_step(law, m, out.speed, entry_error));
      double const ramp = p.cohesion.traction > 0 ? p.cohesion.traction / p.cohesion.ramp() : 0;
      if (ramp > 0)  // a sphere should not cross the edge of the adhesion within a step
        out.accurate =
            std::min(out.accurate, std::sqrt(4 * entry_error * m * p.cohesion.ramp() / (adhesive * p.cohesion.range)));
      if (spacing > 0)
        out.accurate = std::min(out.accurate, std::sqrt(entry_error * m / ((steepest + ramp) * spacing * spacing)));
    }
  }
  return out;
}

double overlap_at_speed(Case const& c, Scene const& scene, int body, double speed) {
  ContactParameters const& p = scene.contact[scene.material_of[body] * (static_cast<int>(scene.material.size()) + 1)];
  if (!(p.normal.modulus > 0)) return 0;
  double const d = scene.diameter[body], m = scene.mass[body], weight = c.gravity ? m * norm(*c.gravity) : 0;
  SphereLaw const law{law_at_radius(p.normal, d / 4), d / 4};
  double low = 0, high = law.radius;  // at rest
  for (int i = 0; i < 60; ++i) {
    double const mid = 0.5 * (low + high);
    (law.force(mid) < weight ? low : high) = mid;
  }
  return std::max(high, impact_overlap(law, m / 2, speed * speed)) / d;
}

std::vector<std::string> load_problems(Case const& c, Scene const& scene) {
  std::vector<std::string> found;
  if (!c.gravity) return found;
  int const materials = static_cast<int>(scene.material.size());
  std::vector<int> smallest(materials, -1), heaviest(materials, -1);
  for (int i = 0; i < scene.bodies(); ++i) {
    int& small = smallest[scene.material_of[i]];
    int& heavy = heaviest[scene.material_of[i]];
    if (small < 0 || scene.diameter[i] < scene.diameter[small]) small = i;
    if (heavy < 0 || scene.mass[i] > scene.mass[heavy]) heavy = i;
  }
  for (int a = 0; a < materials; ++a)
    for (int b = 0; b < materials; ++b) {
      PressureLaw const normal = scene.contact[a * materials + b].normal;
      if (smallest[a] < 0 || heaviest[b] < 0 || smallest[a] == heaviest[b] || !(normal.modulus > 0)) continue;
      double const d = scene.diameter[smallest[a]], depth = c.limits.overlap * d;
      double const radius = 0.5 / (1 / d + 1 / scene.diameter[heaviest[b]]);
      PressureLaw const law = law_at_radius(normal, radius);
      double const face = flat_face(scene.template_shape(scene.shape_of[smallest[a]])) * d * d;
      double const carried = std::max(SphereLaw{law, radius}.force(depth), face * law.pressure(depth));
      double const weight = scene.mass[heaviest[b]] * norm(*c.gravity);
      if (weight <= carried) continue;
      found.push_back(fmt::format(
          "load check: the heaviest grain of '{}' weighs {:.3g} N, {:.3g} times the smallest one of '{}', which "
          "carries {:.3g} N at limits.overlap = {}. Multiply the stiffness of contact '{}' - '{}' by {:.3g}{}",
          scene.material[b], weight, scene.mass[heaviest[b]] / scene.mass[smallest[a]], scene.material[a], carried,
          c.limits.overlap, scene.material[a], scene.material[b], weight / carried,
          law.kind == ContactLaw::winkler ? fmt::format(" (normal.kappa = {:.3g})", normal.modulus * weight / carried)
                                          : ""));
    }
  return found;
}

double load_in_grain_weights(Case const& c, Scene const& scene) {
  double const g = c.gravity && norm(*c.gravity) > 0 ? norm(*c.gravity) : 9.81;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < scene.bodies(); ++i) {
    ContactParameters const& p = scene.contact[scene.material_of[i] * (static_cast<int>(scene.material.size()) + 1)];
    double const d = scene.diameter[i];
    if (p.normal.modulus > 0)
      least = std::min(least, SphereLaw{law_at_radius(p.normal, d / 4), d / 4}.force(0.01 * d) / (scene.mass[i] * g));
  }
  return least;
}

}  // namespace scree

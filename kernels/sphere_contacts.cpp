// sphere_contacts.cpp: spheres against spheres and smooth walls in closed form: one contact, no nodes, no network.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/parallel.h"
#include "kernels/contact_laws.h"
#include "kernels/contact_reduce.h"
#include "kernels/rolling.h"

namespace scree {
namespace {

// Of a pair in closed form: Hertz's force starts softly by itself, so it needs no straight line below an onset.
SCREE_HD PressureLaw law_of_spheres(PressureLaw const& law, double radius) {
  PressureLaw out = law_at_radius(law, radius);
  if (out.kind == ContactLaw::hertz) out.onset = 0;
  return out;
}

struct SpherePair {
  SceneView scene;
  StateView state;
  KinematicsView kinematics;
  ContactOptions options;
  Span<const Pair> pair;
  Span<const char> closed_form;
  Span<const Vec3> history_xi;
  Span<const double> history_stiffness;
  Span<Vec3> next_xi;  // empty without friction
  Span<double> next_stiffness;
  RollingView rolling;
  Span<PairResult> result;

  SCREE_HD double radius(int body) const {
    return scene.shape_record(body).analytic.half_size.x * scene.diameter[body];
  }

  // The gap between a sphere and a wall with curvatures c1, c2 opens as x^2 / (2 R1) + y^2 / (2 R2) with
  // 1/R1 = 1/r + c1; the law's integral over it is that of a sphere with R = sqrt(R1 R2).
  SCREE_HD static double radius_against(double r, Curvatures c) {
    double const least = 1e-3 / r;  // a sphere that nearly fits its bore: the closed form ends here
    double const first = 1 / r + c.first, second = 1 / r + c.second;
    return 1 / std::sqrt((first > least ? first : least) * (second > least ? second : least));
  }

  // A normal force has no lever arm about a sphere's centre, but it may have one about a wall's.
  SCREE_HD void turn_wall(Pair p, Vec3 x, PairWrench& w) const {
    if (!p.with_plane() && scene.is_wall(p.b)) w.torque_b = -cross(x - state.position[p.b], w.force_on_a);
  }

  SCREE_HD void operator()(int k) const {
    if (!next_xi.empty()) next_xi[k] = {}, next_stiffness[k] = 0;
    if (!closed_form[k]) return;
    Pair const p = pair[k];
    PairResult out;
    if (rolling.on()) rolling.next_angle[k] = {}, rolling.next_stiffness[k] = 0, rolling.result[k] = {};
    double const ra = radius(p.a);
    Vec3 const xa = state.position[p.a];
    Vec3 n;  // from b to a
    double overlap, effective, reach_b = 0;
    if (p.with_plane()) {
      PlaneRecord const& plane = scene.plane[p.plane()];
      n = plane.normal;
      overlap = ra - dot(n, xa - plane.point);
      effective = ra;
    } else if (scene.is_wall(p.b)) {
      Mat3 const& rotation = kinematics.rotation[p.b];
      Vec3 const local = transposed_times(rotation, xa - state.position[p.b]);
      Vec3 gradient;
      overlap = ra + signed_distance(scene.shape_record(p.b).analytic, local, &gradient);
      n = rotation * -gradient;
      effective = radius_against(ra, wall_curvatures(scene.shape_record(p.b).analytic, local));
    } else {
      double const rb = radius(p.b);
      Vec3 const gap = xa - state.position[p.b];
      double const distance = norm(gap);
      n = distance > 0 ? gap / distance : Vec3{0, 0, 1};
      overlap = ra + rb - distance;
      effective = ra * rb / (ra + rb);
      reach_b = rb - 0.5 * overlap;
    }
    ContactParameters const& parameters = contact_parameters(scene, p);
    if (!(overlap > 0) && !(parameters.cohesion.traction > 0 && overlap > -parameters.cohesion.reach())) {
      result[k] = out;
      return;
    }
    SphereLaw const law{law_of_spheres(parameters.normal, effective), effective};
    // The contact point lies half way into the overlap; on a wall, on the wall.
    bool const wall = p.with_plane() || scene.is_wall(p.b);
    Vec3 const x = wall ? xa - n * (ra - overlap) : state.position[p.b] + n * reach_b;
    double adhesive_stiffness = 0;
    if (parameters.cohesion.traction > 0) {
      double const girth = 2 * SphereLaw::pi * effective;
      out.elastic.force_on_a = n * (girth * parameters.cohesion.energy(overlap));
      out.energy_normal = girth * parameters.cohesion.energy_integral(overlap);
      out.active = 1;
      out.stiffness = adhesive_stiffness = -girth * parameters.cohesion.pressure(overlap);
      turn_wall(p, x, out.elastic);
      if (!(overlap > 0)) {  // adhesion does not damp, and friction lives on the force of the law
        out.arm2_a = norm2(x - xa);
        out.arm2_b = p.with_plane() ? 0 : norm2(x - state.position[p.b]);
        result[k] = out;
        return;
      }
    }
    double const mass = 1 / inverse_effective_mass(scene, state, kinematics, p, x, n);
    double const stiffness = law.stiffness(overlap), force = law.force(overlap);
    Vec3 const v =
        point_velocity(state, kinematics, p.a, x) - point_velocity(state, kinematics, p.with_plane() ? -1 : p.b, x);
    double total = force - 2 * parameters.damping_sphere * std::sqrt(mass * stiffness) * dot(n, v);
    total = total > 0 ? total : 0;
    Vec3 const arm_a = x - xa, arm_b = p.with_plane() ? Vec3{} : x - state.position[p.b];
    out.elastic.force_on_a += n * force;
    out.damping.force_on_a = n * (total - force);
    turn_wall(p, x, out.elastic);
    turn_wall(p, x, out.damping);
    out.energy_normal += law.energy(overlap);
    out.overlap = overlap;
    out.active = 1;
    out.damping_ratio = parameters.damping_sphere;
    out.arm2_a = norm2(arm_a);
    out.arm2_b = norm2(arm_b);
    out.stiffness = stiffness;
    double const k_t = law.tangential(overlap) * parameters.tangential;
    if (parameters.friction > 0 && k_t > 0) {
      Vec3 const old =
          transport(restored(history_xi[k], history_stiffness[k], k_t), mean_turn(kinematics, p, options.time_step), n);
      TangentialResult const t =
          slide(old, v - n * dot(n, v), options.time_step, 2 * parameters.damping_sphere * std::sqrt(mass / k_t),
                parameters.friction * total / k_t);
      next_xi[k] = t.xi;
      next_stiffness[k] = k_t;
      Vec3 const drag = t.traction * -k_t;
      out.friction = {drag, cross(arm_a, drag), -cross(arm_b, drag)};
      out.energy_tangential = 0.5 * k_t * norm2(t.xi);
      out.friction_loss = k_t * t.loss;
      out.stiffness = stiffness > k_t ? stiffness : k_t;
    }
    if (rolling.on())
      resist_rolling(scene, kinematics, rolling, p, k, options.time_step, n, total, stiffness, out.arm2_a, out.arm2_b);
    out.stiffness += adhesive_stiffness;
    result[k] = out;
  }
};

}  // namespace

void sphere_contacts(Queue const& queue, SceneView const& scene, StateView const& state, KinematicsView kinematics,
                     ContactOptions const& options, Span<const Pair> pair, Span<const char> closed_form,
                     SphereHistory const& history, SphereHistory& next, RollingView const& rolling,
                     Span<PairResult> result) {
  if (scene.friction) {
    next.xi.resize(pair.size());
    next.stiffness.resize(pair.size());
  }
  parallel_for(queue, "sphere_contacts/pairs", pair.size(),
               SpherePair{scene, state, kinematics, options, pair, closed_form, history.xi, history.stiffness, next.xi,
                          next.stiffness, rolling, result},
               256);
}

}  // namespace scree

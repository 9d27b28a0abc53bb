// sphere_contacts.cpp: spheres against spheres and smooth walls in closed form: one contact, no nodes, no network.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/base/parallel.h"
#include "kernels/base/prefetch.h"
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

// Where a ball a meets its partner b, and how. Arms run from a centroid to the contact point.
struct Touch {
  Vec3 n;              // from b to a
  double overlap;      // [m]
  double effective;    // R [m]
  double mass;         // m_e [kg]: arms along n take no part in it, and walls are infinitely heavy
  Vec3 velocity;       // of a past b at the contact point [m/s]
  double lever_a;      // the arm of a is -lever_a n [m]
  double lever_b = 0;  // that of another ball lever_b n [m]
  Vec3 arm_b;          // that of a wall which is a body: it may lie anywhere [m]
};

struct Friction {
  Vec3 force_on_a;              // [N]
  double stiffness = 0;         // [N/m]
  double energy = 0, loss = 0;  // stored, and lost in this step [J]
};

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
  Span<char> in_contact;

  SCREE_HD double radius(int body) const { return 0.5 * scene.diameter[body]; }

  // The gap between a sphere and a wall with curvatures c1, c2 opens as x^2 / (2 R1) + y^2 / (2 R2) with
  // 1/R1 = 1/r + c1; the law's integral over it is that of a sphere with R = sqrt(R1 R2).
  SCREE_HD static double radius_against(double r, Curvatures c) {
    double const least = 1e-3 / r;  // a sphere that nearly fits its bore: the closed form ends here
    double const first = 1 / r + c.first, second = 1 / r + c.second;
    return 1 / std::sqrt((first > least ? first : least) * (second > least ? second : least));
  }

  SCREE_HD Vec3 spin_of_b(Pair p) const { return p.with_plane() ? Vec3{} : kinematics.spin[p.b]; }

  // The contact point lies half way into the overlap.
  SCREE_HD Touch with_ball(Pair p, double ra, Vec3 gap) const {
    Touch t;
    double const rb = radius(p.b), distance = norm(gap), ma = scene.mass[p.a], mb = scene.mass[p.b];
    t.n = distance > 0 ? gap * (1 / distance) : Vec3{0, 0, 1};
    t.overlap = ra + rb - distance;
    t.effective = ra * rb / (ra + rb);
    t.mass = ma * mb / (ma + mb);
    t.lever_a = ra - 0.5 * t.overlap;
    t.lever_b = rb - 0.5 * t.overlap;
    Vec3 const rolled = kinematics.spin[p.a] * t.lever_a + kinematics.spin[p.b] * t.lever_b;
    t.velocity = state.velocity[p.a] - state.velocity[p.b] - cross(rolled, t.n);
    return t;
  }

  // ... on a wall, on the wall.
  SCREE_HD Touch with_wall(Pair p, double ra) const {
    Touch t;
    Vec3 const xa = state.position[p.a];
    if (p.with_plane()) {
      PlaneRecord const& plane = scene.plane[p.plane()];
      t.n = plane.normal;
      t.overlap = ra - dot(t.n, xa - plane.point);
      t.effective = ra;
      t.velocity = state.velocity[p.a];
    } else {
      Mat3 const& rotation = kinematics.rotation[p.b];
      Vec3 const local = transposed_times(rotation, xa - state.position[p.b]);
      Vec3 gradient;
      t.overlap = ra + signed_distance(scene.shape_record(p.b).analytic, local, &gradient);
      t.n = rotation * -gradient;
      t.effective = radius_against(ra, wall_curvatures(scene.shape_record(p.b).analytic, local));
      t.arm_b = xa - t.n * (ra - t.overlap) - state.position[p.b];
      t.velocity = state.velocity[p.a] - state.velocity[p.b] - cross(kinematics.spin[p.b], t.arm_b);
    }
    t.mass = scene.mass[p.a];
    t.lever_a = ra - t.overlap;
    t.velocity -= cross(kinematics.spin[p.a] * t.lever_a, t.n);
    return t;
  }

  SCREE_HD void operator()(int k) const {
    if (int const next = k + prefetch_ahead; next < pair.size() && pair[next].b >= 0 && closed_form[next]) {
      prefetch(state.position, pair[next].b);
      if (in_contact[next]) prefetch(state.velocity, pair[next].b), prefetch(kinematics.spin, pair[next].b);
    }
    if (!next_xi.empty()) next_xi[k] = {}, next_stiffness[k] = 0;
    if (!closed_form[k]) return;
    if (rolling.on()) rolling.next_angle[k] = {}, rolling.next_stiffness[k] = 0, rolling.result[k] = {};
    Pair const p = pair[k];
    double const ra = radius(p.a);
    ContactParameters const& parameters = contact_parameters(scene, p);
    double const reach = parameters.cohesion.traction > 0 ? parameters.cohesion.reach() : 0;
    if (p.with_plane() || scene.is_wall(p.b)) {
      Touch const t = with_wall(p, ra);
      return t.overlap > -reach ? meet(k, p, parameters, t) : leave(k);
    }
    // Most pairs of a list do not touch: they cost no root. What is no number touches nothing.
    Vec3 const gap = state.position[p.a] - state.position[p.b];
    double const touching = ra + radius(p.b) + reach;
    return norm2(gap) < touching * touching ? meet(k, p, parameters, with_ball(p, ra, gap)) : leave(k);
  }

  SCREE_HD void leave(int k) const {
    if (in_contact[k]) result[k] = {}, in_contact[k] = 0;
  }

  // The pair's spring, carried over from the last step, under the normal force `pressing` [N].
  SCREE_HD Friction friction(int k, Pair p, ContactParameters const& parameters, Touch const& t, double k_t,
                             double pressing) const {
    double const softness = 1 / k_t;
    Vec3 old = restored(history_xi[k], history_stiffness[k], k_t);
    Vec3 const turn = (kinematics.spin[p.a] + spin_of_b(p)) * (0.5 * options.time_step);
    if (norm2(old) > 0) old = laid_flat(turned_by(turn, old), t.n);
    double const beta = 2 * parameters.damping_sphere * std::sqrt(t.mass * softness);
    TangentialResult const slid = slide(old, t.velocity - t.n * dot(t.n, t.velocity), options.time_step, beta,
                                        parameters.friction * pressing * softness);
    next_xi[k] = slid.xi;
    next_stiffness[k] = k_t;
    return {slid.traction * -k_t, k_t, 0.5 * k_t * norm2(slid.xi), k_t * slid.loss};
  }

  SCREE_HD void meet(int k, Pair p, ContactParameters const& parameters, Touch const& t) const {
    double pushing = 0, pressing = 0, stiffness = 0;  // force of the law, the same with its damping, K
    PairResult& out = result[k];
    out.energy_normal = 0;
    Friction rubbing;
    if (t.overlap > 0) {  // adhesion does not damp, and friction lives on the force of the law
      SphereLaw const law{law_of_spheres(parameters.normal, t.effective), t.effective};
      pushing = law.force(t.overlap), stiffness = law.stiffness(t.overlap);
      out.energy_normal = law.energy(t.overlap);
      double const damping = 2 * parameters.damping_sphere * std::sqrt(t.mass * stiffness);
      pressing = pushing - damping * dot(t.n, t.velocity);
      pressing = pressing > 0 ? pressing : 0;
      double const k_t = law.tangential(t.overlap) * parameters.tangential;
      if (parameters.friction > 0 && k_t > 0) rubbing = friction(k, p, parameters, t, k_t, pressing);
    }
    double adhesion = 0, adhesive_stiffness = 0;
    if (parameters.cohesion.traction > 0) {
      double const girth = 2 * SphereLaw::pi * t.effective;
      adhesion = girth * parameters.cohesion.energy(t.overlap);
      adhesive_stiffness = -girth * parameters.cohesion.pressure(t.overlap);
      out.energy_normal += girth * parameters.cohesion.energy_integral(t.overlap);
    }
    out.elastic = normal_wrench(t, pushing + adhesion);
    out.damping = normal_wrench(t, pressing - pushing);
    Vec3 const drag = rubbing.force_on_a, turning = cross(t.n, drag);
    out.friction = {drag, turning * -t.lever_a, turning * -t.lever_b - cross(t.arm_b, drag)};
    out.energy_tangential = rubbing.energy;
    out.friction_loss = rubbing.loss;
    out.overlap = t.overlap > 0 ? t.overlap : 0;
    out.damping_ratio = t.overlap > 0 ? parameters.damping_sphere : 0;
    out.stiffness = (rubbing.stiffness > stiffness ? rubbing.stiffness : stiffness) + adhesive_stiffness;
    out.arm2_a = t.lever_a * t.lever_a;
    out.arm2_b = t.lever_b * t.lever_b + norm2(t.arm_b);
    out.active = 1;
    in_contact[k] = 1;
    if (rolling.on() && t.overlap > 0)
      resist_rolling(scene, kinematics, rolling, p, k, options.time_step, t.n, pressing, stiffness, out.arm2_a,
                     out.arm2_b);
  }

  // A normal force has no lever arm about a ball's centre, but it may have one about a wall's.
  SCREE_HD static PairWrench normal_wrench(Touch const& t, double size) {
    Vec3 const force = t.n * size;
    return {force, {}, -cross(t.arm_b, force)};
  }
};

}  // namespace

void sphere_contacts(Queue const& queue, SceneView const& scene, StateView const& state, KinematicsView kinematics,
                     ContactOptions const& options, Span<const Pair> pair, Span<const char> closed_form,
                     SphereHistory const& history, SphereHistory& next, RollingView const& rolling,
                     Span<PairResult> result, Span<char> in_contact) {
  if (scene.friction) {
    next.xi.resize(pair.size());
    next.stiffness.resize(pair.size());
  }
  parallel_for(queue, "sphere_contacts/pairs", pair.size(),
               SpherePair{scene, state, kinematics, options, pair, closed_form, history.xi, history.stiffness, next.xi,
                          next.stiffness, rolling, result, in_contact},
               256);
}

}  // namespace scree

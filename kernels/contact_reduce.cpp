// contact_reduce.cpp: node contacts of a pair. See contact_reduce.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/contact_reduce.h"

#include "kernels/base/parallel.h"
#include "kernels/base/prefetch.h"
#include "kernels/contact_laws.h"
#include "kernels/node_access.h"
#include "kernels/rolling.h"

namespace scree {
namespace {

// A part is thin when its half thickness is below this share of the other body's diameter.
double constexpr thin_part = 0.2;

struct ReducePair {
  SceneView scene;
  StateView state;
  KinematicsView kinematics;
  ContactOptions options;
  Span<const Pair> pair;
  Span<const char> closed_form;
  Span<const int> side_of_pair;
  Span<const int> active_first, active_node;
  Span<const Vec3> point;     // partner frame
  Span<const double> phi;     // partner's unit
  Span<const Vec3> gradient;  // partner frame
  Span<const int> history_first, history_count, history_node;
  Span<const Vec3> history_xi;
  Span<Vec3> next_xi;        // of every active node; empty without friction
  Span<NodeSample> samples;  // scratch of every active node
  RollingView rolling;
  Span<PairResult> result;
  Span<char> in_contact;

  // One side of a pair, and what its nodes have in common.
  struct SideFrame {
    int side = -1;  // of the lists; -1: nothing there is active
    int carrier, partner;
    double sign;  // of the force on a along the gradient: a node of a is pushed against it, a node of b along it
    double share;
    double d, partner_unit;  // [m]
    Vec3 position;           // of the carrier [m]
    Mat3 rotation;           // of the carrier
    Mat3 partner_rotation;   // of a body
    Vec3 plane_gradient;     // of a plane
  };

  SCREE_HD SideFrame side_frame(Pair const& p, int which, double share, int side) const {
    SideFrame f;
    f.side = side;
    f.carrier = which == 0 ? p.a : p.b;
    f.partner = which == 0 ? p.b : p.a;
    f.sign = which == 0 ? -1 : 1;
    f.share = share;
    f.d = scene.diameter[f.carrier];
    f.position = state.position[f.carrier];
    f.rotation = kinematics.rotation[f.carrier];
    f.partner_unit = f.partner < 0 ? 1 : scene.diameter[f.partner];
    if (f.partner < 0)
      f.plane_gradient = -scene.plane[-1 - f.partner].normal;
    else
      f.partner_rotation = kinematics.rotation[f.partner];
    return f;
  }

  SCREE_HD NodeSample sample(SideFrame const& f, ShapeRecord const& shape, int i) const {
    NodeSample out;
    int const node = active_node[i];
    out.x = f.position + f.rotation * (node_position(scene.nodes, shape, node) * f.d);
    out.weight = f.share * node_area(scene.nodes, shape, node) * f.d * f.d;
    out.phi = phi[i] * f.partner_unit;
    out.gradient = f.partner < 0 ? f.plane_gradient : f.partner_rotation * gradient[i];
    if (options.normalise_gradient) out.gradient = normalized(out.gradient);
    out.steep = norm(out.gradient);
    return out;
  }

  SCREE_HD static void add(PairWrench& wrench, Vec3 force_on_a, Vec3 x, Vec3 centre_a, Vec3 centre_b) {
    wrench.force_on_a += force_on_a;
    wrench.torque_a += cross(x - centre_a, force_on_a);
    wrench.torque_b -= cross(x - centre_b, force_on_a);
  }

  // Pair sums that the damping needs: K, 1/m_e at the force-weighted point, and the elastic part.
  struct Sums {
    double stiffness = 0, tangential = 0;  // K and K_t [N/m]
    double damping = 0;                    // of the weights that share out the damping
    double area = 0, depth = 0;            // of the active nodes [m^2], and times their phi [m^3]
    double force = 0;                      // sum of |node forces|, adhesive ones counted [N]
    double pressing = 0;                   // ... without those [N]
    double adhesive = 0;                   // sum of |K| of the adhesion [N/m]
    Vec3 point;                            // force-weighted [m]
  };

  SCREE_HD void elastic_pass(Pair const& p, SideFrame const& f, PressureLaw const& law,
                             ContactParameters const& parameters, Vec3 centre_b, Sums& sums, PairResult& out) const {
    double const secant = law.secant();
    ShapeRecord const& shape = scene.shape_record(f.carrier);
    Vec3 const centre_a = state.position[p.a];
    // Of thick bodies the core nodes keep the energy rising to the centre; thin parts would let a node through.
    double const half = f.partner < 0 ? 1e300 : scene.shape_record(f.partner).half_thickness * f.partner_unit;
    bool const of_a = f.carrier == p.a || p.with_plane() || scene.is_wall(p.b);  // walls have no size of their own
    double const middle = half < thin_part * scene.diameter[of_a ? p.a : p.b] ? half : 1e300;
    for (int i = active_first[f.side]; i < active_first[f.side + 1]; ++i) {
      NodeSample const s = sample(f, shape, i);
      samples[i] = s;
      double const steep = s.steep;
      ++out.active;
      double adhesion = 0;
      if (parameters.cohesion.traction > 0) {
        adhesion = parameters.cohesion.pressure(s.phi);
        sums.adhesive += s.weight * parameters.cohesion.slope(s.phi) * steep * steep;
        sums.force -= s.weight * adhesion * steep;
        sums.point -= s.x * (s.weight * adhesion * steep);
        out.energy_normal += s.weight * parameters.cohesion.energy(s.phi);
        add(out.elastic, s.gradient * (f.sign * s.weight * adhesion), s.x, centre_a, centre_b);
        if (!(s.phi > 0)) continue;
      }
      double const pressure = law.pressure(s.phi), slope = law.slope(s.phi);
      add(out.elastic, s.gradient * (f.sign * s.weight * pressure), s.x, centre_a, centre_b);
      double const force = s.weight * pressure * steep;
      sums.force += force;
      sums.pressing += force;
      sums.point += s.x * force;
      sums.stiffness += s.weight * slope * steep * steep;
      sums.damping += s.weight * law.damping_weight(s.phi) * steep * steep;
      sums.tangential += s.weight * secant * parameters.tangential;
      sums.area += s.weight;
      sums.depth += s.weight * s.phi;
      out.energy_normal += s.weight * law.energy(s.phi);
      out.overlap = s.phi > out.overlap ? s.phi : out.overlap;
      out.depth = s.phi > out.depth * middle ? s.phi / middle : out.depth;
    }
  }

  SCREE_HD Vec3 remembered(int side, int node, int& cursor) const {
    int const end = history_first[side] + history_count[side];
    while (cursor < end && history_node[cursor] < node) ++cursor;
    return cursor < end && history_node[cursor] == node ? history_xi[cursor] : Vec3{};
  }

  SCREE_HD void dissipative_pass(Pair const& p, SideFrame const& f, PressureLaw const& law,
                                 ContactParameters const& parameters, double beta, double beta_t, Mat3 const& turn,
                                 Vec3 centre_b, Vec3& pressing, PairResult& out) const {
    bool const friction = parameters.friction > 0;
    double const secant = law.secant();
    Vec3 const centre_a = state.position[p.a];
    int cursor = friction ? history_first[f.side] : 0;
    for (int i = active_first[f.side]; i < active_first[f.side + 1]; ++i) {
      NodeSample const s = samples[i];
      if (!next_xi.empty()) next_xi[i] = {};
      if (!(s.phi > 0)) continue;  // adhesion does not damp, and friction lives on the pressure of the law
      double const pressure = law.pressure(s.phi), steep = s.steep;
      Vec3 const v =
          point_velocity(state, kinematics, f.carrier, s.x) - point_velocity(state, kinematics, f.partner, s.x);
      double total = pressure + beta * law.damping_weight(s.phi) * dot(s.gradient, v);
      total = total > 0 ? total : 0;  // a contact pushes, it never pulls
      pressing += s.gradient * (f.sign * s.weight * total);
      if (beta > 0) add(out.damping, s.gradient * (f.sign * s.weight * (total - pressure)), s.x, centre_a, centre_b);
      if (!friction || !(steep > 0)) continue;
      Vec3 const n = s.gradient / steep;
      double const kappa_t = secant * parameters.tangential;
      Vec3 const old = transport(remembered(f.side, active_node[i], cursor), turn, n);
      TangentialResult const t =
          slide(old, v - n * dot(n, v), options.time_step, beta_t, parameters.friction * total * steep / kappa_t);
      next_xi[i] = t.xi;
      double const stiffness = s.weight * kappa_t;
      // The traction resists the carrier; on a it has the carrier's sign.
      add(out.friction, t.traction * (f.sign * stiffness), s.x, centre_a, centre_b);
      out.energy_tangential += 0.5 * stiffness * norm2(t.xi);
      out.friction_loss += stiffness * t.loss;
    }
  }

  // s of the two sides: halves, but where one body's nodes stand more than twice as far apart as the other's, the finer
  // side carries all: nodes that are wider apart than the partner is large would see nothing of it, or far too much.
  // Constant for a pair, so that the energy stays one.
  struct Shares {
    double of[2];
  };
  SCREE_HD Shares shares_of(Pair const& p) const {
    double const a = scene.shape_record(p.a).node_spacing * scene.diameter[p.a];
    double const b = scene.shape_record(p.b).node_spacing * scene.diameter[p.b];
    if (a > 2 * b) return {{0, 1}};
    if (b > 2 * a) return {{1, 0}};
    return {{0.5, 0.5}};
  }

  SCREE_HD bool active_on(int side) const { return side >= 0 && active_first[side] < active_first[side + 1]; }

  // What the contacts of a pair will need of its second body.
  SCREE_HD void prefetch_pair(int k) const {
    int const body = pair[k].b;
    if (body < 0 || !(active_on(side_of_pair[2 * std::size_t(k)]) || active_on(side_of_pair[2 * std::size_t(k) + 1])))
      return;
    prefetch(state.position, body);
    prefetch(state.velocity, body);
    prefetch(kinematics.spin, body);
    prefetch(kinematics.rotation, body);
  }

  SCREE_HD void operator()(int k) const {
    if (k + prefetch_ahead < pair.size()) prefetch_pair(k + prefetch_ahead);
    if (closed_form[k]) return;
    Pair const p = pair[k];
    if (rolling.on()) rolling.next_angle[k] = {}, rolling.next_stiffness[k] = 0, rolling.result[k] = {};
    int const sides[2] = {side_of_pair[2 * std::size_t(k)], side_of_pair[2 * std::size_t(k) + 1]};
    if (!active_on(sides[0]) && !active_on(sides[1])) {
      if (in_contact[k]) result[k] = {}, in_contact[k] = 0;
      return;
    }
    PairResult out;
    // Walls carry nodes along their sharp edges only, so the grain's nodes keep their whole weight against them.
    bool const wall = p.with_plane() || scene.is_wall(p.b);
    Shares const share = wall || sides[0] < 0 || sides[1] < 0 ? Shares{{1, 1}} : shares_of(p);
    ContactParameters const& parameters = contact_parameters(scene, p);
    PressureLaw const law = law_at_radius(parameters.normal, effective_radius(scene, p));
    Vec3 const centre_b = centre_of_b(scene, state, p);
    Sums sums;
    SideFrame frame[2];
    for (int which = 0; which < 2; ++which) {
      if (!active_on(sides[which])) continue;
      frame[which] = side_frame(p, which, share.of[which], sides[which]);
      elastic_pass(p, frame[which], law, parameters, centre_b, sums, out);
    }
    Vec3 const x = sums.force > 0 ? sums.point / sums.force : state.position[p.a];
    double const size = norm(out.elastic.force_on_a);
    Vec3 const n = size > 0 ? out.elastic.force_on_a / size : Vec3{0, 0, 1};
    double const mass = 1 / inverse_effective_mass(scene, state, kinematics, p, x, n);
    double const zeta = parameters.damping_nodes;
    double beta = sums.stiffness > 0 ? 2 * zeta * std::sqrt(mass / sums.stiffness) : 0;
    if (law.kind == ContactLaw::linear && sums.area > 0) {
      // p' of a few nodes in the onset is no measure of K: that of the smooth contact with this force and this mean
      // depth, half its overlap, is.
      double const depth = 2 * sums.depth / sums.area;
      double const smooth = sums.pressing * law.pressure(depth) / law.energy(depth);
      beta = sums.damping > 0 ? 2 * zeta * std::sqrt(mass * smooth) / sums.damping : 0;
      sums.stiffness = smooth > sums.stiffness ? smooth : sums.stiffness;  // for the critical step: nodes may move on
    }
    double const beta_t = sums.tangential > 0 ? 2 * zeta * std::sqrt(mass / sums.tangential) : 0;
    Vec3 pressing;  // normal force on a, with its damping [N]
    Mat3 const turn = mean_turn(kinematics, p, options.time_step);
    for (SideFrame const& f : frame)
      if (f.side >= 0) dissipative_pass(p, f, law, parameters, beta, beta_t, turn, centre_b, pressing, out);
    out.stiffness = sums.stiffness > sums.tangential ? sums.stiffness : sums.tangential;
    out.stiffness += sums.adhesive;
    out.damping_ratio = zeta;
    out.arm2_a = norm2(x - state.position[p.a]);
    out.arm2_b = p.with_plane() ? 0 : norm2(x - centre_b);
    if (rolling.on())
      resist_rolling(scene, kinematics, rolling, p, k, options.time_step, n, norm(pressing), sums.stiffness, out.arm2_a,
                     out.arm2_b);
    result[k] = out;
    in_contact[k] = 1;
  }
};

}  // namespace

void reduce_node_contacts(Queue const& queue, SceneView const& scene, StateView const& state, KinematicsView kinematics,
                          ContactOptions const& options, Span<const Pair> pair, Span<const char> closed_form,
                          NodeLists const& lists, ActiveNodes const& active, NodeHistory const& history,
                          NodeHistory& next, std::vector<NodeSample>& samples, RollingView const& rolling,
                          Span<PairResult> result, Span<char> in_contact) {
  int const sides = static_cast<int>(lists.side.size());
  if (scene.friction) {
    next.node = active.node;
    next.xi.resize(active.node.size());
    next.first.assign(active.first.begin(), active.first.begin() + sides);
    next.count.resize(sides);
    for (int s = 0; s < sides; ++s) next.count[s] = active.first[s + 1] - active.first[s];
  }
  samples.resize(active.node.size());
  parallel_for(queue, "contact_reduce/pairs", pair.size(),
               ReducePair{scene,
                          state,
                          kinematics,
                          options,
                          pair,
                          closed_form,
                          lists.side_of_pair,
                          active.first,
                          active.node,
                          active.sample.point,
                          active.sample.phi,
                          active.sample.gradient,
                          history.first,
                          history.count,
                          history.node,
                          history.xi,
                          next.xi,
                          samples,
                          rolling,
                          result,
                          in_contact},
               32);
}

}  // namespace scree

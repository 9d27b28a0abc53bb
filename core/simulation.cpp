// simulation.cpp: the step, a straight line, and what the host decides between steps. See simulation.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/deletion.h"
#include "core/effect_stages.h"
#include "core/energy.h"
#include "core/insertion.h"
#include "core/relax.h"
#include "core/simulation_impl.h"
#include "core/surroundings.h"
#include "core/travel.h"
#include "core/wall_motion.h"
#include "kernels/body_effects.h"
#include "kernels/integrate.h"

namespace scree {

Simulation::Impl::Impl(Case const& c_, SimulationOptions const& options_, Frame const* start)
    : c(c_), options(options_) {
  if (c.accuracy) throw InputError({"accuracy: node counts and step are not picked yet, see core/accuracy.h"});
  queue.threads = std::max(1, options.threads);
  queue.profile = &profile;
  Placement placement;
  scene = build_scene(c, queue.threads, placement);
  if (options.network_device) {
    options.network_device->load(scene.view(), scene.networks, c.device ? c.device->precision : Precision::fp32);
    scene.networks.device = options.network_device;
  }
  effects = effects_of(c, scene);
  if (std::vector<std::string> const found = load_problems(c, scene); !found.empty()) throw InputError(found);
  contacts.brute_force = options.brute_force;
  contacts.skin_steps = options.skin_steps.value_or(steps_a_skin);
  int const n = scene.bodies();
  estimate = estimate_critical_step(c, scene, placement);
  if (start) {
    if (start->position.size() != std::size_t(n))
      throw InputError({fmt::format("the starting frame has {} bodies, the case {}", start->position.size(), n)});
    placement = {start->position, start->velocity, start->spin, start->orientation};
  }
  state.position = placement.position;
  state.orientation = placement.orientation;
  state.velocity = placement.velocity;
  for (int i = 0; i < n; ++i) {
    Mat3 const r = to_matrix(state.orientation[i]);
    state.angular_momentum.push_back(r * multiply(scene.inertia[i], transposed_times(r, placement.spin[i])));
  }
  for (WallBody const& wall : scene.wall) {
    state.position.push_back(wall.position);
    state.orientation.push_back(wall.orientation);
    state.velocity.push_back({});
    state.angular_momentum.push_back({});
  }
  for (auto* v : {&state.work_damping, &state.work_friction}) v->assign(scene.solids(), 0);
  state.removed_by_damping.assign(n, 0);
  state.wall_work.assign(scene.wall.size(), 0);
  if (effects.force) state.work_applied.assign(n, 0);
  if (effects.rolling) state.work_rolling.assign(scene.solids(), 0);
  if (effects.drag) state.removed_by_drag.assign(n, 0);
  if (start && (effects.insertion || effects.deletion)) state.activity = start->activity;
  if (effects.insertion) start_insertion(c, scene, state);
  if (effects.deletion) start_deletion(c, scene, state);
  surroundings = surroundings_of(scene, state);
  work.external.assign(n, {});
  if (effects.gravity) apply_gravity(queue, scene.view(), *c.gravity, work.external);
  // Free flight needs no small step, but output does: at least a hundred steps a run.
  state.time_step =
      c.time.step ? *c.time.step : std::min({c.time.safety * estimate.critical, estimate.accurate, c.time.end / 100});
  if (c.relax && !start) messages.push_back(relax_overlaps(queue, c, scene, effects, contacts, state, work));
  evaluate_contacts(queue, scene, effects, contacts, 0, state, work);
  report = watch(queue, scene, state, gravity_size(), work);
  state.initial_energy = mechanical_energy(make_ledger(scene, c.gravity, state, work));
  state.kinetic_peak = report.kinetic_total;
  if (effects.measures) start_measurements(c, scene, work, state);
  profile.clear();  // the run's own steps are what is profiled
  counts_before = counts();
}

double Simulation::Impl::gravity_size() const {
  double const g = c.gravity ? norm(*c.gravity) : 0;
  return g > 0 ? g : 9.81;
}

RunState Simulation::Impl::step() {
  if (run_state != RunState::running) return run_state;
  SceneView const view = scene.view();
  double const dt = state.time_step;
  if (effects.insertion) insert_due(queue, c, scene, state, work, messages);
  WorkView const work_done{state.work_damping, state.work_friction, state.wall_work, state.work_applied,
                           state.work_rolling};
  if (effects.wall_motion) move_walls(dt);
  brake_bodies(queue, c, effects, view, dt / 2, state);
  if (effects.force) push_bodies(queue, c, scene, state.time, state.time + dt / 2, work);
  open_step(queue, view, state.view(), work.wrenches(state.wrench), dt, work_done);
  evaluate_contacts(queue, scene, effects, contacts, dt, state, work);
  if (effects.force) push_bodies(queue, c, scene, state.time + dt / 2, state.time + dt, work);
  close_step(queue, view, state.view(), work.wrenches(state.wrench), dt, work_done);
  if (state.damped && effects.settle_damping)
    apply_global_damping(queue, "global_damping/bodies", view, state.view(), c.time.settle->damping, dt,
                         state.removed_by_damping);
  brake_bodies(queue, c, effects, view, dt / 2, state);
  state.time += dt;
  ++state.step;
  if (effects.deletion) delete_leaving(queue, c, scene, state, work);
  report = watch(queue, scene, state, gravity_size(), work);
  state.kinetic_peak = std::max(state.kinetic_peak, report.kinetic_total);
  check_finite();
  check_time_step();
  check_travel();
  check_leaving();
  if (effects.settle) settle();
  if (run_state == RunState::running && state.time >= c.time.end * (1 - 1e-12)) run_state = RunState::ended;
  if (effects.measures) {
    ScopedTimer const timer(queue.profile, "measure/all", static_cast<int>(c.measure.size()));
    take_measurements(c, scene, work, dt, state, measure_cache, measure_rows);
    if (run_state != RunState::running) {
      measure_on_schedule = state.measure;
      take_last_measurements(c, scene, work, dt, state, measure_cache, measure_rows);
    }
  }
  if (run_state != RunState::running && effects.insertion) report_insertion(c, state, messages);
  if (run_state != RunState::running && effects.deletion) report_deletion(c, state, messages);
  check_overlap();  // last: the state it leaves behind is that of a whole step
  return run_state;
}

void Simulation::Impl::move_walls(double dt) {
  ScopedTimer const timer(queue.profile, "wall_motion/poses", static_cast<int>(scene.wall.size()));
  for (std::size_t w = 0; w < scene.wall.size(); ++w) {
    WallBody const& wall = scene.wall[w];
    if (!wall.motion) continue;
    std::size_t const i = scene.bodies() + w;
    WallPose const next = pose_at(*wall.motion, wall.position, wall.orientation, state.time + dt);
    double const turn = shift_at(*wall.motion, state.time + dt).angle - shift_at(*wall.motion, state.time).angle;
    state.velocity[i] = (next.position - state.position[i]) / dt;
    state.angular_momentum[i] = normalized(wall.motion->axis) * (turn / dt);
    state.position[i] = next.position;
    state.orientation[i] = next.orientation;
  }
}

void Simulation::Impl::stop(std::string const& what) const {
  throw WatchStop(fmt::format("stopped at t = {:.6g} s, step {}: {}", state.time, state.step, what));
}

void Simulation::Impl::check_finite() const {
  if (report.not_finite >= 0)
    stop(describe_body(scene, report.not_finite) + " has a position or velocity that is not finite");
}

void Simulation::Impl::check_overlap() const {
  if (report.depth > deepest_share)
    stop(
        fmt::format("{} are {:.3g} half thicknesses inside each other, above {} the contact would pull them through; a "
                    "smaller impact speed or a stiffer contact lets the run go on",
                    describe_pair(scene, c, work.pair[report.depth_pair]), report.depth, deepest_share));
  if (report.overlap > c.limits.overlap)
    stop(fmt::format("{} overlap by {:.3g} d, limits.overlap is {:.3g}. {}",
                     describe_pair(scene, c, work.pair[report.overlap_pair]), report.overlap, c.limits.overlap,
                     state.step == 1
                         ? "They start in each other: move them apart"
                         : "A smaller impact speed, a stiffer contact or a higher limit lets the run go on"));
}

void Simulation::Impl::check_leaving() {
  int const gone = first_outside(surroundings, scene, state);
  if (gone < 0) return;
  messages.push_back(
      fmt::format("t = {:.4g} s: {} has left the walls and all starting places far behind; nothing here will bring it "
                  "back, and [[delete]] can take such grains out",
                  state.time, describe_body(scene, gone)));
  surroundings = empty_box();
}

// Two bodies must not pass through each other between two steps.
void Simulation::Impl::check_travel() {
  if (!pairs_may_travel_far(scene, state)) return;
  PairTravel const travel = largest_pair_travel(scene, state, work.pair);
  if (!(travel.share > largest_travel)) return;
  std::string const pair = describe_pair(scene, c, work.pair[travel.pair]);
  if (c.time.step)
    stop(
        fmt::format("{} approach by {:.3g} half thicknesses of the thinner one in one time.step = {:.3g} s, above {} "
                    "they could pass through each other unseen; use step = \"auto\" or a smaller one",
                    pair, travel.share, state.time_step, largest_travel));
  while (largest_pair_travel(scene, state, work.pair).share > largest_travel) state.time_step /= 2;
  messages.push_back(fmt::format("t = {:.4g} s: {} meet too fast for their thickness, time step halved to {:.3g} s",
                                 state.time, pair, state.time_step));
}

void Simulation::Impl::check_time_step() {
  double const critical =
      critical_time_step(scene.view(), work.pair, work.result, work.in_contact, work.rolling, state.wrench.stiffness);
  double const share = state.time_step / critical;
  if (c.time.step) {
    // The user's step is the user's, up to where it cannot work.
    if (share > 0.5 && !warned_of_share) {
      messages.push_back(
          fmt::format("t = {:.4g} s: time.step is {:.2f} of the critical step {:.3g} s; above 0.5 the "
                      "energy ledger suffers",
                      state.time, share, critical));
      warned_of_share = true;
    }
    if (share > 1)
      throw WatchStop(
          fmt::format("stopped at t = {:.6g} s, step {}: time.step = {:.3g} s is {:.2f} of the critical step "
                      "{:.3g} s; use step = \"auto\" or a smaller one",
                      state.time, state.step, state.time_step, share, critical));
    return;
  }
  // The prediction missed: halve at once, never raise again (part of the state).
  if (share > 2 * c.time.safety || share > 0.8) {
    state.time_step /= 2;
    messages.push_back(fmt::format("t = {:.4g} s: contacts stiffer than predicted, time step halved to {:.3g} s",
                                   state.time, state.time_step));
  }
}

void Simulation::Impl::settle() {
  SettleCase const& s = *c.time.settle;
  if (state.time < s.after) return;
  bool const quiet = report.kinetic_largest <= s.kinetic_per_grain && all_inserted(c, state);
  if (!quiet) {
    state.damped = true;
    state.quiet_since = -1;
    return;
  }
  if (state.quiet_since < 0) {
    state.damped = false;  // rest has to hold by itself
    state.quiet_since = state.time;
  }
  if (state.time - state.quiet_since >= s.hold) run_state = RunState::at_rest;
}

Simulation::Simulation(Case const& c, SimulationOptions const& options)
    : impl_(std::make_unique<Impl>(c, options, nullptr)) {}
Simulation::Simulation(Case const& c, SimulationOptions const& options, Frame const& start)
    : impl_(std::make_unique<Impl>(c, options, &start)) {}
Simulation::~Simulation() = default;

RunState Simulation::step() { return impl_->step(); }
RunState Simulation::state() const { return impl_->run_state; }
double Simulation::time() const { return impl_->state.time; }
double Simulation::time_step() const { return impl_->state.time_step; }
std::int64_t Simulation::steps() const { return impl_->state.step; }
std::int64_t Simulation::own_steps() const { return impl_->state.step - impl_->first_step; }
int Simulation::bodies() const { return impl_->scene.bodies(); }
double Simulation::largest_overlap() const { return impl_->report.overlap; }
double Simulation::largest_kinetic_per_grain() const { return impl_->report.kinetic_largest; }
Profile const& Simulation::profile() const { return impl_->profile; }

std::string Simulation::phase() const {
  if (impl_->state.damped) return "settling";
  return impl_->state.quiet_since >= 0 ? "releasing" : "running";
}

LedgerRow Simulation::ledger() const { return make_ledger(impl_->scene, impl_->c.gravity, impl_->state, impl_->work); }

std::vector<Quantity> Simulation::measure_quantities(int measure) const {
  return quantities_of(impl_->c, impl_->scene, impl_->state, impl_->work, measure);
}

std::vector<MeasureRow> Simulation::measure_rows() { return std::exchange(impl_->measure_rows, {}); }

std::vector<MeasureSummary> Simulation::measure_summary() const {
  return summarise_measurements(impl_->c, impl_->scene, impl_->state, impl_->work);
}

std::vector<std::string> Simulation::messages() { return std::exchange(impl_->messages, {}); }

}  // namespace scree

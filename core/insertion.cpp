// insertion.cpp: see insertion.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/insertion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/free_spots.h"
#include "core/placement.h"
#include "kernels/base/profile.h"

namespace scree {
namespace {

// Draws a step for the grain at the head of the queue; it comes back at the next step, when the box has changed.
int constexpr tries_per_step = 100;

bool over_time(GrainsCase const& g) { return g.insert.kind == InsertCase::Kind::rate; }

// Grains that should be in at time t: the first at `start`, then one every 1 / rate.
int due_by(GrainsCase const& g, double t) {
  double const since = t - g.insert.start;
  if (since < 0) return 0;
  return static_cast<int>(std::min<double>(g.count, std::floor(since * g.insert.rate * (1 + 1e-12)) + 1));
}

double bounding_radius(Scene const& scene, int body) {
  return scene.shape[scene.shape_of[body]].bounding_radius * scene.diameter[body];
}

// Bounding spheres of the active bodies of a world that reach into the box.
SphereGrid occupied(Scene const& scene, State const& state, Box const& box, int world, double own_radius) {
  std::vector<int> near;
  double largest = own_radius;
  for (int i = 0; i < scene.bodies(); ++i) {
    if (!state.is_active(i) || scene.world(i) != world) continue;
    double const r = bounding_radius(scene, i);
    Vec3 const x = state.position[i];
    bool const reaches = x.x + r > box.min.x && x.y + r > box.min.y && x.z + r > box.min.z && x.x - r < box.max.x &&
                         x.y - r < box.max.y && x.z - r < box.max.z;
    if (!reaches) continue;
    near.push_back(i);
    largest = std::max(largest, r);
  }
  SphereGrid grid(largest);
  for (int const i : near) grid.add(state.position[i], bounding_radius(scene, i));
  return grid;
}

void activate(Case const& c, Scene const& scene, int body, Vec3 position, State& state) {
  state.position[body] = position;
  state.activity[body] = Activity::active;
  double const kinetic = kinetic_energy(scene.view(), state.view(), body);
  state.inserted_energy += kinetic - (c.gravity ? scene.mass[body] * dot(*c.gravity, position) : 0);
  state.exchanged_kinetic += kinetic;
}

}  // namespace

void start_insertion(Case const& c, Scene const& scene, State& state) {
  bool const fresh = state.activity.empty();
  if (fresh) state.activity.assign(scene.bodies(), Activity::active);
  std::vector<GrainEntry> const entries = entries_of(c);
  state.insertion.assign(entries.size(), {});
  for (std::size_t e = 0; e < entries.size(); ++e) {
    Insertion& in = state.insertion[e];
    in.random = random_stream(entries[e].seed, entries[e].group, Draw::places)();
    auto const first = state.activity.begin() + entries[e].first, end = first + entries[e].count;
    if (!over_time(c.grains[entries[e].group])) continue;
    if (fresh) std::fill(first, end, Activity::pending);
    in.done = entries[e].count - static_cast<int>(std::count(first, end, Activity::pending));
  }
}

void insert_due(Queue const& queue, Case const& c, Scene const& scene, State& state, Workspace& work,
                std::vector<std::string>& messages) {
  std::vector<GrainEntry> const entries = entries_of(c);
  for (std::size_t e = 0; e < entries.size(); ++e) {
    GrainsCase const& grains = c.grains[entries[e].group];
    int const first = entries[e].first;
    Insertion& in = state.insertion[e];
    if (!over_time(grains) || in.done >= due_by(grains, state.time)) continue;
    int const due = due_by(grains, state.time);
    ScopedTimer const timer(queue.profile, "insertion/places", due - in.done);
    Box const& box = grains.insert.box;
    double own = 0;
    for (int k = in.done; k < due; ++k) own = std::max(own, bounding_radius(scene, first + k));
    SphereGrid grid = occupied(scene, state, box, scene.world(first), own);
    while (in.done < due) {
      int const body = first + in.done;
      double const own_radius = bounding_radius(scene, body);
      // Out of the reach of cohesion, too: a bond from nothing would be energy from nowhere.
      double const radius = own_radius + scene.cohesion_margin;
      std::optional<Vec3> const spot = find_free_spot(
          box, radius, grid, WallClearance(scene, state.position, state.orientation), tries_per_step, in.random);
      if (!spot) break;
      activate(c, scene, body, *spot, state);
      grid.add(*spot, own_radius);
      work.built_position.clear();
      ++in.done;
    }
    if (in.done < due && in.blocked_since < 0) {
      in.blocked_since = state.time;
      // Said once, counted from then on: a hopper that runs full blocks at every other grain.
      if (++in.blocked_times > 1) continue;
      messages.push_back(
          fmt::format("t = {:.4g} s: insertion of {} is blocked: grain {} finds no free place in its box; it "
                      "is tried again "
                      "at every step",
                      state.time, name_of(c, entries[e]), in.done + 1));
    } else if (in.done >= due && in.blocked_since >= 0) {
      in.blocked_seconds += state.time - in.blocked_since;
      in.blocked_since = -1;
    }
  }
}

bool all_inserted(Case const& c, State const& state) {
  for (std::size_t e = 0; e < state.insertion.size(); ++e) {
    GrainsCase const& grains = c.grains[e % c.grains.size()];
    if (over_time(grains) && state.insertion[e].done < grains.count) return false;
  }
  return true;
}

void report_insertion(Case const& c, State const& state, std::vector<std::string>& messages) {
  std::vector<GrainEntry> const entries = entries_of(c);
  for (std::size_t e = 0; e < entries.size(); ++e) {
    GrainsCase const& grains = c.grains[entries[e].group];
    Insertion const& in = state.insertion[e];
    if (!over_time(grains)) continue;
    bool const blocked = in.blocked_since >= 0;
    double const seconds = in.blocked_seconds + (blocked ? state.time - in.blocked_since : 0);
    std::string const waits =
        fmt::format("blocked {} time{}, {:.3g} s in all", in.blocked_times, in.blocked_times == 1 ? "" : "s", seconds);
    if (in.done < grains.count)
      messages.push_back(
          fmt::format("{}: {} of {} are not inserted; {}", name_of(c, entries[e]), grains.count - in.done, grains.count,
                      blocked ? waits + ": a larger box, a lower rate or a way out of the box lets them in"
                              : fmt::format("at {} a second they need more time", grains.insert.rate)));
    else if (in.blocked_times > 0)
      messages.push_back(fmt::format("{}: insertion was {}", name_of(c, entries[e]), waits));
  }
}

std::vector<std::string> insertion_notes(Case const& c) {
  std::vector<std::string> notes;
  for (GrainsCase const& g : c.grains) {
    if (!over_time(g) || g.count == 0) continue;
    double const last = g.insert.start + (g.count - 1) / g.insert.rate;
    notes.push_back(
        fmt::format("grains '{}': {} inserted from t = {:.4g} s to {:.4g} s", g.name, g.count, g.insert.start, last));
    if (last > c.time.end)
      notes.back() += fmt::format(", beyond time.end = {:.4g} s: {} get in", c.time.end, due_by(g, c.time.end));
  }
  return notes;
}

}  // namespace scree

// restart.cpp: taking a checkpoint of a Simulation, and going on from one. See simulation.h and checkpoint.h.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "core/case_identity.h"
#include "core/checkpoint.h"
#include "core/grain_entries.h"
#include "core/simulation_impl.h"
#include "core/state_members.h"

namespace scree {
namespace {

[[noreturn]] void refuse(std::string const& what) { throw InputError({"the checkpoint " + what}); }

[[noreturn]] void refuse_content(std::string const& what) {
  refuse("contradicts itself: " + what + "; an older checkpoint, or --force, starts the run");
}

void require_same_case(Case const& c, Scene const& scene, Checkpoint const& checkpoint) {
  std::string const difference = first_difference(checkpoint.identity, case_identity(c));
  if (!difference.empty())
    refuse("is of another case. " + difference +
           ". Only time.end, [output], [checkpoint], limits.overlap and limits.ledger may change");
  if (checkpoint.inputs != inputs_hash(c, scene))
    refuse(
        "is of other files: a shape library, a mesh or a table that the case reads is not what it was when the run "
        "began");
  // The clock runs over the end by less than a step.
  if (checkpoint.state.time > c.time.end + checkpoint.state.time_step)
    refuse(fmt::format("is of t = {:.6g} s, after time.end = {:.6g} s", checkpoint.state.time, c.time.end));
}

// Arrays with an entry a pair or a node, and couples, which are not there while no pair is; all others are as long as
// those of the new run.
bool follows_pairs(std::string const& name) {
  return name.find("_history_") != std::string::npos || name == "wrench_rolling";
}

void require_same_sizes(State const& fresh, State const& saved) {
  std::vector<std::pair<std::string, std::size_t>> expected;
  for_each_member(fresh, [&](char const* name, auto const& member) {
    if constexpr (!std::is_arithmetic_v<std::remove_cvref_t<decltype(member)>>)
      expected.push_back({name, member.size()});
  });
  std::size_t at = 0;
  for_each_member(saved, [&](char const* name, auto const& member) {
    if constexpr (!std::is_arithmetic_v<std::remove_cvref_t<decltype(member)>>)
      if (auto const& [known, size] = expected[at++]; !follows_pairs(known) && member.size() != size)
        refuse_content(fmt::format("'{}' has {} entries where the case has {}", name, member.size(), size));
  });
}

template <class T>
bool all_finite(T const& value) {
  if constexpr (std::is_same_v<T, std::vector<Vec3>> || std::is_same_v<T, std::vector<Quat>> ||
                std::is_same_v<T, std::vector<Wrench>> || std::is_same_v<T, std::vector<double>>) {
    auto const* const number = reinterpret_cast<double const*>(value.data());
    return std::all_of(number, number + value.size() * sizeof(value[0]) / sizeof(double),
                       [](double v) { return std::isfinite(v); });
  } else if constexpr (std::is_same_v<T, double>) {
    return std::isfinite(value);
  }
  return true;
}

// What no step leaves behind. A state that a watch stopped because it was not finite is refused here.
void require_sound_numbers(Case const& c, State const& fresh, State const& saved) {
  for_each_member(saved, [](char const* name, auto const& member) {
    if (!all_finite(member))
      refuse(fmt::format("holds a number in '{}' that is not finite: nothing can go on from there", name));
  });
  for (Quat const& q : saved.orientation)
    if (!(std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-3))
      refuse_content("an orientation is no rotation");
  if (!(saved.time >= 0 && saved.step >= 0 && saved.time_step > 0 &&
        saved.time_step <= std::max(c.time.end, fresh.time_step)))
    refuse_content("time, step or time step");
  std::vector<GrainEntry> const entries = entries_of(c);
  for (std::size_t e = 0; e < saved.insertion.size(); ++e)
    if (saved.insertion[e].done < 0 || saved.insertion[e].done > entries.at(e).count)
      refuse_content("grains that were inserted");
}

void require_sound_measures(State const& fresh, State const& saved) {
  for (std::size_t k = 0; k < fresh.measure.size(); ++k) {
    std::size_t const memory = fresh.measure[k].memory.size();  // 0: not before the first sample
    if (memory > 0 && saved.measure[k].memory.size() != memory)
      refuse_content(fmt::format("[[measure]] entry {} remembers {} numbers where the case has {}", k,
                                 saved.measure[k].memory.size(), memory));
    if (saved.measure[k].moments.size() != fresh.measure[k].moments.size())
      refuse_content(fmt::format("[[measure]] entry {} has {} quantities where the case has {}", k,
                                 saved.measure[k].moments.size(), fresh.measure[k].moments.size()));
  }
}

void require_sound_pairs(Scene const& scene, Effects const& effects, PairMemory const& p, State const& s) {
  std::size_t const n = p.pair.size();
  int const planes = static_cast<int>(scene.plane.size());
  for (Pair const& k : p.pair)
    if (k.a < 0 || k.a >= scene.bodies() || k.b >= scene.solids() || k.b < -planes || (k.b >= 0 && k.b <= k.a))
      refuse_content(fmt::format("it pairs bodies {} and {}", k.a, k.b));
  std::size_t const built = p.built_position.size();
  if ((built != 0 && built != std::size_t(scene.solids())) || p.built_orientation.size() != built ||
      !all_finite(p.built_position) || !all_finite(p.built_orientation))
    refuse_content("poses of the pair list");
  auto const of_pairs = [&](auto const& v, bool wanted) { return v.size() == (wanted ? n : 0); };
  bool const spheres = effects.friction && effects.sphere_contacts;
  bool const sound = of_pairs(p.energy_normal, true) && of_pairs(p.energy_tangential, true) &&
                     of_pairs(p.overlap, true) && of_pairs(p.energy_rolling, effects.rolling) &&
                     of_pairs(s.rolling_history.angle, effects.rolling) &&
                     of_pairs(s.rolling_history.stiffness, effects.rolling) &&
                     (!spheres || (of_pairs(s.sphere_history.xi, true) && of_pairs(s.sphere_history.stiffness, true)));
  if (!sound) refuse_content("arrays of pairs");
  if (!s.wrench.rolling.empty() && s.wrench.rolling.size() != std::size_t(effects.rolling ? scene.solids() : 0))
    refuse_content("couples of rolling resistance");
  NodeHistory const& h = s.node_history;
  if (h.first.size() != p.side.size() || h.count.size() != p.side.size() || h.xi.size() != h.node.size())
    refuse_content("contact history");
  for (std::size_t i = 0; i < p.side.size(); ++i)
    if (p.side[i] < 0 || std::size_t(p.side[i]) >= 2 * n || h.first[i] < 0 || h.count[i] < 0 ||
        std::size_t(h.first[i]) + std::size_t(h.count[i]) > h.node.size())
      refuse_content("contact history");
}

// The history's ranges in the order of the sides of this run's node lists.
void assign_history(std::vector<int> const& saved_side, std::vector<int> const& side_of_pair, std::size_t sides,
                    NodeHistory& history) {
  std::vector<int> first(sides, 0), count(sides, 0);
  for (std::size_t i = 0; i < saved_side.size(); ++i) {
    int const s = side_of_pair[saved_side[i]];
    if (s < 0) refuse_content("contact history of nodes that do not exist");
    first[s] = history.first[i];
    count[s] = history.count[i];
  }
  history.first = std::move(first);
  history.count = std::move(count);
}

}  // namespace

Checkpoint Simulation::checkpoint() const {
  Impl const& s = *impl_;
  Checkpoint out;
  out.identity = case_identity(s.c);
  out.inputs = inputs_hash(s.c, s.scene);
  out.state = s.state;
  if (s.run_state != RunState::running) out.state.measure = s.measure_on_schedule;
  PairMemory& p = out.pairs;
  p.pair = s.work.pair;
  p.built_position = s.work.built_position;
  if (!p.built_position.empty()) p.built_orientation = s.work.built_orientation;
  for (PairResult const& r : s.work.result) {
    p.energy_normal.push_back(r.energy_normal);
    p.energy_tangential.push_back(r.energy_tangential);
    p.overlap.push_back(r.overlap);
  }
  for (RollingResult const& r : s.work.rolling) p.energy_rolling.push_back(r.energy);
  if (!s.state.node_history.first.empty())
    for (Side const& side : s.work.gather.lists.side)
      p.side.push_back(2 * side.pair + (side.carrier == s.work.pair[side.pair].a ? 0 : 1));
  out.at_rest = s.run_state == RunState::at_rest;
  out.warned_of_share = s.warned_of_share;
  return out;
}

void Simulation::restore(Checkpoint const& checkpoint) {
  Impl& s = *impl_;
  require_same_case(s.c, s.scene, checkpoint);
  require_same_sizes(s.state, checkpoint.state);
  require_sound_numbers(s.c, s.state, checkpoint.state);
  require_sound_measures(s.state, checkpoint.state);
  require_sound_pairs(s.scene, s.effects, checkpoint.pairs, checkpoint.state);
  State state = checkpoint.state;
  restore_pairs(s.scene, checkpoint.pairs.pair, checkpoint.pairs.built_position, checkpoint.pairs.built_orientation,
                s.work);
  NodeLists const& lists = s.work.gather.lists;
  bool const remembers = s.effects.friction && s.effects.node_contacts;
  if (checkpoint.pairs.side.size() != (remembers ? lists.side.size() : 0)) refuse_content("contact history");
  if (!checkpoint.pairs.side.empty())
    assign_history(checkpoint.pairs.side, lists.side_of_pair, lists.side.size(), state.node_history);
  // Samples of measurements without a key of their own follow output.every.
  if (checkpoint.output.every != s.c.output.every)
    for (std::size_t k = 0; k < state.measure.size(); ++k)
      if (!s.c.measure[k].every)
        state.measure[k].next = static_cast<std::int64_t>(std::floor(state.time / s.c.output.every)) + 1;
  s.state = std::move(state);
  s.work.in_contact.assign(s.work.pair.size(), 1);  // until the next step finds out
  for (std::size_t k = 0; k < s.work.pair.size(); ++k) {
    s.work.result[k].energy_normal = checkpoint.pairs.energy_normal[k];
    s.work.result[k].energy_tangential = checkpoint.pairs.energy_tangential[k];
    s.work.result[k].overlap = checkpoint.pairs.overlap[k];
  }
  s.work.rolling.assign(checkpoint.pairs.energy_rolling.size(), {});
  for (std::size_t k = 0; k < s.work.rolling.size(); ++k) s.work.rolling[k].energy = checkpoint.pairs.energy_rolling[k];
  s.report = watch(s.queue, s.scene, s.state, s.gravity_size(), s.work);
  s.warned_of_share = checkpoint.warned_of_share;
  s.run_state = checkpoint.at_rest                           ? RunState::at_rest
                : s.state.time >= s.c.time.end * (1 - 1e-12) ? RunState::ended
                                                             : RunState::running;
  s.first_step = s.state.step;
  s.measure_on_schedule = s.state.measure;
  s.messages.clear();
  s.profile.clear();
}

}  // namespace scree

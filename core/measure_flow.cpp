// measure_flow.cpp: see measure_flow.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/measure_flow.h"

#include <algorithm>

#include "core/measure_region.h"

namespace scree {
namespace {

// What the memory of a flow holds; the grains' sides of the plane follow (0: not seen yet, -1 before it, 1 behind it).
enum Slot { seconds, mass, number, mass_before, number_before, sides };

double side_of(MeasureCase const& m, Vec3 x) { return dot(*m.normal, x - *m.point) >= 0 ? 1 : -1; }

// Which way each grain went in this step: work(body, +1 out or -1 back).
template <class Work>
void each_crossing(MeasureView const& view, Memory& memory, std::size_t first, Work const& work) {
  MeasureCase const& m = view.measure;
  for (int i = 0; i < view.scene.bodies(); ++i) {
    if (!view.state.is_active(i)) continue;
    Vec3 const x = view.state.position[i];
    double const now = side_of(m, x);
    double& before = memory[first + i];
    bool const crossed = before != 0 && before != now;
    before = now;
    if (crossed && !(m.radius && norm(x - *m.point) > *m.radius)) work(i, now);
  }
}

int delete_index(MeasureView const& view) {
  for (std::size_t k = 0; k < view.c.deletion.size(); ++k)
    if (view.c.deletion[k].name == view.measure.deletion) return static_cast<int>(k);
  return -1;
}

}  // namespace

std::vector<Quantity> discharge_quantities(MeasureView const&) {
  return {{"mass_rate", "kg/s"}, {"number_rate", "1/s"}, {"mass", "kg"}, {"number", "-"}};
}

std::string check_discharge(Case const&, MeasureCase const& m) {
  bool const plane = m.point && m.normal;
  if (plane == !m.deletion.empty() || m.point.has_value() != m.normal.has_value())
    return "needs a plane (point and normal) or the name of a [[delete]] entry, one of both";
  return "";
}

void visit_discharge(MeasureView const& view, double dt, Memory& memory) {
  bool const plane = view.measure.deletion.empty();
  if (memory.empty()) memory.assign(sides + (plane ? view.scene.bodies() : 0), 0);
  memory[seconds] += dt;
  auto const count = [&](int i, double way) {
    memory[mass] += way * view.scene.mass[i];
    memory[number] += way;
  };
  if (plane) return each_crossing(view, memory, sides, count);
  int const entry = delete_index(view);
  if (view.work.leaving.empty()) return;  // before the first step
  for (int i = 0; i < view.scene.bodies(); ++i)
    if (view.work.leaving[i] == entry) count(i, 1);
}

Values sample_discharge(MeasureView const&, Memory& memory) {
  Values const out{(memory[mass] - memory[mass_before]) / memory[seconds],
                   (memory[number] - memory[number_before]) / memory[seconds], memory[mass], memory[number]};
  memory[seconds] = 0;
  memory[mass_before] = memory[mass];
  memory[number_before] = memory[number];
  return out;
}

std::vector<Quantity> blockage_quantities(MeasureView const&) {
  return {{"blocked", "-"}, {"count", "-"}, {"seconds", "s"}, {"longest", "s"}};
}

void visit_blockage(MeasureView const& view, double dt, Memory& memory) {
  enum { last_flow, blocked, count, total, longest, sides_of_plane };
  State const& state = view.state;
  if (memory.empty()) {
    memory.assign(sides_of_plane + view.scene.bodies(), 0);
    memory[last_flow] = state.time - dt;
  }
  bool flows = state.time < view.measure.from;
  each_crossing(view, memory, sides_of_plane, [&](int, double way) { flows = flows || way > 0; });
  MeasureRegion const region(view.measure);
  bool remains = false;
  for (int i = 0; i < view.scene.bodies() && !remains; ++i)
    remains = state.is_active(i) && memory[sides_of_plane + i] < 0 && region.contains(state.position[i]);
  double const wait = state.time - memory[last_flow];
  if (remains && !flows) {
    memory[longest] = std::max(memory[longest], wait);
    if (wait > *view.measure.longer_than) {
      memory[total] += memory[blocked] > 0 ? dt : wait;
      memory[count] += memory[blocked] > 0 ? 0 : 1;
      memory[blocked] = 1;
    }
    return;
  }
  memory[blocked] = 0;
  memory[last_flow] = state.time;
}

Values sample_blockage(MeasureView const&, Memory& memory) { return {memory.begin() + 1, memory.begin() + 5}; }

}  // namespace scree

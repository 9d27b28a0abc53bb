// measurements.cpp: see measurements.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/measurements.h"

#include <cmath>

namespace scree {
namespace {

// Welford's update: no loss of digits when the spread is small beside the mean.
void add(double value, bool counts, Moments& m) {
  m.last = value;
  if (!counts || !std::isfinite(value)) return;
  ++m.samples;
  double const step = value - m.mean;
  m.mean += step / static_cast<double>(m.samples);
  m.squares += step * (value - m.mean);
}

void take_sample(MeasureView const& view, int measure, double dt, Measurement& own, std::vector<MeasureRow>& rows) {
  MeasureCase const& m = view.measure;
  double const time = view.state.time, slack = dt / 2;  // samples stand at the nearest step
  own.last_time = time;
  rows.push_back({measure, time, measure_kind(m.kind).sample(view, own.memory),
                  m.contacts ? contacts_of(view) : std::vector<ContactRow>{}});
  bool const counts = time >= m.from - slack && (!m.until || time <= *m.until + slack);
  for (std::size_t q = 0; q < own.moments.size(); ++q) add(rows.back().value[q], counts, own.moments[q]);
}

}  // namespace

std::vector<Quantity> quantities_of(Case const& c, Scene const& scene, State const& state, Workspace const& work,
                                    int measure) {
  MeasureCache none;
  MeasureCase const& m = c.measure[measure];
  return measure_kind(m.kind).quantities({m, c, scene, state, work, none});
}

void start_measurements(Case const& c, Scene const& scene, Workspace const& work, State& state) {
  state.measure.assign(c.measure.size(), {});
  MeasureCache none;
  for (std::size_t k = 0; k < c.measure.size(); ++k) {
    Measurement& own = state.measure[k];
    MeasureCase const& m = c.measure[k];
    MeasureKind const& kind = measure_kind(m.kind);
    own.moments.resize(quantities_of(c, scene, state, work, static_cast<int>(k)).size());
    // Where everything is before the first step: no crossing is missed, a release is where it was.
    if (kind.visit) kind.visit({m, c, scene, state, work, none}, 0, own.memory);
  }
}

void take_measurements(Case const& c, Scene const& scene, Workspace const& work, double dt, State& state,
                       MeasureCache& cache, std::vector<MeasureRow>& rows) {
  for (std::size_t k = 0; k < c.measure.size(); ++k) {
    MeasureCase const& m = c.measure[k];
    MeasureKind const& kind = measure_kind(m.kind);
    Measurement& own = state.measure[k];
    MeasureView const view{m, c, scene, state, work, cache};
    if (kind.visit) kind.visit(view, dt, own.memory);
    double const every = m.every.value_or(c.output.every);
    if (state.time + dt / 2 < static_cast<double>(own.next) * every) continue;
    own.next = static_cast<std::int64_t>(std::floor((state.time + dt / 2) / every)) + 1;
    take_sample(view, static_cast<int>(k), dt, own, rows);
  }
}

void take_last_measurements(Case const& c, Scene const& scene, Workspace const& work, double dt, State& state,
                            MeasureCache& cache, std::vector<MeasureRow>& rows) {
  for (std::size_t k = 0; k < c.measure.size(); ++k) {
    MeasureCase const& m = c.measure[k];
    Measurement& own = state.measure[k];
    // The run may end one step after a sample; and a short rest of an interval is no fair sample of a rate.
    double const least = measure_kind(m.kind).interval ? m.every.value_or(c.output.every) / 2 : 1.5 * dt;
    if (!(state.time - own.last_time > least)) continue;
    take_sample({m, c, scene, state, work, cache}, static_cast<int>(k), dt, own, rows);
    rows.back().off_schedule = true;
  }
}

std::vector<MeasureSummary> summarise_measurements(Case const& c, Scene const& scene, State const& state,
                                                   Workspace const& work) {
  std::vector<MeasureSummary> out;
  for (std::size_t k = 0; k < state.measure.size(); ++k) {
    MeasureCase const& m = c.measure[k];
    std::vector<Quantity> const quantities = quantities_of(c, scene, state, work, static_cast<int>(k));
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      Moments const& moments = state.measure[k].moments[q];
      MeasureSummary s{m.name + "." + quantities[q].name, quantities[q].unit, m.from > 0 || m.until};
      s.samples = moments.samples;
      if (s.samples > 0) s.mean = moments.mean;
      if (s.samples > 1) s.spread = std::sqrt(moments.squares / static_cast<double>(s.samples - 1));
      s.last = moments.last;
      out.push_back(s);
    }
  }
  return out;
}

}  // namespace scree

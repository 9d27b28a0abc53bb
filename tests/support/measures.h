// measures.h: measurements of small cases, for tests.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "core/simulation.h"
#include "tests/support/cases.h"

namespace scree::testing {

inline MeasureCase measure(std::string const& name, std::string const& kind) {
  MeasureCase m;
  m.name = name;
  m.kind = kind;
  return m;
}

// A motion that begins after the tests: it makes a body of a wall that stands still.
inline MotionCase later() {
  MotionCase m;
  m.kind = MotionKind::translation;
  m.velocity = {1, 0, 0};
  m.start = 1e6;
  return m;
}

using Measured = std::map<std::string, MeasureSummary>;  // by "measure.quantity"

inline Measured measured(Simulation const& s) {
  Measured out;
  for (MeasureSummary const& m : s.measure_summary()) out[m.name] = m;
  return out;
}

inline Measured run_to_end(Simulation& s) {
  while (s.step() == RunState::running) {
  }
  return measured(s);
}

// Values after one step so short that nothing has moved.
inline Measured measured_at_once(Case c) {
  c.time.step = 1e-12;
  c.time.end = 1e-12;
  c.output.every = 1e-12;
  Simulation s(c, {});
  return run_to_end(s);
}

}  // namespace scree::testing

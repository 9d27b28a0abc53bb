// course.h: follows a run to its end and keeps the figures that every hard case reports.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "core/energy.h"
#include "core/simulation_impl.h"
#include "tests/support/cases.h"
#include "tests/validation/book.h"

namespace scree::book {

struct Course {
  double overlap = 0;   // worst at the nodes [d]
  double depth = 0;     // worst, in half thicknesses of the body that the node is in
  double gain = 0;      // most that mechanical energy exceeded its start and what was put in [J]
  double residual = 0;  // what the ledger cannot account for at the end [J]
  double moved = 0;     // energy moved [J]
  double kinetic = 0;   // largest of a grain at the end [m g d]
  bool finite = true;
  std::string stopped;  // why the watch stopped the run; empty: it did not
  std::string said;     // messages

  double gained() const { return moved > 0 ? gain / moved : 0; }
  double unaccounted() const { return moved > 0 ? std::abs(residual) / moved : 0; }
};

inline Course follow(Simulation& s, std::function<void()> const& after_step = {}) {
  Course out;
  double const start = mechanical_energy(s.ledger());
  try {
    while (s.step() == RunState::running) {
      out.overlap = std::max(out.overlap, s.largest_overlap());
      out.depth = std::max(out.depth, s.impl().report.depth);
      LedgerRow const row = s.ledger();
      out.gain = std::max(out.gain, mechanical_energy(row) - start - row.inserted - row.wall_work - row.applied);
      if (after_step) after_step();
    }
  } catch (WatchStop const& stop) {
    out.stopped = stop.what();
    out.overlap = std::max(out.overlap, s.largest_overlap());
    out.depth = std::max(out.depth, s.impl().report.depth);
  }
  LedgerRow const row = s.ledger();
  out.residual = row.residual, out.moved = row.moved;
  out.kinetic = s.largest_kinetic_per_grain();
  Frame const f = s.frame();
  for (std::size_t i = 0; i < f.position.size(); ++i)
    out.finite = out.finite && is_finite(f.position[i]) && is_finite(f.velocity[i]) && is_finite(f.spin[i]);
  for (std::string const& line : s.messages()) out.said += line + "\n";
  return out;
}

inline bool says(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

// Rows that hold for every run that is not meant to be stopped.
inline void add_sound_rows(Entry& book, std::string const& which, Course const& c, double gain, double ledger) {
  EXPECT_EQ(c.stopped, "") << which;
  EXPECT_TRUE(c.finite) << which;
  book.at_most(which + ": energy gained, of the energy moved", "", c.gained(), gain);
  book.at_most(which + ": not accounted for, of the energy moved", "", c.unaccounted(), ledger);
}

}  // namespace scree::book

// scree_measures.cpp: see scree_measures.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/scree_measures.h"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

namespace scree {

MeasureLog::MeasureLog(OutputFolder const& folder, Case const& c, Simulation const& simulation) {
  if (c.measure.empty()) return;
  for (std::size_t k = 0; k < c.measure.size(); ++k) {
    prefix_.push_back("," + c.measure[k].name + ",");
    quantities_.push_back(simulation.measure_quantities(static_cast<int>(k)));
  }
  file_.open(folder.file("measures.csv"));
  file_ << "time,name,quantity,value\n";
}

void MeasureLog::write(Simulation& simulation) {
  if (prefix_.empty()) return;
  std::vector<MeasureRow> const rows = simulation.measure_rows();
  for (MeasureRow const& row : rows)
    for (std::size_t q = 0; q < row.value.size(); ++q)
      file_ << fmt::format("{:.9g}{}{},{:.9g}\n", row.time, prefix_[row.measure], quantities_[row.measure][q].name,
                           row.value[q]);
  if (!rows.empty()) file_ << std::flush;
  if (!file_) throw std::system_error(EIO, std::generic_category(), "measures.csv: cannot be written");
}

std::string measure_table(std::vector<MeasureSummary> const& measures) {
  std::string out =
      fmt::format("{:<36} {:>6} {:>8} {:>13} {:>13} {:>13}\n", "measured", "unit", "samples", "mean", "spread", "last");
  for (MeasureSummary const& m : measures)
    out += fmt::format("{:<36} {:>6} {:>8} {:>13.6g} {:>13.3g} {:>13.6g}\n", m.name, m.unit, m.samples, m.mean,
                       m.spread, m.last);
  return out;
}

}  // namespace scree

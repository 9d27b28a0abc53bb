// scree_measures.cpp: see scree_measures.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/scree_measures.h"

#include <fmt/format.h>

#include <algorithm>

namespace scree {

namespace {

// A new file with its first line, or an old one cut where it was at the checkpoint.
AppendedFile open_csv(std::filesystem::path const& file, std::int64_t const* keep, char const* columns) {
  AppendedFile out(file, keep ? *keep : 0);
  if (!keep) out.append(columns);
  return out;
}

}  // namespace

MeasureLog::MeasureLog(OutputFolder const& folder, Case const& c, Simulation const& simulation,
                       OutputProgress const* earlier) {
  if (c.measure.empty()) return;
  for (std::size_t k = 0; k < c.measure.size(); ++k) {
    prefix_.push_back("," + c.measure[k].name + ",");
    quantities_.push_back(simulation.measure_quantities(static_cast<int>(k)));
  }
  file_ =
      open_csv(folder.file("measures.csv"), earlier ? &earlier->measures_bytes : nullptr, "time,name,quantity,value\n");
  if (std::any_of(c.measure.begin(), c.measure.end(), [](MeasureCase const& m) { return m.contacts; }))
    contacts_ = open_csv(folder.file("contacts.csv"), earlier ? &earlier->contacts_bytes : nullptr,
                         "time,name,a,b,x,y,z,fx,fy,fz\n");
}

void MeasureLog::note_sizes(OutputProgress& out) const {
  out.measures_bytes = on_schedule_ ? on_schedule_->measures_bytes : file_.size();
  out.contacts_bytes = on_schedule_ ? on_schedule_->contacts_bytes : contacts_.size();
}

void MeasureLog::write(Simulation& simulation) {
  if (prefix_.empty()) return;
  std::vector<MeasureRow> const rows = simulation.measure_rows();
  for (MeasureRow const& row : rows) {
    if (row.off_schedule && !on_schedule_) {
      OutputProgress sizes;
      note_sizes(sizes);
      on_schedule_ = sizes;
    }
    std::string values, contacts;
    for (std::size_t q = 0; q < row.value.size(); ++q)
      values += fmt::format("{:.9g}{}{},{:.9g}\n", row.time, prefix_[row.measure], quantities_[row.measure][q].name,
                            row.value[q]);
    for (ContactRow const& k : row.contact)
      contacts +=
          fmt::format("{:.9g}{}{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", row.time, prefix_[row.measure], k.a,
                      k.b, k.point.x, k.point.y, k.point.z, k.force.x, k.force.y, k.force.z);
    file_.append(values);
    if (contacts_.is_open()) contacts_.append(contacts);
  }
}

std::string figures_csv(std::vector<MeasureSummary> const& measures) {
  std::string out = "name,unit,of,value,samples,mean,spread,last\n";
  for (MeasureSummary const& m : measures)
    out += fmt::format("{},{},{},{:.9g},{},{:.9g},{:.9g},{:.9g}\n", m.name, m.unit, m.windowed ? "mean" : "last",
                       m.value(), m.samples, m.mean, m.spread, m.last);
  return out;
}

std::string check_table(std::vector<FigureCheck> const& checks, bool& all_ok) {
  std::string out = fmt::format("{:<36} {:>6} {:>5} {:>13} {:>13} {:>13}\n", "figure", "unit", "of", "expected",
                                "measured", "allowed");
  all_ok = true;
  for (FigureCheck const& c : checks) {
    out += fmt::format("{:<36} {:>6} {:>5} {:>13.6g} {:>13.6g} {:>13.3g}  {}\n", c.expected.name, c.unit,
                       c.expected.mean ? "mean" : "last", c.expected.value, c.measured, c.expected.tolerance,
                       c.ok ? "ok" : "OUTSIDE");
    all_ok = all_ok && c.ok;
  }
  return out;
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

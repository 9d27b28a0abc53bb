// scree_measures.cpp: see scree_measures.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/scree_measures.h"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

namespace scree {

namespace {

// Opens a new file with its first line, or cuts an old one where it was at the checkpoint.
void open_csv(std::filesystem::path const& file, std::int64_t const* keep, char const* columns, std::ofstream& stream) {
  if (keep) std::filesystem::resize_file(file, static_cast<std::uintmax_t>(*keep));
  stream.open(file, keep ? std::ios::binary | std::ios::app : std::ios::binary | std::ios::out);
  if (!keep) stream << columns;
}

}  // namespace

MeasureLog::MeasureLog(OutputFolder const& folder, Case const& c, Simulation const& simulation,
                       OutputProgress const* earlier) {
  if (c.measure.empty()) return;
  for (std::size_t k = 0; k < c.measure.size(); ++k) {
    prefix_.push_back("," + c.measure[k].name + ",");
    quantities_.push_back(simulation.measure_quantities(static_cast<int>(k)));
  }
  open_csv(folder.file("measures.csv"), earlier ? &earlier->measures_bytes : nullptr, "time,name,quantity,value\n",
           file_);
  for (MeasureCase const& m : c.measure)
    if (m.contacts && !contacts_.is_open()) {
      open_csv(folder.file("contacts.csv"), earlier ? &earlier->contacts_bytes : nullptr,
               "time,name,a,b,x,y,z,fx,fy,fz\n", contacts_);
    }
}

void MeasureLog::note_sizes(OutputProgress& out) {
  if (on_schedule_) {
    out.measures_bytes = on_schedule_->measures_bytes;
    out.contacts_bytes = on_schedule_->contacts_bytes;
    return;
  }
  // A stream that appends knows its place after the first write only.
  auto const size = [](std::ofstream& stream) {
    if (!stream.is_open()) return std::int64_t{0};
    stream.seekp(0, std::ios::end);
    return static_cast<std::int64_t>(stream.tellp());
  };
  out.measures_bytes = size(file_);
  out.contacts_bytes = size(contacts_);
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
    for (std::size_t q = 0; q < row.value.size(); ++q)
      file_ << fmt::format("{:.9g}{}{},{:.9g}\n", row.time, prefix_[row.measure], quantities_[row.measure][q].name,
                           row.value[q]);
    for (ContactRow const& k : row.contact)
      contacts_ << fmt::format("{:.9g}{}{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", row.time,
                               prefix_[row.measure], k.a, k.b, k.point.x, k.point.y, k.point.z, k.force.x, k.force.y,
                               k.force.z);
  }
  if (rows.empty()) return;
  file_ << std::flush;
  if (contacts_.is_open()) contacts_ << std::flush;
  if (!contacts_) throw std::system_error(EIO, std::generic_category(), "contacts.csv: cannot be written");
  if (!file_) throw std::system_error(EIO, std::generic_category(), "measures.csv: cannot be written");
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

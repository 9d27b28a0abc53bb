// envelope_tables.cpp: envelopes as comma-separated values.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>

#include "core/envelopes.h"
#include "shapes/whole_file.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct EnvelopeTable {
  char const* name;
  char const* columns;
  std::string (*rows)(Envelopes const&);
};

std::string figures(SampleSpread const& s) {
  return fmt::format("{},{:.6g},{:.6g},{:.6g},{:.6g}", s.count, s.mean, s.low, s.high, s.largest);
}

std::string groups(Envelopes const& e) {
  std::string out;
  for (std::size_t g = 0; g < e.group.size(); ++g) {
    EnvelopeGroup const& group = e.group[g];
    std::array<int, 3> count{};
    double fastest = 0;
    for (GrainWay const& way : e.grain)
      if (way.group == static_cast<int>(g)) {
        ++count[static_cast<std::size_t>(way.fate)];
        fastest = std::max(fastest, way.largest_speed);
      }
    double energy = 0;
    for (EnvelopeGroup::Screen const& s : group.screen) energy = std::max(energy, s.energy.largest);
    out +=
        fmt::format("{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", group.name,
                    group.replicas, group.grains, count[0], count[1], count[2], group.run_out.mean, group.run_out.low,
                    group.run_out.high, group.run_out.largest, group.widest, group.sideways, fastest, energy);
  }
  return out;
}

std::string grains(Envelopes const& e) {
  std::string out;
  for (GrainWay const& w : e.grain)
    out += fmt::format("{},{},{},{},{},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.6g},{:.6g},{:.6g}\n",
                       e.group[w.group].name, w.file, w.replica, w.body, to_string(w.fate), w.release.x, w.release.y,
                       w.release.z, w.end.x, w.end.y, w.end.z, w.run_out, w.sideways, w.largest_speed);
  return out;
}

std::string run_out(Envelopes const& e) {
  std::string out;
  for (EnvelopeGroup const& g : e.group)
    for (EnvelopeGroup::Bin const& b : g.bin)
      out +=
          fmt::format("{},{:.6g},{:.6g},{},{},{:.6g}\n", g.name, b.from, b.from + e.bin, b.stopped, b.left, b.beyond);
  return out;
}

std::string plan(Envelopes const& e) {
  std::string out;
  for (EnvelopeGroup const& g : e.group)
    for (EnvelopeGroup::Cell const& c : g.cell)
      out += fmt::format("{},{:.10g},{:.10g},{},{},{}\n", g.name, c.along, c.across, c.passed, c.stopped, c.left);
  return out;
}

std::string screens(Envelopes const& e) {
  std::string out;
  for (EnvelopeGroup const& g : e.group)
    for (EnvelopeGroup::Screen const& s : g.screen)
      out += fmt::format("{},{:.10g},{},{:.6g}\n", g.name, s.along, figures(s.energy), s.rotation);
  return out;
}

std::string velocity(Envelopes const& e) {
  std::string out;
  for (EnvelopeGroup const& g : e.group)
    for (EnvelopeGroup::Moment const& m : g.moment)
      out += fmt::format("{},{:.6g},{}\n", g.name, m.time, figures(m.speed));
  return out;
}

// Units: lengths [m], speeds [m/s], times [s], energies per mass [J/kg].
std::array<EnvelopeTable, 6> constexpr tables{{
    {"groups",
     "group,replicas,grains,stopped,moving,left,run_out_mean,run_out_p5,run_out_p95,run_out_max,sideways_max,"
     "sideways_spread,largest_speed,largest_energy",
     groups},
    {"grains", "group,file,replica,body,end,x0,y0,z0,x,y,z,run_out,sideways,largest_speed", grains},
    {"run_out", "group,from,to,stopped,left,beyond", run_out},
    {"plan", "group,along,across,passed,stopped,left", plan},
    {"screens", "group,along,grains,mean,p5,p95,max,rotation_mean", screens},
    {"velocity", "group,time,grains,mean,p5,p95,max", velocity},
}};

}  // namespace

std::vector<fs::path> envelope_files(fs::path const& folder) {
  std::vector<fs::path> out;
  for (EnvelopeTable const& table : tables) out.push_back(folder / (std::string(table.name) + ".csv"));
  return out;
}

void write_envelopes(Envelopes const& envelopes, fs::path const& folder) {
  std::vector<fs::path> const files = envelope_files(folder);
  for (std::size_t k = 0; k < tables.size(); ++k)
    replace_whole_file(files[k], std::string(tables[k].columns) + '\n' + tables[k].rows(envelopes));
}

}  // namespace scree

// case_echo.cpp: the effective case as TOML text, every default written out.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/case.h"
#include "core/case_effects_text.h"
#include "core/case_measure_text.h"
#include "core/case_run_text.h"
#include "core/case_wall.h"
#include "core/certificate_gate.h"
#include "core/sampled_grains.h"
#include "core/toml_text.h"

namespace scree {
namespace {

std::string list(std::vector<std::string> const& items) { return fmt::format("[{}]", fmt::join(items, ", ")); }

std::string quoted_list(std::vector<std::string> const& items) {
  std::vector<std::string> out;
  for (std::string const& item : items) out.push_back(toml_quoted(item));
  return list(out);
}

std::string vectors(std::vector<Vec3> const& vs) {
  std::vector<std::string> out;
  for (Vec3 const& v : vs) out.push_back(toml_vector(v));
  return list(out);
}

std::string quaternions(std::vector<Quat> const& qs) {
  std::vector<std::string> out;
  for (Quat const& q : qs) out.push_back(fmt::format("[{}, {}, {}, {}]", q.w, q.x, q.y, q.z));
  return list(out);
}

char const* to_string(Orientation o) { return o == Orientation::random ? "random" : "aligned"; }
char const* to_string(ContactLaw law) {
  switch (law) {
    case ContactLaw::winkler:
      return "winkler";
    case ContactLaw::linear:
      return "linear";
    case ContactLaw::hertz:
      return "hertz";
  }
  throw std::invalid_argument("this ContactLaw does not exist");
}
char const* to_string(Evaluator e) {
  switch (e) {
    case Evaluator::net:
      return "net";
    case Evaluator::grid:
      return "grid";
    case Evaluator::mesh:
      return "mesh";
    case Evaluator::analytic:
      return "analytic";
  }
  throw std::invalid_argument("this Evaluator does not exist");
}

// With [accuracy], what it is to find out is not written.
void write_time(std::string& out, TimeCase const& t, bool accuracy) {
  out += fmt::format("\n[time]\nend = {}  # [s]\n", t.end);
  out += t.step ? fmt::format("step = {}  # [s]\n", *t.step) : "step = \"auto\"\n";
  if (!accuracy || t.safety_given) out += fmt::format("safety = {}\n", t.safety);
  if (t.settle)
    out += fmt::format(
        "settle = {{ damping = {}, after = {}, kinetic_per_grain = {}, hold = {} }}  # [1/s], [s], [m g d], [s]\n",
        t.settle->damping, t.settle->after, t.settle->kinetic_per_grain, t.settle->hold);
}

void write_contact(std::string& out, ContactCase const& c) {
  out += fmt::format("\n[[contact]]\npair = [{}, {}]\nlaw = \"{}\"\n", toml_quoted(c.pair.first),
                     toml_quoted(c.pair.second), to_string(c.law));
  if (c.law == ContactLaw::linear)
    out += fmt::format("normal = {{ stiffness = {}, onset = {}, at_overlap = {} }}  # [N/m], [d], [d]\n", c.stiffness,
                       c.onset, c.at_overlap);
  else if (c.law == ContactLaw::hertz)
    out += fmt::format("normal = {{ youngs_modulus = {}, poisson_ratio = {}, at_overlap = {} }}  # [Pa], [-], [d]\n",
                       c.youngs_modulus, c.poisson_ratio, c.at_overlap);
  else if (c.kappa)
    out += fmt::format("normal = {{ kappa = {} }}  # [N/m3]\n", *c.kappa);
  else
    out += fmt::format("normal = {{ stiffness = {}, at_overlap = {} }}  # [N/m], [d]\n", c.stiffness, c.at_overlap);
  out += fmt::format("tangential_ratio = {}\n", c.tangential_ratio);
  if (c.friction) out += fmt::format("friction = {}\n", *c.friction);
  if (c.rolling)
    out += fmt::format("rolling = {{ friction = {}, stiffness_ratio = {}, damping = {} }}\n", c.rolling->friction,
                       c.rolling->stiffness_ratio, c.rolling->damping);
  if (c.cohesion)
    out += fmt::format("cohesion = {{ traction = {}, range = {} }}  # [Pa], [m]\n", c.cohesion->traction,
                       c.cohesion->range);
  if (c.damping_ratio) out += fmt::format("damping = {{ ratio = {} }}\n", *c.damping_ratio);
  if (c.restitution) out += fmt::format("damping = {{ restitution = {} }}\n", *c.restitution);
}

std::string sample_keys(SampleCase const& s) {
  std::string out = fmt::format("sample = {{ library = {}, category = {}, truncate = {}", toml_quoted(s.library),
                                toml_quoted(s.category), s.truncate);
  for (FormScreen const& f : form_screens())
    if (Interval const& i = s.*f.wanted; i.low > Interval{}.low || i.high < Interval{}.high)
      out += fmt::format(", {} = [{}, {}]", f.key, i.low, i.high);
  return out + " }\n";
}

std::string interpolate_keys(InterpolateCase const& i) {
  std::string const t = i.random ? "\"random\"" : fmt::format("[{}, {}]", i.low, i.high);
  return fmt::format("interpolate = {{ library = {}, from = {}, to = {}, t = {} }}\n", toml_quoted(i.library),
                     toml_quoted(i.from), toml_quoted(i.to), t);
}

void write_grains(std::string& out, GrainsCase const& g, bool accuracy) {
  out += fmt::format("\n[[grains]]\nname = {}\nmaterial = {}\n", toml_quoted(g.name), toml_quoted(g.material));
  if (!g.shapes.empty()) out += fmt::format("shapes = {}\n", quoted_list(g.shapes));
  if (g.sample) out += sample_keys(*g.sample);
  if (g.interpolate) out += interpolate_keys(*g.interpolate);
  out += fmt::format("evaluator = \"{}\"\n", to_string(g.evaluator));
  if (g.evaluator == Evaluator::grid) out += fmt::format("grid_cells = {}\n", g.grid_cells);
  if (g.evaluator == Evaluator::mesh) out += fmt::format("mesh_cells = {}\n", g.mesh_cells);
  if (!accuracy || g.nodes_given) out += fmt::format("nodes = {}\n", g.nodes);
  out += fmt::format(
      "storage = \"{}\"\ncount = {}\ndiameter = {}  # [m]\n",
      g.storage == NodeStorage::compact ? "compact" : "explicit", g.count,
      g.least_diameter ? fmt::format("[{}, {}]", *g.least_diameter, g.diameter) : fmt::format("{}", g.diameter));
  if (g.apart) out += "apart = true\n";
  InsertCase const& i = g.insert;
  std::string const scatter = i.scatter == Vec3{} ? "" : fmt::format(", scatter = {}", toml_vector(i.scatter));  // [m]
  std::string const moving = fmt::format("velocity = {}, spin = {}{}", toml_vector(i.velocity), toml_vector(i.spin),
                                         scatter);  // [m/s], [rad/s]
  using Kind = InsertCase::Kind;
  if (i.kind == Kind::random || i.kind == Kind::rate)
    out += fmt::format("insert = {{ kind = \"{}\", box = {}, {}orientation = \"{}\", {} }}\n",
                       i.kind == Kind::rate ? "rate" : "random", vectors({i.box.min, i.box.max}),
                       i.kind == Kind::rate ? fmt::format("rate = {}, start = {}, ", i.rate, i.start) : "",
                       to_string(i.orientation), moving);
  else if (i.kind == Kind::file)
    out += fmt::format(
        "insert = {{ kind = \"file\", file = {}, {}{} }}\n", toml_quoted(std::filesystem::absolute(i.file).string()),
        i.quaternion.empty() ? fmt::format("orientation = \"{}\", ", to_string(i.orientation)) : "", moving);
  else if (i.kind == Kind::lattice)
    out += fmt::format("insert = {{ kind = \"lattice\", box = {}, orientation = \"{}\", {} }}\n",
                       vectors({i.box.min, i.box.max}), to_string(i.orientation), moving);
  else if (i.quaternion.empty())
    out += fmt::format("insert = {{ kind = \"list\", position = {}, orientation = \"{}\", {} }}\n", vectors(i.position),
                       to_string(i.orientation), moving);
  else
    out += fmt::format("insert = {{ kind = \"list\", position = {}, quaternion = {}, {} }}\n", vectors(i.position),
                       quaternions(i.quaternion), moving);
}

}  // namespace

std::string to_toml(Case const& c) {
  std::string out = fmt::format("[case]\nname = {}\nseed = {}\n", toml_quoted(c.name), c.seed);
  if (c.replicas != 1) out += fmt::format("replicas = {}\n", c.replicas);
  write_time(out, c.time, c.accuracy.has_value());
  if (c.gravity) out += fmt::format("\n[gravity]\nacceleration = {}  # [m/s2]\n", toml_vector(*c.gravity));
  out += effects_to_toml(c);
  for (LibraryCase const& l : c.library)
    out += fmt::format("\n[[library]]\nname = {}\nfile = {}\n", toml_quoted(l.name),
                       toml_quoted(std::filesystem::absolute(l.file).string()));
  for (MaterialCase const& m : c.material)
    out += fmt::format("\n[[material]]\nname = {}\ndensity = {}  # [kg/m3]\n", toml_quoted(m.name), m.density);
  for (ContactCase const& k : c.contact) write_contact(out, k);
  for (GrainsCase const& g : c.grains) write_grains(out, g, c.accuracy.has_value());
  for (WallCase const& w : c.wall) out += wall_to_toml(w);
  out += measures_to_toml(c);
  out += run_to_toml(c);
  return out;
}

}  // namespace scree

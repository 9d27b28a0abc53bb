// case_effects_text.cpp: see case_effects_text.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/case_effects_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/case_range.h"
#include "core/nearest_name.h"

namespace scree {
namespace {

void read_force(CaseReader r, ForceCase& out) {
  r.text("name", out.name, Need::required);
  r.text("grains", out.grains, Need::required);
  bool const pushes = r.vector("force", out.force), turns = r.vector("torque", out.torque);
  if (!pushes && !turns && !r.present("force") && !r.present("torque"))
    r.report("force", "is missing: give force [N], torque [N m] or both");
  bool const started = r.number("start", out.start), stopped = r.number("stop", out.stop);
  bool const tabled = r.pairs("table", out.table.time, out.table.value);
  if (tabled && out.table.empty()) r.report("table", "must hold at least one [time, factor]");
  if (tabled && (started || stopped))
    r.report("table", "says when the force acts: give either a table or start and stop, not both");
  r.finish();
}

void read_delete(CaseReader r, DeleteCase& out) {
  r.text("name", out.name, Need::required);
  if (!r.choice<bool>("kind", out.plane, {{"box", false}, {"plane", true}}, {}, Need::required)) {
    out.plane = true;  // the other keys depend on the kind; a plane's defaults raise no further complaint
    return;
  }
  if (out.plane) {
    r.vector("point", out.point, Need::required);
    r.vector("normal", out.normal, Need::required);
  } else {
    r.choice<bool>("side", out.inside, {{"outside", false}, {"inside", true}});
    r.vector("min", out.min, Need::required);
    r.vector("max", out.max, Need::required);
  }
  r.finish();
}

class EffectsChecker {
 public:
  EffectsChecker(Case const& c, std::vector<CaseProblem>& found) : c_(c), found_(found) {
    for (GrainsCase const& g : c.grains) grains_.push_back(g.name);
  }

  void drag(DragCase const& d) {
    not_negative("drag.density", d.density, "the fluid's mass density in kg/m3");
    not_negative("drag.coefficient", d.coefficient, "a negative drag would drive the motion");
    finite("drag.fluid_velocity", d.fluid_velocity);
  }

  void force(std::string const& at, ForceCase const& f) {
    name(at + ".name", f.name, forces_);
    if (std::find(grains_.begin(), grains_.end(), f.grains) == grains_.end())
      fail(at + ".grains", fmt::format("unknown grains '{}'{}; defined: {}", f.grains, did_you_mean(f.grains, grains_),
                                       grains_.empty() ? "none" : fmt::format("{}", fmt::join(grains_, ", "))));
    finite(at + ".force", f.force);
    finite(at + ".torque", f.torque);
    if (!std::isfinite(f.start)) fail(at + ".start", fmt::format("{} must be finite", f.start));
    if (f.stop && !(*f.stop > f.start))
      fail(at + ".stop", fmt::format("{} s must lie after start = {} s", *f.stop, f.start));
    table(at + ".table", f.table);
  }

  void deletion(std::string const& at, DeleteCase const& d) {
    name(at + ".name", d.name, deletions_);
    if (d.plane) {
      finite(at + ".point", d.point);
      if (!(is_finite(d.normal) && norm(d.normal) > 0))
        fail(at + ".normal", "must have a length: it points into the space that is kept");
      return;
    }
    Vec3 const size = d.max - d.min;
    if (!(is_finite(size) && size.x > 0 && size.y > 0 && size.z > 0))
      fail(at + ".max",
           fmt::format("the box is {} x {} x {} m: max must exceed min on every axis", size.x, size.y, size.z));
  }

  void not_negative(std::string const& key, double value, char const* reason) {
    if (std::string wrong = out_of_range(value, 0, true, std::numeric_limits<double>::infinity(), reason);
        !wrong.empty())
      fail(key, wrong);
  }

 private:
  void fail(std::string key, std::string text) { found_.push_back({std::move(key), std::move(text)}); }

  void finite(std::string const& key, Vec3 v) {
    if (!is_finite(v)) fail(key, fmt::format("[{}, {}, {}] must be finite", v.x, v.y, v.z));
  }

  // Names are what --set addresses and messages say.
  void name(std::string const& key, std::string const& word, std::vector<std::string>& names) {
    if (word.empty() || word.find_first_of(".=: \t\n") != std::string::npos)
      fail(key, fmt::format("'{}' must be a word without blanks and . = :", word));
    else if (std::count(names.begin(), names.end(), word))
      fail(key, fmt::format("'{}' is used twice: names must differ", word));
    names.push_back(word);
  }

  void table(std::string const& key, TimeTable const& t) {
    if (t.time.size() != t.value.size())
      return fail(key, fmt::format("{} times for {} factors", t.time.size(), t.value.size()));
    for (std::size_t i = 0; i < t.time.size(); ++i) {
      if (!std::isfinite(t.time[i]) || !std::isfinite(t.value[i]))
        return fail(key, fmt::format("[{}, {}] must be finite", t.time[i], t.value[i]));
      if (i > 0 && t.time[i] < t.time[i - 1])
        return fail(key, fmt::format("time {} s comes after {} s: times must ascend", t.time[i], t.time[i - 1]));
    }
  }

  Case const& c_;
  std::vector<CaseProblem>& found_;
  std::vector<std::string> grains_, forces_, deletions_;
};

std::string vector(Vec3 v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

std::string force_to_toml(ForceCase const& f) {
  std::string out =
      fmt::format("\n[[force]]\nname = \"{}\"\ngrains = \"{}\"\nforce = {}  # [N]\ntorque = {}  # [N m]\n", f.name,
                  f.grains, vector(f.force), vector(f.torque));
  if (f.table.empty()) {
    out += fmt::format("start = {}  # [s]\n", f.start);
    if (f.stop) out += fmt::format("stop = {}  # [s]\n", *f.stop);
    return out;
  }
  std::vector<std::string> points;
  for (std::size_t i = 0; i < f.table.time.size(); ++i)
    points.push_back(fmt::format("[{}, {}]", f.table.time[i], f.table.value[i]));
  return out + fmt::format("table = [{}]  # [s], factor\n", fmt::join(points, ", "));
}

std::string delete_to_toml(DeleteCase const& d) {
  std::string const out =
      fmt::format("\n[[delete]]\nname = \"{}\"\nkind = \"{}\"\n", d.name, d.plane ? "plane" : "box");
  if (d.plane) return out + fmt::format("point = {}  # [m]\nnormal = {}\n", vector(d.point), vector(d.normal));
  return out + fmt::format("side = \"{}\"\nmin = {}  # [m]\nmax = {}  # [m]\n", d.inside ? "inside" : "outside",
                           vector(d.min), vector(d.max));
}

}  // namespace

void read_effects(CaseReader& root, Case& out) {
  if (auto drag = root.table("drag")) {
    DragCase& d = out.drag.emplace();
    drag->number("density", d.density, Need::required);
    drag->number("coefficient", d.coefficient, Need::required);
    drag->vector("fluid_velocity", d.fluid_velocity);
    drag->finish();
  }
  if (auto damping = root.table("damping")) {
    damping->number("rate", out.damping.emplace().rate, Need::required);
    damping->finish();
  }
  for (CaseReader const& entry : root.tables("force")) read_force(entry, out.force.emplace_back());
  for (CaseReader const& entry : root.tables("delete")) read_delete(entry, out.deletion.emplace_back());
}

void check_effects(Case const& c, std::vector<CaseProblem>& found) {
  EffectsChecker check(c, found);
  if (c.drag) check.drag(*c.drag);
  if (c.damping) check.not_negative("damping.rate", c.damping->rate, "a rate in 1/s; a negative one would add energy");
  for (std::size_t i = 0; i < c.force.size(); ++i) check.force(fmt::format("force.{}", i), c.force[i]);
  for (std::size_t i = 0; i < c.deletion.size(); ++i) check.deletion(fmt::format("delete.{}", i), c.deletion[i]);
}

std::string effects_to_toml(Case const& c) {
  std::string out;
  if (c.drag)
    out += fmt::format("\n[drag]\ndensity = {}  # [kg/m3]\ncoefficient = {}\nfluid_velocity = {}  # [m/s]\n",
                       c.drag->density, c.drag->coefficient, vector(c.drag->fluid_velocity));
  if (c.damping) out += fmt::format("\n[damping]\nrate = {}  # [1/s]\n", c.damping->rate);
  for (ForceCase const& f : c.force) out += force_to_toml(f);
  for (DeleteCase const& d : c.deletion) out += delete_to_toml(d);
  return out;
}

}  // namespace scree

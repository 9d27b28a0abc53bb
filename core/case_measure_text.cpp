// case_measure_text.cpp: see case_measure_text.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/case_measure_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/measure_kinds.h"
#include "core/nearest_name.h"
#include "core/toml_text.h"

namespace scree {
namespace {

using Fail = std::function<void(std::string const& key, std::string text)>;

void read_box(CaseReader& r, MeasureCase& m, Need need) {
  std::vector<Vec3> corner;
  if (!r.vectors("box", corner, need)) return;
  if (corner.size() == 2)
    m.box = Box{corner[0], corner[1]};
  else
    r.report("box", fmt::format("must be two corners [[x, y, z], [x, y, z]], not {}", corner.size()));
}

void read_cylinder(CaseReader& r, MeasureCase& m, Need need) {
  auto table = r.table("cylinder", need);
  if (!table) return;
  MeasureCylinder& c = m.cylinder.emplace();
  table->vector("from", c.from, Need::required);
  table->vector("to", c.to, Need::required);
  table->number("radius", c.radius, Need::required);
  table->finish();
}

template <std::optional<Vec3> MeasureCase::*member>
void read_vector(CaseReader& r, char const* key, MeasureCase& m, Need need) {
  if (Vec3 v; r.vector(key, v, need)) m.*member = v;
}

// A name of another entry that has to exist.
template <class T>
void known(std::string const& key, std::string const& word, std::vector<T> const& list, Fail const& fail) {
  if (word.empty()) return;  // absent, or reported as missing
  std::vector<std::string> names;
  for (T const& e : list) names.push_back(e.name);
  if (std::find(names.begin(), names.end(), word) == names.end())
    fail(key, fmt::format("unknown name '{}'{}; defined: {}", word, did_you_mean(word, names),
                          names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

void positive(std::string const& key, std::optional<double> value, char const* what, Fail const& fail) {
  if (value && !(std::isfinite(*value) && *value > 0)) fail(key, fmt::format("{} must be > 0: {}", *value, what));
}

void has_length(std::string const& key, std::optional<Vec3> v, Fail const& fail) {
  if (v && !(is_finite(*v) && norm(*v) > 0)) fail(key, "must be a direction: three finite numbers, not all 0");
}

void finite(std::string const& key, std::optional<Vec3> v, Fail const& fail) {
  if (v && !is_finite(*v)) fail(key, fmt::format("[{}, {}, {}] must be finite", v->x, v->y, v->z));
}

void check_box(MeasureCase const& m, Fail const& fail) {
  if (!m.box) return;
  Vec3 const size = m.box->max - m.box->min;
  if (!(is_finite(size) && size.x > 0 && size.y > 0 && size.z > 0))
    fail("box", fmt::format("is {} x {} x {} m: the second corner must exceed the first on every axis", size.x, size.y,
                            size.z));
}

void check_cylinder(MeasureCase const& m, Fail const& fail) {
  if (!m.cylinder) return;
  Vec3 const axis = m.cylinder->to - m.cylinder->from;
  if (!(is_finite(axis) && norm(axis) > 0)) fail("cylinder.to", "must differ from `from`: it ends the axis");
  positive("cylinder.radius", m.cylinder->radius, "metres", fail);
}

std::string written(char const* key, std::optional<Vec3> v) {
  return v ? fmt::format("{} = {}\n", key, toml_vector(*v)) : "";
}
std::string written(char const* key, std::optional<double> v) { return v ? fmt::format("{} = {}\n", key, *v) : ""; }
std::string written(char const* key, std::string const& v) {
  return v.empty() ? "" : fmt::format("{} = {}\n", key, toml_quoted(v));
}

// Every key that some kind takes, a line each.
struct Key {
  char const* name;
  void (*read)(CaseReader&, MeasureCase&, Need);
  void (*check)(Case const&, MeasureCase const&, Fail const&);
  std::string (*write)(MeasureCase const&);
};

std::vector<Key> const& keys() {
  using R = CaseReader;
  using M = MeasureCase;
  static std::vector<Key> const table{
      {"box", read_box, [](Case const&, M const& m, Fail const& fail) { check_box(m, fail); },
       [](M const& m) {
         return m.box ? fmt::format("box = [{}, {}]  # [m]\n", toml_vector(m.box->min), toml_vector(m.box->max)) : "";
       }},
      {"cylinder", read_cylinder, [](Case const&, M const& m, Fail const& fail) { check_cylinder(m, fail); },
       [](M const& m) {
         return m.cylinder ? fmt::format("cylinder = {{ from = {}, to = {}, radius = {} }}  # [m]\n",
                                         toml_vector(m.cylinder->from), toml_vector(m.cylinder->to), m.cylinder->radius)
                           : "";
       }},
      {"slices", [](R& r, M& m, Need n) { r.integer("slices", m.slices, n); },
       [](Case const&, M const& m, Fail const& fail) {
         if (m.slices < 0 || m.slices > 1000) fail("slices", fmt::format("{} must be 0 to 1000", m.slices));
       },
       [](M const& m) { return fmt::format("slices = {}\n", m.slices); }},
      {"points", [](R& r, M& m, Need n) { r.integer("points", m.points, n); },
       [](Case const&, M const& m, Fail const& fail) {
         if (m.points < 100 || m.points > 1000000)
           fail("points", fmt::format("{} must be 100 to 1,000,000 a shape", m.points));
       },
       [](M const& m) { return fmt::format("points = {}\n", m.points); }},
      {"wall", [](R& r, M& m, Need n) { r.text("wall", m.wall, n); },
       [](Case const& c, M const& m, Fail const& fail) { known("wall", m.wall, c.wall, fail); },
       [](M const& m) { return written("wall", m.wall); }},
      {"grains", [](R& r, M& m, Need n) { r.text("grains", m.grains, n); },
       [](Case const& c, M const& m, Fail const& fail) { known("grains", m.grains, c.grains, fail); },
       [](M const& m) { return written("grains", m.grains); }},
      {"delete", [](R& r, M& m, Need n) { r.text("delete", m.deletion, n); },
       [](Case const& c, M const& m, Fail const& fail) { known("delete", m.deletion, c.deletion, fail); },
       [](M const& m) { return written("delete", m.deletion); }},
      {"axis", [](R& r, M& m, Need n) { read_vector<&M::axis>(r, "axis", m, n); },
       [](Case const&, M const& m, Fail const& fail) { has_length("axis", m.axis, fail); },
       [](M const& m) { return written("axis", m.axis); }},
      {"through", [](R& r, M& m, Need n) { read_vector<&M::through>(r, "through", m, n); },
       [](Case const&, M const& m, Fail const& fail) { finite("through", m.through, fail); },
       [](M const& m) { return written("through", m.through); }},
      {"direction", [](R& r, M& m, Need n) { read_vector<&M::direction>(r, "direction", m, n); },
       [](Case const&, M const& m, Fail const& fail) { has_length("direction", m.direction, fail); },
       [](M const& m) { return written("direction", m.direction); }},
      {"point", [](R& r, M& m, Need n) { read_vector<&M::point>(r, "point", m, n); },
       [](Case const&, M const& m, Fail const& fail) { finite("point", m.point, fail); },
       [](M const& m) { return written("point", m.point); }},
      {"normal", [](R& r, M& m, Need n) { read_vector<&M::normal>(r, "normal", m, n); },
       [](Case const&, M const& m, Fail const& fail) { has_length("normal", m.normal, fail); },
       [](M const& m) { return written("normal", m.normal); }},
      {"radius", [](R& r, M& m, Need n) { r.number("radius", m.radius, n); },
       [](Case const&, M const& m, Fail const& fail) { positive("radius", m.radius, "metres", fail); },
       [](M const& m) { return written("radius", m.radius); }},
      {"bin", [](R& r, M& m, Need n) { r.number("bin", m.bin, n); },
       [](Case const&, M const& m, Fail const& fail) { positive("bin", m.bin, "metres, about one grain", fail); },
       [](M const& m) { return written("bin", m.bin); }},
      {"flank", [](R& r, M& m, Need n) { r.interval("flank", m.flank_low, m.flank_high, n); },
       [](Case const&, M const& m, Fail const& fail) {
         if (!(m.flank_low >= 0 && m.flank_low < m.flank_high && m.flank_high <= 1))
           fail("flank", fmt::format("[{}, {}] must ascend within 0 and 1, shares of the heap's height", m.flank_low,
                                     m.flank_high));
       },
       [](M const& m) { return fmt::format("flank = [{}, {}]\n", m.flank_low, m.flank_high); }},
      {"longer_than", [](R& r, M& m, Need n) { r.number("longer_than", m.longer_than, n); },
       [](Case const&, M const& m, Fail const& fail) { positive("longer_than", m.longer_than, "seconds", fail); },
       [](M const& m) { return written("longer_than", m.longer_than); }},
      {"above", [](R& r, M& m, Need n) { r.number("above", m.above, n); },
       [](Case const&, M const& m, Fail const& fail) {
         positive("above", m.above, "times the mean contact force", fail);
       },
       [](M const& m) { return fmt::format("above = {}\n", m.above); }},
      {"contacts", [](R& r, M& m, Need n) { r.boolean("contacts", m.contacts, n); },
       [](Case const&, M const&, Fail const&) {},
       [](M const& m) { return fmt::format("contacts = {}\n", m.contacts); }},
      {"index", [](R& r, M& m, Need n) { r.numbers("index", m.index, n); },
       [](Case const& c, M const& m, Fail const& fail) {
         for (GrainsCase const& g : c.grains)
           for (double const i : m.index)
             if (double const n = double(g.count) * c.replicas;
                 g.name == m.grains && !(i >= 0 && i < n && i == std::floor(i)))
               fail("index", fmt::format("{} is none of the {} grains of '{}', counted from 0", i, n, g.name));
       },
       [](M const& m) { return m.index.empty() ? "" : fmt::format("index = [{}]\n", fmt::join(m.index, ", ")); }},
  };
  return table;
}

Key const& key_named(std::string const& name) {
  for (Key const& k : keys())
    if (k.name == name) return k;
  throw std::logic_error("no [[measure]] key is called " + name);
}

template <class Work>
void each_key(MeasureKind const& kind, Work const& work) {
  for (char const* name : kind.required) work(key_named(name), Need::required);
  for (char const* name : kind.optional) work(key_named(name), Need::optional);
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (MeasureKind const& k : measure_kinds()) names.push_back(k.name);
  return names;
}

void check_measure(Case const& c, MeasureCase const& m, Fail const& fail) {
  positive("every", m.every, "seconds between samples", fail);
  if (!std::isfinite(m.from)) fail("from", fmt::format("{} must be finite", m.from));
  if (m.until && !(*m.until > m.from)) fail("until", fmt::format("{} s must lie after from = {} s", *m.until, m.from));
  MeasureKind const* const kind = find_measure_kind(m.kind);
  if (!kind) {
    std::vector<std::string> const names = kind_names();
    return fail("kind", fmt::format("'{}' is unknown{}; allowed: {}", m.kind, did_you_mean(m.kind, names),
                                    fmt::join(names, ", ")));
  }
  if (m.box && m.cylinder) fail("box", "give either box or cylinder, not both");
  if (kind->region_needed && !m.box && !m.cylinder) fail("box", "is missing: give the region as box or cylinder");
  each_key(*kind, [&](Key const& k, Need) { k.check(c, m, fail); });
  if (kind->check)
    if (std::string const wrong = kind->check(c, m); !wrong.empty()) fail("kind", wrong);
}

}  // namespace

void read_measure(CaseReader r, MeasureCase& m) {
  r.text("name", m.name, Need::required);
  r.text("kind", m.kind, Need::required);
  r.number("every", m.every);
  r.number("from", m.from);
  if (double until = 0; r.number("until", until)) m.until = until;
  MeasureKind const* const kind = find_measure_kind(m.kind);
  if (!kind) return;  // check_measures names the kinds; the other keys depend on it
  each_key(*kind, [&](Key const& k, Need need) { k.read(r, m, need); });
  r.finish();
}

void check_measures(Case const& c, std::vector<CaseProblem>& found) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < c.measure.size(); ++i) {
    MeasureCase const& m = c.measure[i];
    auto const fail = [&](std::string const& key, std::string text) {
      found.push_back({fmt::format("measure.{}.{}", i, key), std::move(text)});
    };
    if (m.name.empty() || m.name.find_first_of(".=:, \t\n\"") != std::string::npos)
      fail("name", fmt::format("'{}' must be a word without blanks and . = : ,", m.name));
    else if (std::count(names.begin(), names.end(), m.name))
      fail("name", fmt::format("'{}' is used twice: names must differ", m.name));
    names.push_back(m.name);
    check_measure(c, m, fail);
  }
}

std::string measures_to_toml(Case const& c) {
  std::string out;
  for (MeasureCase const& m : c.measure) {
    out += fmt::format("\n[[measure]]\nname = {}\nkind = {}\nevery = {}  # [s]\nfrom = {}  # [s]\n",
                       toml_quoted(m.name), toml_quoted(m.kind), m.every.value_or(c.output.every), m.from);
    if (m.until) out += fmt::format("until = {}  # [s]\n", *m.until);
    if (MeasureKind const* const kind = find_measure_kind(m.kind))
      each_key(*kind, [&](Key const& k, Need) { out += k.write(m); });
  }
  return out;
}

}  // namespace scree

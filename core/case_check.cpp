// case_check.cpp: see case_check.h. Every message states value, allowed range and the reason for it.
// SPDX-License-Identifier: Apache-2.0
#include "core/case_check.h"

#include "core/case_wall.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>

#include "core/case_effects_text.h"
#include "core/case_measure_text.h"
#include "core/case_range.h"
#include "core/case_run_text.h"
#include "core/certificate_gate.h"
#include "core/nearest_name.h"
#include "core/sampled_grains.h"
#include "kernels/restitution.h"
#include "shapes/analytic_shapes.h"

namespace scree {
namespace {

double constexpr infinity = std::numeric_limits<double>::infinity();

class Checker {
 public:
  explicit Checker(Case const& c) : c_(c) {}
  std::vector<CaseProblem> run();

 private:
  void fail(std::string key, std::string text) { found_.push_back({std::move(key), std::move(text)}); }
  void range(std::string const& key, double value, double low, bool low_allowed, double high, char const* reason) {
    if (std::string wrong = out_of_range(value, low, low_allowed, high, reason); !wrong.empty()) fail(key, wrong);
  }
  void positive(std::string const& key, double value, char const* reason) {
    range(key, value, 0, false, infinity, reason);
  }
  void finite(std::string const& key, Vec3 value);
  bool known(std::string const& key, std::string const& name, std::vector<std::string> const& names, char const* what);
  template <class T>
  std::vector<std::string> names(std::vector<T> const& list, std::string const& key);

  void time();
  void materials();
  void contacts();
  void restitution(std::string const& key, double e, ContactLaw law);
  void normal_law(std::string const& at, ContactCase const& k);
  void touching_pairs();
  void shapes(std::string const& key, GrainsCase const& g);
  void made_shapes(std::string const& key, GrainsCase const& g);
  void insertion(std::string const& key, GrainsCase const& g);
  void grains();
  void walls();

  Case const& c_;
  std::vector<CaseProblem> found_;
  std::vector<std::string> library_, material_;
};

void Checker::finite(std::string const& key, Vec3 value) {
  if (!is_finite(value)) fail(key, fmt::format("[{}, {}, {}] must be finite", value.x, value.y, value.z));
}

bool Checker::known(std::string const& key, std::string const& name, std::vector<std::string> const& names,
                    char const* what) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return true;
  std::string const have = names.empty() ? "none is defined" : fmt::format("defined: {}", fmt::join(names, ", "));
  fail(key, fmt::format("unknown {} '{}'{}; {}", what, name, did_you_mean(name, names), have));
  return false;
}

// Names of a list; empty and repeated ones are problems, and so are names that --set could not address.
template <class T>
std::vector<std::string> Checker::names(std::vector<T> const& list, std::string const& key) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < list.size(); ++i) {
    std::string const at = fmt::format("{}.{}.name", key, i);
    std::string const& name = list[i].name;
    if (name.empty() || name.find_first_of(".=: \t\n") != std::string::npos)
      fail(at, fmt::format("'{}' must be a word without blanks and . = :", name));
    else if (std::find(out.begin(), out.end(), name) != out.end())
      fail(at, fmt::format("'{}' is used twice: names must differ", name));
    out.push_back(name);
  }
  return out;
}

void Checker::time() {
  TimeCase const& t = c_.time;
  positive("time.end", t.end, "simulated seconds");
  if (t.step)
    range("time.step", *t.step, 0, false, t.end > 0 ? t.end : infinity,
          "seconds, at most time.end; \"auto\" chooses it");
  range("time.safety", t.safety, 0, false, 1, "a share of the critical time step; beyond 1 the run is unstable");
  if (!t.settle) return;
  range("time.settle.damping", t.settle->damping, 0, true, infinity, "a rate in 1/s");
  range("time.settle.after", t.settle->after, 0, true, infinity, "seconds");
  positive("time.settle.kinetic_per_grain", t.settle->kinetic_per_grain, "a kinetic energy in units of m g d");
  range("time.settle.hold", t.settle->hold, 0, true, infinity, "seconds");
}

void Checker::materials() {
  library_ = names(c_.library, "library");
  for (std::size_t i = 0; i < c_.library.size(); ++i)
    if (c_.library[i].name == "mesh")
      fail(fmt::format("library.{}.name", i), "'mesh' is the word for mesh files in shapes: choose another name");
  material_ = names(c_.material, "material");
  for (std::size_t i = 0; i < c_.material.size(); ++i)
    positive(fmt::format("material.{}.density", i), c_.material[i].density, "a mass density in kg/m3");
}

void Checker::contacts() {
  std::set<std::pair<std::string, std::string>> seen;
  for (std::size_t i = 0; i < c_.contact.size(); ++i) {
    ContactCase const& k = c_.contact[i];
    std::string const at = fmt::format("contact.{}.", i);
    known(at + "pair", k.pair.first, material_, "material");
    if (k.pair.second != k.pair.first) known(at + "pair", k.pair.second, material_, "material");
    if (!seen.insert(std::minmax(k.pair.first, k.pair.second)).second)
      fail(at + "pair",
           fmt::format("'{}' and '{}' have two [[contact]] entries: keep one", k.pair.first, k.pair.second));
    normal_law(at + "normal.", k);
    range(at + "normal.at_overlap", k.at_overlap, 0, false, 0.1, "the overlap in d at which the stiffness holds");
    range(at + "tangential_ratio", k.tangential_ratio, 0, false, 2, "k_t / k_n; elastic solids lie between 2/3 and 1");
    if (k.friction)
      range(at + "friction", *k.friction, 0, true, infinity, "a negative friction would drive the motion");
    if (k.damping_ratio)
      range(at + "damping.ratio", *k.damping_ratio, 0, true, largest_damping_ratio,
            "share of the critical damping; a negative one would add energy");
    if (k.restitution) restitution(at + "damping.restitution", *k.restitution, k.law);
    if (k.cohesion) {
      range(at + "cohesion.traction", k.cohesion->traction, 0, true, infinity, "Pa; a negative one would repel");
      range(at + "cohesion.range", k.cohesion->range, 0, true, infinity, "m outside the surface");
    }
    if (k.rolling) {
      range(at + "rolling.friction", k.rolling->friction, 0, true, infinity, "a negative one would drive the rolling");
      positive(at + "rolling.stiffness_ratio", k.rolling->stiffness_ratio, "k_r / (K (mu_r R_r)^2)");
      range(at + "rolling.damping", k.rolling->damping, 0, true, 1, "share of the critical damping of rolling");
    }
    if (k.damping_ratio && k.restitution) fail(at + "damping", "give exactly one of ratio and restitution");
  }
}

void Checker::restitution(std::string const& key, double e, ContactLaw law) {
  range(key, e, 0, false, 1, "rebound speed over impact speed; above 1 energy would be made");
  if (!(e > 0 && e < 0.1)) return;  // the rest is reached by every law
  double const least = restitution_of(largest_damping_ratio, DampingPath::nodes, law);
  if (e < least)
    fail(key, fmt::format("{} is below what damping reaches, {:.2g} at ratio = {}: ask for no less", e, least,
                          largest_damping_ratio));
}

void Checker::normal_law(std::string const& at, ContactCase const& k) {
  if (k.law == ContactLaw::hertz) {
    positive(at + "youngs_modulus", k.youngs_modulus, "Young's modulus in Pa");
    if (!(k.poisson_ratio > -1 && k.poisson_ratio < 0.5))
      fail(at + "poisson_ratio",
           fmt::format("{} is out of range: must be > -1 and < 0.5 (a stable elastic solid)", k.poisson_ratio));
    return;
  }
  if (k.law == ContactLaw::linear)
    range(at + "onset", k.onset, 0, false, 0.1, "the overlap in d that carries all of p");
  if (k.kappa && k.law == ContactLaw::winkler)
    positive(at + "kappa", *k.kappa, "a pressure per overlap in N/m3");
  else
    positive(at + "stiffness", k.stiffness, "a contact stiffness in N/m");
}

// Every two materials that can meet need a law: grains meet grains and walls, walls never meet walls.
void Checker::touching_pairs() {
  std::set<std::pair<std::string, std::string>> needed;
  for (std::size_t i = 0; i < c_.grains.size(); ++i) {
    GrainsCase const& a = c_.grains[i];
    if (a.count > 1) needed.insert({a.material, a.material});
    for (std::size_t j = i + 1; j < c_.grains.size(); ++j)
      if (a.count > 0 && c_.grains[j].count > 0 && !a.apart && !c_.grains[j].apart)
        needed.insert(std::minmax(a.material, c_.grains[j].material));
    for (WallCase const& w : c_.wall)
      if (a.count > 0) needed.insert(std::minmax(a.material, w.material));
  }
  for (ContactCase const& k : c_.contact) needed.erase(std::minmax(k.pair.first, k.pair.second));
  for (auto const& [a, b] : needed) {
    bool const defined =
        std::count(material_.begin(), material_.end(), a) && std::count(material_.begin(), material_.end(), b);
    if (defined)
      fail("contact", fmt::format("'{}' and '{}' can touch and have no [[contact]] entry with pair = [\"{}\", \"{}\"]",
                                  a, b, a, b));
  }
}

void Checker::shapes(std::string const& key, GrainsCase const& g) {
  bool const made = g.sample || g.interpolate;
  if (g.shapes.empty() && !made)
    fail(
        key + ".shapes",
        "must name at least one shape, e.g. \"sphere\" or \"grains:ballast/*\"; or give sample or interpolate instead");
  if (made) made_shapes(key, g);
  for (std::string const& shape : g.shapes) {
    std::size_t const colon = shape.find(':');
    if (is_builtin_shape(shape)) {
      try {
        builtin_shape(shape);
      } catch (std::invalid_argument const& error) {
        fail(key + ".shapes", error.what());
      }
    } else if (!mesh_file_of(shape).empty()) {
      // whether the file is a closed mesh is seen when it is read
    } else if (colon != std::string::npos && shape.find(':', colon + 1) == std::string::npos) {
      known(key + ".shapes", shape.substr(0, colon), library_, "library");
    } else {
      std::vector<std::string> const words{"sphere", "ellipsoid", "superellipsoid", "box"};
      fail(key + ".shapes", fmt::format("unknown shape '{}'{}; write \"library:pattern\", \"mesh:file.stl\" or a "
                                        "built-in: sphere, ellipsoid:a:b:c, "
                                        "superellipsoid:a:b:c:exponent, box:a:b:c",
                                        shape, did_you_mean(shape.substr(0, colon), words)));
    }
  }
}

// Shapes made for the case: whether any can be made is seen when the library is read.
void Checker::made_shapes(std::string const& key, GrainsCase const& g) {
  char const* const word = g.sample ? "sample" : "interpolate";
  std::string const at = key + "." + word;
  if (!g.shapes.empty() || (g.sample && g.interpolate))
    fail(at, fmt::format("has no meaning beside {}: give exactly one of shapes, sample and interpolate",
                         g.shapes.empty() ? "interpolate" : "shapes"));
  if (g.evaluator == Evaluator::analytic)
    fail(key + ".evaluator", fmt::format("\"analytic\" needs formulas, {} makes networks: use \"net\", \"grid\" or "
                                         "\"mesh\"",
                                         word));
  if (g.storage == NodeStorage::compact && g.evaluator != Evaluator::net)
    fail(key + ".storage",
         "\"compact\" is for shapes run as networks: use evaluator = \"net\" or storage = \"explicit\"");
  if (g.sample) {
    SampleCase const& s = *g.sample;
    known(at + ".library", s.library, library_, "library");
    range(at + ".truncate", s.truncate, 0, false, infinity, "standard deviations at which the Gaussian is cut");
    for (FormScreen const& f : form_screens()) {
      Interval const& i = s.*f.wanted;
      if (!(i.low <= i.high))
        fail(fmt::format("{}.{}", at, f.key),
             fmt::format("[{}, {}] is empty: low must not exceed high", i.low, i.high));
      else if (i.high < 0 || i.low > 1)
        fail(fmt::format("{}.{}", at, f.key),
             fmt::format("[{}, {}] holds no grain: {} lies between 0 and 1", i.low, i.high, f.meaning));
    }
  }
  if (g.interpolate) {
    InterpolateCase const& i = *g.interpolate;
    known(at + ".library", i.library, library_, "library");
    for (double t : {i.low, i.high}) range(at + ".t", t, 0, true, 1, "0 is the shape `from`, 1 the shape `to`");
    if (i.low > i.high) fail(at + ".t", fmt::format("[{}, {}] is empty: low must not exceed high", i.low, i.high));
  }
}

void Checker::insertion(std::string const& key, GrainsCase const& g) {
  InsertCase const& insert = g.insert;
  finite(key + ".insert.velocity", insert.velocity);
  finite(key + ".insert.spin", insert.spin);
  for (int k = 0; k < 3; ++k)
    range(key + ".insert.scatter", insert.scatter[k], 0, true, infinity, "m to both sides of the position, each axis");
  using Kind = InsertCase::Kind;
  if (insert.kind == Kind::list || insert.kind == Kind::file) {
    std::size_t const n = insert.position.size();
    if (g.count != static_cast<int>(n))
      fail(key + ".count", fmt::format("{} differs from the {} positions of insert: leave count out", g.count, n));
    if (insert.kind == Kind::file && insert.file.empty())
      fail(key + ".insert.file", "must name a file of comma-separated values");
    for (std::size_t const other : {insert.velocities.size(), insert.spins.size(), insert.shape.size()})
      if (other > 0 && other != n)
        fail(key + ".insert.file", fmt::format("{} velocities, spins or shapes for {} positions", other, n));
    if (!insert.quaternion.empty() && insert.quaternion.size() != insert.position.size())
      fail(key + ".insert.quaternion", fmt::format("{} orientations for {} positions: give one each, or none",
                                                   insert.quaternion.size(), insert.position.size()));
    for (Vec3 const& x : insert.position) finite(key + ".insert.position", x);
    for (Quat const& q : insert.quaternion) {
      double const length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
      if (!(std::abs(length - 1) <= 1e-3))
        fail(key + ".insert.quaternion", fmt::format("has length {}, must be 1 (w, x, y, z)", length));
    }
    return;
  }
  Vec3 const size = insert.box.max - insert.box.min;
  if (!(is_finite(size) && size.x > 0 && size.y > 0 && size.z > 0))
    return fail(key + ".insert.box",
                fmt::format("is {} x {} x {} m: the second corner must lie above the first on every axis", size.x,
                            size.y, size.z));
  if (insert.kind == Kind::rate) {
    positive(key + ".insert.rate", insert.rate, "grains a second");
    range(key + ".insert.start", insert.start, 0, true, infinity, "seconds");
  }
  if (insert.kind != Kind::lattice) return;  // how many find a place is seen when they are placed
  // A cell is at least one equal-volume sphere wide; the real cell is known once the shapes are read.
  auto const cells = [&](double length) {
    return std::floor(length / g.diameter * (1 + 1e-9));
  };  // an exact fit is a fit
  double const places = cells(size.x) * cells(size.y) * cells(size.z);
  if (g.diameter > 0 && g.count > places)
    fail(key + ".insert.box",
         fmt::format("holds at most {} grains of diameter {} m without overlap, not {}: enlarge it or insert fewer",
                     places, g.diameter, g.count));
}

void Checker::grains() {
  names(c_.grains, "grains");
  double grains = 0;
  for (GrainsCase const& g : c_.grains) grains += std::max(0, g.count);
  range("case.replicas", c_.replicas, 1, true, std::floor(1e8 / std::max(1.0, grains)),
        "copies of all grains, 1e8 grains in all");
  for (std::size_t i = 0; i < c_.grains.size(); ++i) {
    GrainsCase const& g = c_.grains[i];
    std::string const at = fmt::format("grains.{}", i);
    known(at + ".material", g.material, material_, "material");
    shapes(at, g);
    range(at + ".nodes", g.nodes, 32, true, 1e6, "surface nodes a grain; 4000 for angular grains, \"fast\" = 1000");
    if (g.storage == NodeStorage::compact)
      range(at + ".nodes", g.nodes, 32, true, 20000, "surface nodes a grain with storage = \"compact\"");
    range(at + ".grid_cells", g.grid_cells, 8, true, 256,
          "cells across the bounding diameter; memory grows as its cube");
    range(at + ".mesh_cells", g.mesh_cells, 8, true, 128,
          "cells across the bounding diameter; 16 give about 15,000 triangles");
    range(at + ".count", g.count, 0, true, 1e8, "number of grains");
    positive(at + ".diameter", g.diameter, "diameter of the equal-volume sphere in m");
    if (g.least_diameter)
      range(at + ".diameter", *g.least_diameter, 0, false, g.diameter, "the least diameter of the entry in m");
    insertion(at, g);
  }
}

void Checker::walls() {
  names(c_.wall, "wall");
  for (std::size_t i = 0; i < c_.wall.size(); ++i) {
    WallCase const& w = c_.wall[i];
    std::string const at = fmt::format("wall.{}.", i);
    known(at + "material", w.material, material_, "material");
    check_wall(w, [&](std::string const& key, std::string text) { fail(at + key, std::move(text)); });
  }
}

std::vector<CaseProblem> Checker::run() {
  time();
  materials();
  contacts();
  grains();
  walls();
  touching_pairs();
  check_effects(c_, found_);
  check_measures(c_, found_);
  if (c_.gravity) finite("gravity.acceleration", *c_.gravity);
  check_run(c_, found_);
  return std::move(found_);
}

template <class T>
std::string name_at(std::vector<T> const& list, std::size_t index) {
  if (index >= list.size()) return "";
  std::string const& name = list[index].name;
  auto const same = std::count_if(list.begin(), list.end(), [&](T const& e) { return e.name == name; });
  return same == 1 ? name : "";  // a repeated name points nowhere
}

}  // namespace

std::vector<CaseProblem> check_case(Case const& c) { return Checker(c).run(); }

std::string key_by_name(Case const& c, std::string const& key) {
  std::size_t const first = key.find('.');
  if (first == std::string::npos) return key;
  std::size_t const second = std::min(key.find('.', first + 1), key.size());
  std::string const list = key.substr(0, first);
  std::size_t index = 0;
  auto const [end, error] = std::from_chars(key.data() + first + 1, key.data() + second, index);
  if (error != std::errc() || end != key.data() + second) return key;
  std::string name;
  if (list == "library") name = name_at(c.library, index);
  if (list == "material") name = name_at(c.material, index);
  if (list == "grains") name = name_at(c.grains, index);
  if (list == "wall") name = name_at(c.wall, index);
  if (list == "force") name = name_at(c.force, index);
  if (list == "measure") name = name_at(c.measure, index);
  if (list == "delete") name = name_at(c.deletion, index);
  return name.empty() ? key : list + "." + name + key.substr(second);
}

std::vector<std::string> problems(Case const& c) {
  std::vector<std::string> lines;
  for (CaseProblem const& p : check_case(c)) lines.push_back(key_by_name(c, p.key) + ": " + p.text);
  return lines;
}

}  // namespace scree

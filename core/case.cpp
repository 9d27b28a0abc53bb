// case.cpp: from the tree of a case file to a validated Case.
// SPDX-License-Identifier: Apache-2.0
#include "core/case.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>

#include "core/case_check.h"
#include "core/case_effects_text.h"
#include "core/case_keys.h"
#include "core/case_measure_text.h"
#include "core/case_reader.h"
#include "core/case_run_text.h"
#include "core/case_text.h"
#include "core/case_wall.h"
#include "core/certificate_gate.h"
#include "core/insert_file.h"
#include "core/sampled_grains.h"

namespace scree {
namespace {

void read_time(CaseReader r, TimeCase& out) {
  r.number("end", out.end, Need::required);
  if (CaseNode const* const step = r.present("step"); step && step->kind == CaseNode::Kind::string) {
    if (step->text != "auto") r.report("step", fmt::format("'{}' is unknown; write \"auto\" or seconds", step->text));
  } else if (step) {
    r.number("step", out.step);
  }
  out.safety_given = r.number("safety", out.safety);
  if (auto settle = r.table("settle")) {
    SettleCase& s = out.settle.emplace();
    settle->number("damping", s.damping);
    settle->number("after", s.after);
    settle->number("kinetic_per_grain", s.kinetic_per_grain);
    settle->number("hold", s.hold);
    settle->finish();
  }
  r.finish();
}

void read_library(CaseReader r, LibraryCase& out) {
  r.text("name", out.name, Need::required);
  std::string file;
  if (r.text("file", file, Need::required)) out.file = file;
  r.finish();
}

void read_material(CaseReader r, MaterialCase& out) {
  r.text("name", out.name, Need::required);
  r.number("density", out.density, Need::required);
  r.finish();
}

void read_normal(CaseReader r, ContactCase& out) {
  bool const by_kappa = r.number("kappa", out.kappa);
  bool const by_stiffness = r.number("stiffness", out.stiffness);
  bool const at_overlap = r.number("at_overlap", out.at_overlap);
  bool const hertz = out.law == ContactLaw::hertz, linear = out.law == ContactLaw::linear;
  bool const onset = r.number("onset", out.onset);
  bool const by_modulus = r.number("youngs_modulus", out.youngs_modulus, hertz ? Need::required : Need::optional);
  bool const by_ratio = r.number("poisson_ratio", out.poisson_ratio, hertz ? Need::required : Need::optional);
  auto const only_beside = [&](char const* key, bool given, bool known, char const* laws) {
    if (given && !known) r.report(key, fmt::format("has a meaning beside law = {} only", laws));
  };
  only_beside("kappa", by_kappa, !hertz && !linear, "\"winkler\"");
  only_beside("stiffness", by_stiffness, !hertz, "\"winkler\" or \"linear\"");
  only_beside("onset", onset, linear, "\"linear\"");
  only_beside("youngs_modulus", by_modulus, hertz, "\"hertz\"");
  only_beside("poisson_ratio", by_ratio, hertz, "\"hertz\"");
  if (linear && !by_stiffness) r.report("stiffness", "is missing: law = \"linear\" takes its k_n [N/m]");
  if (!hertz && !linear) {
    if (by_kappa && (by_stiffness || at_overlap))
      r.report("kappa", "give either kappa [N/m3] or stiffness [N/m] with at_overlap, not both");
    if (!by_kappa && !by_stiffness)
      r.report("stiffness", "is missing: give stiffness [N/m] with at_overlap [d], or kappa [N/m3]");
  }
  r.finish();
}

void read_damping(CaseReader r, ContactCase& out) {
  bool const by_ratio = r.number("ratio", out.damping_ratio);
  bool const by_restitution = r.number("restitution", out.restitution);
  if (by_ratio == by_restitution)
    r.report("ratio", "give exactly one of ratio and restitution; leave damping out for none");
  r.finish();
}

void read_contact(CaseReader r, ContactCase& out) {
  std::vector<std::string> pair;
  if (r.texts("pair", pair, Need::required)) {
    if (pair.size() == 2)
      out.pair = {pair[0], pair[1]};
    else
      r.report("pair", fmt::format("must name two materials (the same one twice for a material with itself), not {}",
                                   pair.size()));
  }
  r.choice<ContactLaw>(
      "law", out.law, {{"winkler", ContactLaw::winkler}, {"linear", ContactLaw::linear}, {"hertz", ContactLaw::hertz}});
  if (auto normal = r.table("normal", Need::required)) read_normal(*normal, out);  // its keys depend on the law
  r.number("tangential_ratio", out.tangential_ratio);
  r.number("friction", out.friction);
  if (auto damping = r.table("damping")) read_damping(*damping, out);
  if (auto rolling = r.table("rolling")) {
    RollingCase& roll = out.rolling.emplace();
    rolling->number("friction", roll.friction, Need::required);
    rolling->number("stiffness_ratio", roll.stiffness_ratio);
    rolling->number("damping", roll.damping);
    rolling->finish();
  }
  if (auto cohesion = r.table("cohesion")) {
    CohesionCase& stick = out.cohesion.emplace();
    cohesion->number("traction", stick.traction, Need::required);
    cohesion->number("range", stick.range, Need::required);
    cohesion->finish();
  }
  r.finish();
}

void read_insert(CaseReader r, InsertCase& out) {
  using Kind = InsertCase::Kind;
  r.choice<Kind>("kind", out.kind,
                 {{"lattice", Kind::lattice},
                  {"list", Kind::list},
                  {"random", Kind::random},
                  {"rate", Kind::rate},
                  {"file", Kind::file}},
                 {}, Need::required);
  if (out.kind == Kind::file) {
    std::string file;
    if (r.text("file", file, Need::required)) out.file = file;
  } else if (out.kind != Kind::list) {
    std::vector<Vec3> corner;
    if (r.vectors("box", corner, Need::required)) {
      if (corner.size() == 2)
        out.box = {corner[0], corner[1]};
      else
        r.report("box", fmt::format("must be two corners [[x, y, z], [x, y, z]], not {}", corner.size()));
    }
  } else {
    r.vectors("position", out.position, Need::required);
    r.quaternions("quaternion", out.quaternion);
  }
  if (out.kind == Kind::rate) {
    r.number("rate", out.rate, Need::required);
    r.number("start", out.start);
  }
  bool const oriented = r.choice<Orientation>("orientation", out.orientation,
                                              {{"random", Orientation::random}, {"aligned", Orientation::aligned}});
  if (oriented && !out.quaternion.empty())
    r.report("orientation", "has no meaning beside quaternion: remove one of them");
  r.vector("velocity", out.velocity);
  r.vector("spin", out.spin);
  bool const placed = out.kind == Kind::list || out.kind == Kind::file;
  if (r.vector("scatter", out.scatter) && !placed)
    r.report("scatter", "has a meaning beside kind = \"list\" and \"file\" only: other places are free choices");
  r.finish();
}

void read_sample(CaseReader r, SampleCase& out) {
  r.text("library", out.library, Need::required);
  r.text("category", out.category, Need::required);
  r.number("truncate", out.truncate);
  for (FormScreen const& s : form_screens()) r.interval(s.key, (out.*s.wanted).low, (out.*s.wanted).high);
  r.finish();
}

void read_interpolate(CaseReader r, InterpolateCase& out) {
  r.text("library", out.library, Need::required);
  r.text("from", out.from, Need::required);
  r.text("to", out.to, Need::required);
  CaseNode const* const t = r.present("t", Need::required);
  if (t && t->kind == CaseNode::Kind::string) {
    out.random = t->text == "random";
    if (!out.random) r.report("t", fmt::format("'{}' is unknown; write a number, [low, high] or \"random\"", t->text));
  } else if (t && t->kind == CaseNode::Kind::array) {
    r.interval("t", out.low, out.high);
  } else if (t && r.number("t", out.low)) {
    out.high = out.low;
  }
  r.finish();
}

void read_grains(CaseReader r, GrainsCase& out) {
  r.text("name", out.name, Need::required);
  r.text("material", out.material, Need::required);
  r.texts("shapes", out.shapes);
  if (auto sample = r.table("sample")) read_sample(*sample, out.sample.emplace());
  if (auto interpolate = r.table("interpolate")) read_interpolate(*interpolate, out.interpolate.emplace());
  r.choice<Evaluator>("evaluator", out.evaluator,
                      {{"net", Evaluator::net},
                       {"grid", Evaluator::grid},
                       {"mesh", Evaluator::mesh},
                       {"analytic", Evaluator::analytic}});
  if (r.integer("grid_cells", out.grid_cells) && out.evaluator != Evaluator::grid)
    r.report("grid_cells", "has a meaning beside evaluator = \"grid\" only");
  if (r.integer("mesh_cells", out.mesh_cells) && out.evaluator != Evaluator::mesh)
    r.report("mesh_cells", "has a meaning beside evaluator = \"mesh\" only");
  CaseNode const* const nodes = r.present("nodes");
  out.nodes_given = nodes != nullptr;
  if (nodes && nodes->kind == CaseNode::Kind::string) {
    if (nodes->text == "fast")
      out.nodes = 1000;
    else
      r.report("nodes", fmt::format("'{}' is unknown; write a whole number or \"fast\" (1000)", nodes->text));
  } else if (nodes) {
    r.integer("nodes", out.nodes);
  }
  r.choice<NodeStorage>("storage", out.storage,
                        {{"explicit", NodeStorage::explicit_}, {"compact", NodeStorage::compact}});
  if (CaseNode const* const node = r.present("diameter"); node && node->kind == CaseNode::Kind::array) {
    double least = 0;
    if (r.interval("diameter", least, out.diameter)) out.least_diameter = least;
  } else {
    r.number("diameter", out.diameter, Need::required);
  }
  auto insert = r.table("insert", Need::required);
  if (insert) read_insert(*insert, out.insert);
  bool const filed = insert && out.insert.kind == InsertCase::Kind::file;  // counted when the file is read
  bool const listed = filed || (insert && out.insert.kind == InsertCase::Kind::list);
  if (!r.integer("count", out.count, listed ? Need::optional : Need::required) && listed)
    out.count = filed ? -1 : static_cast<int>(out.insert.position.size());
  r.boolean("apart", out.apart);
  r.unsupported({"group"});
  r.finish();
}

// Every [[key]] entry through `read`, appended to `out`.
template <class T>
void read_list(CaseReader& root, std::string const& key, std::vector<T>& out, void (*read)(CaseReader, T&)) {
  for (CaseReader const& entry : root.tables(key)) read(entry, out.emplace_back());
}

void read_case(CaseReader root, Case& out) {
  if (auto header = root.table("case")) {
    header->text("name", out.name);
    std::int64_t seed = static_cast<std::int64_t>(out.seed);
    if (header->integer("seed", seed) && seed < 0) header->report("seed", fmt::format("{} must be >= 0", seed));
    out.seed = static_cast<std::uint64_t>(seed);
    header->integer("replicas", out.replicas);
    header->finish();
  }
  if (auto time = root.table("time", Need::required)) read_time(*time, out.time);
  if (auto gravity = root.table("gravity")) {
    gravity->vector("acceleration", out.gravity.emplace(), Need::required);
    gravity->finish();
  }
  read_effects(root, out);
  read_list(root, "library", out.library, read_library);
  read_list(root, "material", out.material, read_material);
  read_list(root, "contact", out.contact, read_contact);
  read_list(root, "grains", out.grains, read_grains);
  read_list(root, "wall", out.wall, read_wall);
  read_list(root, "measure", out.measure, read_measure);
  read_run(root, out);
  root.finish();
}

std::string const mesh_word = "mesh:";

// The first place where `file` exists: the case's folder, $SCREE_LIBRARY, `share`; in the latter two also by its
// bare name, so that an installed library serves cases that name a path of the source tree. Empty: nowhere.
std::filesystem::path find_file(std::filesystem::path const& file, std::filesystem::path const& folder,
                                std::filesystem::path const& share, std::vector<std::string>& tried) {
  std::vector<std::filesystem::path> places{folder / file};
  if (!file.is_absolute()) {
    char const* const library = std::getenv("SCREE_LIBRARY");
    for (std::filesystem::path const& base : {std::filesystem::path(library ? library : ""), share})
      if (!base.empty()) places.insert(places.end(), {base / file, base / file.filename()});
  }
  for (std::filesystem::path const& place : places) {
    std::error_code error;
    if (std::filesystem::is_regular_file(place, error)) return std::filesystem::weakly_canonical(place, error);
    tried.push_back(place.lexically_normal().string());
  }
  return {};
}

// Poses that grains take from files.
void read_insert_files(Case& c, std::filesystem::path const& share, CaseProblems& problems) {
  for (std::size_t i = 0; i < c.grains.size(); ++i) {
    GrainsCase& g = c.grains[i];
    if (g.insert.kind != InsertCase::Kind::file || g.insert.file.empty()) continue;  // an empty one is reported
    std::string const key = fmt::format("grains.{}.insert.file", i);
    std::vector<std::string> tried;
    std::filesystem::path const found = find_file(g.insert.file, c.file.parent_path(), share, tried);
    if (found.empty()) {
      problems.add(key, fmt::format("'{}' was not found; tried {}", g.insert.file.string(), fmt::join(tried, ", ")));
    } else {
      g.insert.file = found;
      try {
        read_insert_file(g.insert);
      } catch (std::runtime_error const& error) {
        problems.add(key, error.what());
      }
    }
    if (g.count < 0) g.count = static_cast<int>(g.insert.position.size());
  }
}

void resolve_files(Case& c, std::filesystem::path const& share, CaseProblems& problems) {
  auto const resolved = [&](std::filesystem::path const& file, std::string const& key) {
    std::vector<std::string> tried;
    std::filesystem::path const found = find_file(file, c.file.parent_path(), share, tried);
    if (found.empty())
      problems.add(key, fmt::format("'{}' was not found; tried {}", file.string(), fmt::join(tried, ", ")));
    return found.empty() ? file : found;
  };
  for (std::size_t i = 0; i < c.library.size(); ++i)
    if (!c.library[i].file.empty())  // else already reported
      c.library[i].file = resolved(c.library[i].file, fmt::format("library.{}.file", i));
  for (std::size_t i = 0; i < c.wall.size(); ++i)
    if (!c.wall[i].file.empty()) c.wall[i].file = resolved(c.wall[i].file, fmt::format("wall.{}.file", i));
  for (std::size_t i = 0; i < c.grains.size(); ++i)
    for (std::string& word : c.grains[i].shapes)
      if (std::filesystem::path const file = mesh_file_of(word); !file.empty())
        word = mesh_word + resolved(file, fmt::format("grains.{}.shapes", i)).string();
}

// One key inside the other: a wrong table makes its keys wrong too.
bool related(std::string const& a, std::string const& b) {
  std::string const& shorter = a.size() < b.size() ? a : b;
  std::string const& longer = a.size() < b.size() ? b : a;
  return longer.starts_with(shorter) && (longer.size() == shorter.size() || longer[shorter.size()] == '.');
}

std::vector<std::string> message_lines(Case const& c, CaseProblems const& problems) {
  std::vector<std::pair<int, std::string>> lines;
  for (CaseProblem const& p : problems.found) {
    CaseProblems::Place const place = problems.place_of(p.key);
    lines.emplace_back(place.line, fmt::format("{}: {}: {}", place.where, key_by_name(c, p.key), p.text));
  }
  std::stable_sort(lines.begin(), lines.end(), [](auto const& a, auto const& b) { return a.first < b.first; });
  std::vector<std::string> out;
  for (auto const& [line, text] : lines) out.push_back(text);
  return out;
}

Case case_of(CaseNode root, std::filesystem::path const& file, std::vector<std::string> const& overrides,
             std::filesystem::path const& share) {
  std::vector<std::string> messages;
  for (std::string const& assignment : overrides) apply_override(root, assignment, messages);
  Case c;
  c.file = file;
  c.name = file.stem().string();
  CaseProblems problems;
  problems.documented = [](std::string const& path) { return find_case_key(path) != nullptr; };
  read_case(CaseReader(root, "", problems), c);
  read_insert_files(c, share, problems);
  // Values that could not be read keep their defaults: judging those would only repeat the complaint.
  std::size_t const unread = problems.found.size();
  for (CaseProblem& p : check_case(c)) {
    bool const repeated = std::any_of(problems.found.begin(), problems.found.begin() + unread,
                                      [&](CaseProblem const& q) { return related(p.key, q.key); });
    if (!repeated) problems.found.push_back(std::move(p));
  }
  resolve_files(c, share, problems);
  for (std::string& line : message_lines(c, problems)) messages.push_back(std::move(line));
  if (!messages.empty()) throw InputError(std::move(messages));
  return c;
}

}  // namespace

std::filesystem::path mesh_file_of(std::string const& shape_word) {
  return shape_word.starts_with(mesh_word) ? shape_word.substr(mesh_word.size()) : "";
}

InputError::InputError(std::vector<std::string> found)
    : std::runtime_error(fmt::format("{}", fmt::join(found, "\n"))), problems(std::move(found)) {}

Case load_case(std::filesystem::path const& file, std::vector<std::string> const& overrides,
               std::filesystem::path const& share) {
  return case_of(parse_case_file(file), file, overrides, share);
}

Case case_from_text(std::string const& text, std::filesystem::path const& file) {
  return case_of(parse_case_text(text, file.string()), file, {}, {});
}

std::vector<AskedKey> keys_asked(std::string const& text) {
  CaseNode const root = parse_case_text(text, "");
  Case c;
  std::vector<AskedKey> asked;
  CaseProblems problems;
  problems.asked = &asked;
  read_case(CaseReader(root, "", problems), c);
  return asked;
}

}  // namespace scree

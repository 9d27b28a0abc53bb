// picked_case.cpp: see picked_case.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/picked_case.h"

#include <fmt/format.h>

#include "core/case_tree.h"
#include "tools/machine_costs.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

// Node counts and safety of an effective case; false where it is of another case.
bool take_picks(fs::path const& effective, Case& c) {
  CaseNode const root = parse_case_file(effective);
  CaseNode const* const grains = root.find("grains");
  CaseNode const* const time = root.find("time");
  CaseNode const* const safety = time ? time->find("safety") : nullptr;
  if (!grains || !safety || grains->element.size() != c.grains.size()) return false;
  for (std::size_t i = 0; i < c.grains.size(); ++i) {
    CaseNode const* const nodes = grains->element[i].find("nodes");
    if (!nodes) return false;
    if (!c.grains[i].nodes_given) c.grains[i].nodes = static_cast<int>(nodes->integer);
  }
  if (!c.time.safety_given) c.time.safety = safety->real;
  c.accuracy.reset();
  return true;
}

}  // namespace

PickedCase load_picked_case(CaseArguments const& arguments, fs::path const& earlier) {
  PickedCase out{load_case(arguments.file, arguments.overrides, arguments.share), {}, {}};
  if (!out.c.accuracy) return out;
  fs::path const effective = earlier / "case.effective.toml";
  if (!earlier.empty() && fs::exists(effective) && take_picks(effective, out.c)) {
    out.words = {"accuracy: node counts and step as picked when the run began, from " + effective.string()};
    return out;
  }
  AccuracyOptions options;
  options.threads = choose_threads(arguments);
  out.pick = pick_accuracy(out.c, machine_costs(), options);
  out.c = with_pick(out.c, *out.pick);
  out.words = pick_in_words(*out.pick);
  return out;
}

std::string effective_text(PickedCase const& picked) {
  std::string out;
  for (std::string const& line : picked.words) out += "# " + line + "\n";
  return out + to_toml(picked.c);
}

}  // namespace scree

// expected_figures.cpp: see expected_figures.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/expected_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/case.h"
#include "core/case_reader.h"

namespace scree {
namespace {

void read_figure(CaseReader r, ExpectedFigure& out) {
  r.text("name", out.name, Need::required);
  r.choice<bool>("of", out.mean, {{"last", false}, {"mean", true}});
  r.number("value", out.value, Need::required);
  r.number("spread", out.spread);
  if (r.number("tolerance", out.tolerance, Need::required) && !(out.tolerance >= 0))
    r.report("tolerance", fmt::format("{} must be >= 0", out.tolerance));
  std::string unit;  // for the reader
  int seeds = 0;
  r.text("unit", unit);
  r.integer("seeds", seeds);
  r.finish();
}

}  // namespace

std::vector<ExpectedFigure> read_expected(std::filesystem::path const& file) {
  CaseNode const root = parse_case_file(file);
  CaseProblems problems;
  CaseReader reader(root, "", problems);
  std::vector<ExpectedFigure> out;
  for (CaseReader const& entry : reader.tables("expected")) read_figure(entry, out.emplace_back());
  reader.finish();
  if (out.empty() && problems.found.empty()) throw InputError({file.string() + ": holds no [[expected]] entry"});
  std::vector<std::string> lines;
  for (CaseProblem const& p : problems.found)
    lines.push_back(fmt::format("{}: {}: {}", problems.place_of(p.key).where, p.key, p.text));
  if (!lines.empty()) throw InputError(std::move(lines));
  return out;
}

std::vector<FigureCheck> check_figures(std::vector<ExpectedFigure> const& expected,
                                       std::vector<MeasureSummary> const& measured) {
  std::vector<FigureCheck> out;
  for (ExpectedFigure const& e : expected) {
    FigureCheck check{e, "", std::numeric_limits<double>::quiet_NaN()};
    auto const found =
        std::find_if(measured.begin(), measured.end(), [&](MeasureSummary const& m) { return m.name == e.name; });
    if (found != measured.end()) {
      check.unit = found->unit;
      check.measured = e.mean ? found->mean : found->last;
    }
    check.ok = std::abs(check.measured - e.value) <= e.tolerance;  // false for NaN
    out.push_back(check);
  }
  return out;
}

}  // namespace scree

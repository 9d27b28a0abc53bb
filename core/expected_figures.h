// expected_figures.h: expected.toml, the figures that a run of a case must reproduce, and the comparison.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/results.h"

namespace scree {

struct ExpectedFigure {
  std::string name;      // "measure.quantity"
  bool mean = false;     // of the window; else the last value
  double value = 0;      // in the unit of the quantity
  double spread = 0;     // standard deviation over seeds
  double tolerance = 0;  // allowed |measured - value|
};

// [[expected]] entries. Throws InputError with all problems.
std::vector<ExpectedFigure> read_expected(std::filesystem::path const& file);

struct FigureCheck {
  ExpectedFigure expected;
  std::string unit;
  double measured = 0;  // NaN: not measured, or undefined
  bool ok = false;
};
std::vector<FigureCheck> check_figures(std::vector<ExpectedFigure> const& expected,
                                       std::vector<MeasureSummary> const& measured);

}  // namespace scree

// book.h: entries of the validation book: what was expected, what was measured, and whether that is good enough.
// Every entry is one test of scree-book; its rows also go to a CSV file, which `scree validate` prints.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace scree::book {

enum class Bound {
  relative,  // |measured - expected| <= tolerance |expected|
  absolute,  // |measured - expected| <= tolerance, in the figure's unit
  at_most,   // measured <= expected
  at_least,  // measured >= expected
  trend,     // reported only: no source gives a value yet
};

struct Row {
  std::string figure;  // with its conditions: "restitution, zeta 0.4, 3 m/s"
  std::string unit;    // "" for a number
  Bound bound = Bound::trend;
  double expected = 0;   // a closed form, a published figure or a limit
  double measured = 0;   // NaN never passes
  double tolerance = 0;  // of relative and absolute bounds
  bool passed() const;
};

// A curve for the page of plots: what is expected and what was measured at x.
struct CurvePoint {
  std::string curve;  // "overlap [m] against height [m]": y and x with their units
  double x = 0, expected = 0, measured = 0;
};

// `scree validate --full`: long variants (1e6 steps, fine nodes, all shapes). Off: sizes for CI, seconds an entry.
bool full();

// Collects the rows of one entry. When it goes out of scope its rows are written to the file in SCREE_BOOK_CSV (and
// its curves to SCREE_BOOK_CURVES), and rows that do not pass fail the running test.
class Entry {
 public:
  // part: "validation" or "hard"; id: number in the list or a short name, part of the test's name; title: one line;
  // source: where the expected values come from, e.g. "Chung & Ooi (2011), test 1" or "closed form".
  Entry(std::string part, std::string id, std::string title, std::string source);
  ~Entry();
  Entry(Entry const&) = delete;
  Entry& operator=(Entry const&) = delete;

  // Each adds one row and says whether it passes.
  bool relative(std::string const& figure, std::string const& unit, double expected, double measured, double tolerance);
  bool absolute(std::string const& figure, std::string const& unit, double expected, double measured, double tolerance);
  bool at_most(std::string const& figure, std::string const& unit, double measured, double limit);
  bool at_least(std::string const& figure, std::string const& unit, double measured, double limit);
  void trend(std::string const& figure, std::string const& unit, double measured);
  void point(std::string const& curve, double x, double expected, double measured);

  std::vector<Row> const& rows() const { return rows_; }
  bool passed() const;  // every row so far

  // The physics of this entry is wrong on purpose: its rows fail nobody and are written nowhere. The caller asserts
  // !passed(), which shows that the book notices.
  void expect_to_fail() { wrong_on_purpose_ = true; }

 private:
  bool add(Row row);
  std::string part_, id_, title_, source_;
  std::vector<Row> rows_;
  std::vector<CurvePoint> points_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool wrong_on_purpose_ = false;
};

}  // namespace scree::book

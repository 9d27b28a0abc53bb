// book.cpp: rows as test failures and as lines of CSV.
// SPDX-License-Identifier: Apache-2.0
#include "tests/validation/book.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace scree::book {
namespace {

char const* name_of(Bound bound) {
  switch (bound) {
    case Bound::relative:
      return "relative";
    case Bound::absolute:
      return "absolute";
    case Bound::at_most:
      return "at_most";
    case Bound::at_least:
      return "at_least";
    case Bound::trend:
      return "trend";
  }
  return "?";
}

// RFC 4180: quoted, quotes doubled.
std::string in_quotes(std::string const& text) {
  std::string out = "\"";
  for (char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

// Appends to the file named by an environment variable; the one who runs the book creates it with its header.
class Csv {
 public:
  explicit Csv(char const* variable) {
    if (char const* path = std::getenv(variable)) file_ = std::fopen(path, "a");
  }
  ~Csv() {
    if (file_) std::fclose(file_);
  }
  Csv(Csv const&) = delete;
  Csv& operator=(Csv const&) = delete;
  std::FILE* file() const { return file_; }

 private:
  std::FILE* file_ = nullptr;
};

}  // namespace

bool Row::passed() const {
  if (bound == Bound::trend) return true;
  if (!std::isfinite(measured) || std::isnan(expected)) return false;
  switch (bound) {
    case Bound::relative:
      return std::abs(measured - expected) <= tolerance * std::abs(expected);
    case Bound::absolute:
      return std::abs(measured - expected) <= tolerance;
    case Bound::at_most:
      return measured <= expected;
    case Bound::at_least:
      return measured >= expected;
    case Bound::trend:
      break;
  }
  return false;
}

bool full() { return std::getenv("SCREE_BOOK_FULL") != nullptr; }

Entry::Entry(std::string part, std::string id, std::string title, std::string source)
    : part_(std::move(part)), id_(std::move(id)), title_(std::move(title)), source_(std::move(source)) {}

bool Entry::add(Row row) {
  rows_.push_back(std::move(row));
  return rows_.back().passed();
}

bool Entry::relative(std::string const& figure, std::string const& unit, double expected, double measured,
                     double tolerance) {
  return add({figure, unit, Bound::relative, expected, measured, tolerance});
}

bool Entry::absolute(std::string const& figure, std::string const& unit, double expected, double measured,
                     double tolerance) {
  return add({figure, unit, Bound::absolute, expected, measured, tolerance});
}

bool Entry::at_most(std::string const& figure, std::string const& unit, double measured, double limit) {
  return add({figure, unit, Bound::at_most, limit, measured, 0});
}

bool Entry::at_least(std::string const& figure, std::string const& unit, double measured, double limit) {
  return add({figure, unit, Bound::at_least, limit, measured, 0});
}

void Entry::trend(std::string const& figure, std::string const& unit, double measured) {
  add({figure, unit, Bound::trend, std::nan(""), measured, 0});
}

void Entry::point(std::string const& curve, double x, double expected, double measured) {
  points_.push_back({curve, x, expected, measured});
}

bool Entry::passed() const {
  for (Row const& r : rows_)
    if (!r.passed()) return false;
  return true;
}

Entry::~Entry() {
  if (wrong_on_purpose_) return;
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  if (rows_.empty()) ADD_FAILURE() << part_ << ' ' << id_ << " measured nothing";
  for (Row const& r : rows_)
    if (!r.passed())
      ADD_FAILURE() << part_ << ' ' << id_ << ": " << r.figure << " is " << r.measured << ' ' << r.unit << "; "
                    << name_of(r.bound) << ' ' << r.expected << " (tolerance " << r.tolerance << "), " << source_;
  // part,id,title,figure,unit,bound,expected,measured,tolerance,passed,source,seconds
  if (Csv csv("SCREE_BOOK_CSV"); csv.file())
    for (Row const& r : rows_)
      std::fprintf(csv.file(), "%s,%s,%s,%s,%s,%s,%.9g,%.9g,%.9g,%d,%s,%.2f\n", part_.c_str(), in_quotes(id_).c_str(),
                   in_quotes(title_).c_str(), in_quotes(r.figure).c_str(), in_quotes(r.unit).c_str(), name_of(r.bound),
                   r.expected, r.measured, r.tolerance, r.passed() ? 1 : 0, in_quotes(source_).c_str(), seconds);
  // part,id,curve,x,expected,measured
  if (Csv csv("SCREE_BOOK_CURVES"); csv.file())
    for (CurvePoint const& p : points_)
      std::fprintf(csv.file(), "%s,%s,%s,%.9g,%.9g,%.9g\n", part_.c_str(), in_quotes(id_).c_str(),
                   in_quotes(p.curve).c_str(), p.x, p.expected, p.measured);
}

}  // namespace scree::book

// book_table.cpp: see book_table.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/book_table.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace scree {

char const book_rows_header[] = "part,id,title,figure,unit,bound,expected,measured,tolerance,passed,source,seconds\n";
char const book_curves_header[] = "part,id,curve,x,expected,measured\n";

namespace {

std::size_t constexpr columns = 12;

// Records of comma-separated text; a quoted field may hold commas, doubled quotes and line ends.
std::vector<std::vector<std::string>> csv_records(std::string const& text) {
  std::vector<std::vector<std::string>> records;
  std::vector<std::string> record;
  std::string field;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    char const c = text[i];
    if (quoted) {
      bool const doubled = c == '"' && i + 1 < text.size() && text[i + 1] == '"';
      if (c != '"' || doubled) field += c;
      if (doubled) ++i;
      if (c == '"' && !doubled) quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',' || c == '\n') {
      record.push_back(std::exchange(field, {}));
      if (c == '\n') records.push_back(std::exchange(record, {}));
    } else {
      field += c;
    }
  }
  if (!field.empty() || !record.empty()) {  // a line without its end: whoever wrote it did not get further
    record.push_back(field);
    records.push_back(record);
  }
  return records;
}

// What a figure may be, in words a reader can check: "7.11 +- 1 %", "<= 0.001".
std::string allowed(BookRow const& r) {
  if (r.bound == "relative") return fmt::format("+- {:.3g} %", 100 * r.tolerance);
  if (r.bound == "absolute") return fmt::format("+- {:.3g}", r.tolerance);
  if (r.bound == "at_most") return "at most";
  if (r.bound == "at_least") return "at least";
  return "";
}

}  // namespace

std::string csv_quoted(std::string const& text) {
  std::string out = "\"";
  for (char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

std::vector<BookRow> read_book_rows(std::filesystem::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string const text{std::istreambuf_iterator<char>(stream), {}};
  std::vector<BookRow> rows;
  for (std::vector<std::string> const& f : csv_records(text)) {
    auto const refuse = [&] {
      throw std::runtime_error(fmt::format("{}: row {} is not one of the book", file.string(), rows.size() + 1));
    };
    if (f.size() != columns) refuse();
    try {
      rows.push_back({f[0], f[1], f[2], f[3], f[4], f[5], std::stod(f[6]), std::stod(f[7]), std::stod(f[8]),
                      f[9] == "1", f[10], std::stod(f[11])});
    } catch (std::logic_error const&) {
      refuse();
    }
  }
  return rows;
}

std::string book_row_line(BookRow const& r) {
  return fmt::format("{},{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:d},{},{:.2f}\n", r.part, csv_quoted(r.id),
                     csv_quoted(r.title), csv_quoted(r.figure), csv_quoted(r.unit), r.bound, r.expected, r.measured,
                     r.tolerance, r.passed, csv_quoted(r.source), r.seconds);
}

std::string book_table(std::vector<BookRow> const& rows) {
  std::string out;
  BookRow const* last = nullptr;
  for (BookRow const& r : rows) {
    if (!last || r.part != last->part || r.id != last->id || r.title != last->title) {
      out += fmt::format("\n{} {}: {}\n  ({}; {:.1f} s)\n", r.part, r.id, r.title, r.source, r.seconds);
      out += fmt::format("  {:<66} {:>6} {:>11} {:>11} {:>10}\n", "figure", "unit", "expected", "measured", "allowed");
    }
    std::string const expected = r.bound == "trend" ? "trend" : fmt::format("{:.5g}", r.expected);
    out +=
        fmt::format("  {:<66} {:>6} {:>11} {:>11.5g} {:>10}  {}\n", r.figure, r.unit, expected, r.measured, allowed(r),
                    r.bound == "trend" ? "-"
                    : r.passed         ? "pass"
                                       : "FAIL");
    last = &r;
  }
  return out;
}

}  // namespace scree

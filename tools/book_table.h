// book_table.h: rows of the validation book as scree-book writes them, and the table that `scree validate` prints.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace scree {

// First lines of the two files of the book; the columns are those of tests/validation/book.cpp.
extern char const book_rows_header[];
extern char const book_curves_header[];

struct BookRow {
  std::string part, id, title, figure, unit;
  std::string bound;  // "relative", "absolute", "at_most", "at_least", "trend"
  double expected = 0, measured = 0, tolerance = 0;
  bool passed = false;
  std::string source;
  double seconds = 0;  // of the whole entry
};

// RFC 4180: quoted, quotes doubled.
std::string csv_quoted(std::string const& text);

// Rows of a file without a header; none when it is not there. Throws std::runtime_error naming the file and the line
// that is not such a row.
std::vector<BookRow> read_book_rows(std::filesystem::path const& file);
std::string book_row_line(BookRow const& row);  // as read_book_rows reads it, with its line end

// Entry by entry: id, title and source, then its figures: expected, measured, allowed, pass or FAIL.
std::string book_table(std::vector<BookRow> const& rows);

}  // namespace scree

// csv_file.h: tables of results: a header line, then a line a row.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace scree {

class CsvFile {
 public:
  // Replaces the file. Throws std::system_error naming it.
  CsvFile(std::filesystem::path const& file, std::vector<std::string> const& columns);

  // One cell a column, else std::logic_error: numbers with five digits, text quoted where it must be (RFC 4180).
  template <class... Cells>
  void row(Cells const&... cells) {
    write({text(cells)...});
  }
  void write(std::vector<std::string> const& cells);

  static std::string text(double value);
  static std::string text(int value) { return std::to_string(value); }
  static std::string text(std::string const& value);

 private:
  std::filesystem::path file_;
  std::ofstream out_;
  std::size_t columns_;
};

}  // namespace scree

// csv_file.cpp: tables of results.
// SPDX-License-Identifier: Apache-2.0
#include "training/studies/csv_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

namespace scree {

CsvFile::CsvFile(std::filesystem::path const& file, std::vector<std::string> const& columns)
    : file_(file), out_(file), columns_(columns.size()) {
  write(columns);
}

void CsvFile::write(std::vector<std::string> const& cells) {
  if (cells.size() != columns_) throw std::logic_error(file_.string() + ": a row of another length than the header");
  out_ << fmt::format("{}\n", fmt::join(cells, ",")) << std::flush;
  if (!out_) throw std::system_error(errno, std::generic_category(), file_.string());
}

std::string CsvFile::text(double value) { return fmt::format("{:.5g}", value); }

std::string CsvFile::text(std::string const& value) {
  if (value.find_first_of(",\"\n") == std::string::npos) return value;
  std::string quoted = "\"";
  for (char c : value) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace scree

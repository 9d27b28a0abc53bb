// scree_energy.cpp: `scree energy`: the ledger of a results file as a picture.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "core/case.h"
#include "core/results.h"
#include "core/results_layout.h"
#include "tools/plot_script.h"
#include "tools/scree_commands.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

// The ledger as comma-separated values, first line the columns' names: what the script draws.
class LedgerTable {
 public:
  LedgerTable(std::vector<std::string> const& more, std::vector<LedgerRow> const& rows)
      : file_(fs::temp_directory_path() / fmt::format("scree_energy_{}.csv", ::getpid())) {
    std::ofstream out(file_);
    char const* separator = "";
    std::vector<results_layout::LedgerColumn> const columns = results_layout::columns_with(more);
    for (auto const& column : columns) out << std::exchange(separator, ",") << column.name;
    for (LedgerRow const& row : rows) {
      separator = "\n";
      for (auto const& column : columns)
        out << std::exchange(separator, ",") << fmt::format("{:.17g}", row.*column.value);
    }
    if (!out.flush()) throw std::system_error(EIO, std::generic_category(), file_.string() + ": cannot be written");
  }
  ~LedgerTable() {
    std::error_code ignored;
    fs::remove(file_, ignored);
  }
  std::string file() const { return file_.string(); }

 private:
  fs::path file_;
};

}  // namespace

int energy_command(EnergyArguments const& arguments) {
  std::string const end = arguments.picture.extension().string();
  if (end != ".png" && end != ".svg") throw InputError({arguments.picture.string() + ": write a .png or .svg"});
  ResultsReader const reader(arguments.results, arguments.recover);
  std::vector<LedgerRow> const rows = reader.ledger();
  if (rows.size() < 2)
    throw InputError({fmt::format("{}: its ledger has {} rows: nothing to draw; a smaller output.every gives more",
                                  arguments.results.string(), rows.size())});
  LedgerTable const table(reader.header().ledger, rows);
  std::string const trouble =
      run_plot_script(plot_energy_text, {table.file(), arguments.picture.string(), arguments.results.string()});
  if (!trouble.empty()) throw std::runtime_error("no picture: " + trouble);
  LedgerRow const& last = rows.back();
  fmt::print("picture   {}: {} rows to t = {:g} s, residual at the end {:.3g} J, energy moved {:.3g} J\n",
             arguments.picture.string(), rows.size(), last.time, last.residual, last.moved);
  return exit_ok;
}

}  // namespace scree

// scree_page.cpp: `scree report`: one self-contained HTML page about the run in an output folder.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "core/case.h"
#include "core/render.h"
#include "shapes/whole_file.h"
#include "tools/report_page.h"
#include "tools/scree_commands.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

// Empty where there is none: an older run, or one without measurements.
std::string text_of(fs::path const& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return in ? text.str() : "";
}

// The case's own name, or that of the folder.
std::string title_of(ResultsHeader const& header, fs::path const& folder) {
  std::string const key = "name = \"";
  std::size_t const from = header.case_text.find(key, header.case_text.find("[case]"));
  std::size_t const end = from == std::string::npos ? from : header.case_text.find('"', from + key.size());
  if (end != std::string::npos) return header.case_text.substr(from + key.size(), end - from - key.size());
  return (fs::absolute(folder) / "").parent_path().filename().string();
}

}  // namespace

int report_command(ReportArguments const& arguments) {
  bool const is_folder = fs::is_directory(arguments.folder);
  fs::path const folder = is_folder ? arguments.folder : arguments.folder.parent_path();
  fs::path const file = is_folder ? arguments.folder / "results.h5" : arguments.folder;
  ResultsReader const results(file, arguments.recover);
  if (results.frames() == 0) throw InputError({fmt::format("{}: the run has no frames yet", file.string())});
  CaseArguments machine;
  machine.threads = arguments.threads;
  RenderOptions options;
  options.threads = choose_threads(machine);
  options.width = 1120, options.height = 840;
  ReportPage page;
  page.results = &results;
  page.threads = options.threads;
  page.picture = render(results.header(), results.frame(-1), options).image;
  page.run_json = text_of(folder / "stages.json");
  page.measures_csv = text_of(folder / "measures.csv");
  page.title = title_of(results.header(), folder);
  fs::path const target = arguments.page.empty() ? folder / "report.html" : arguments.page;
  std::string const html = report_page(page);
  replace_whole_file(target, html);
  fmt::print("report    {}: {:.2f} MB, needs no network\n", target.string(), 1e-6 * static_cast<double>(html.size()));
  return exit_ok;
}

}  // namespace scree

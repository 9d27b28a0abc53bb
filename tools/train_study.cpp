// train_study.cpp: scree-train study and dataset: the reference paper's figures, and the benchmark sets as files.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <system_error>

#include "tools/guarded.h"
#include "tools/plot_script.h"
#include "tools/train_commands.h"
#include "training/studies/dataset_files.h"
#include "training/studies/study.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct StudyArguments {
  std::string name;
  bool list = false, plot_only = false;
  StudyOptions study;
};

void make_folder(fs::path const& folder) {
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw std::invalid_argument(folder.string() + " is a file; name a folder");
  fs::create_directories(folder);
}

int run_study(StudyArguments const& a) {
  if (a.list) {
    for (Study const& study : studies()) fmt::print("{:<18} {:<12} {}\n", study.name, study.figure, study.subject);
    return exit_ok;
  }
  std::vector<Study> chosen = studies();
  if (a.name != "all") chosen = {find_study(a.name)};
  make_folder(a.study.folder);
  for (Study const& study : chosen) {
    auto const start = std::chrono::steady_clock::now();
    if (!a.plot_only) study.run(a.study);
    std::string const trouble = run_plot_script(plot_study_text, {study.name, a.study.folder.string()});
    double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fs::path const file = a.study.folder / study.name;
    if (trouble.empty())
      fmt::print("{} ({}): {}.csv and .png, {:.0f} s\n", study.name, study.figure, file.string(), seconds);
    else
      fmt::print("{} ({}): {}.csv, {:.0f} s; no picture: {}; then add --plot-only\n", study.name, study.figure,
                 file.string(), seconds, trouble);
  }
  return exit_ok;
}

}  // namespace

void add_study_command(CLI::App& app, std::function<int()>& chosen) {
  auto const a = std::make_shared<StudyArguments>();
  a->study.folder = "studies";
  CLI::App* const c = app.add_subcommand("study", "A figure of the reference paper as CSV files and pictures");
  CLI::Option* const list = c->add_flag("--list", a->list, "Names of the studies");
  c->add_option("name", a->name, "Which (see --list), or all");
  c->add_flag("--quick", a->study.quick, "Seconds instead of minutes; shows how it works, not how good it is");
  c->add_flag("--plot-only", a->plot_only, "Draw the picture again from the CSV files");
  c->add_option("-o,--output", a->study.folder, "Folder for CSV files and pictures")->capture_default_str();
  c->add_option("--library", a->study.library,
                "Model file of the 20 grains for coded-grains, interpolation and latent; else it is trained")
      ->check(CLI::ExistingFile);
  c->add_option("--threads", a->study.threads, "CPU threads")->check(CLI::Range(1, 256))->capture_default_str();
  c->callback([a, list, &chosen] {
    if (a->name.empty() && list->empty()) throw CLI::RequiredError("name");
    chosen = [a] { return run_study(*a); };
  });
}

void add_dataset_command(CLI::App& app, std::function<int()>& chosen) {
  struct Arguments {
    std::string name;
    fs::path folder;
    int cells = 24;
  };
  auto const a = std::make_shared<Arguments>();
  CLI::App* const c = app.add_subcommand("dataset", "A benchmark set as meshes (STL) and a table of their form (CSV)");
  c->add_option("name", a->name, "superellipsoids125 or grains20")->required()->check(CLI::IsMember(dataset_names()));
  c->add_option("-o,--output", a->folder, "Folder")->required();
  c->add_option("--cells", a->cells, "Fineness of the superellipsoids: about 18 cells^2 triangles each")
      ->check(CLI::Range(8, 96))
      ->capture_default_str();
  c->callback([a, &chosen] {
    chosen = [a] {
      make_folder(a->folder);
      int const shapes = write_dataset(a->name, a->folder, a->cells);
      fmt::print("{}: {} shapes, table {}.csv\n", a->folder.string(), shapes, a->name);
      return exit_ok;
    };
  });
}

}  // namespace scree

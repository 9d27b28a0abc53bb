// scree_commands.h: the commands of the `scree` program; each returns the program's exit code.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/simulation.h"

namespace scree {

enum ExitCode : int {
  exit_ok = 0,
  exit_watch =
      1,  // a physics watch stopped the run, the state is written; or figures are not the expected, or the book failed
  exit_bad_input = 2,     // case, model, results file or usage
  exit_device = 3,        // the device asked for is not there
  exit_file = 4,          // a file or folder cannot be written or is in use
  exit_interrupted = 130  // SIGINT or SIGTERM; a checkpoint is written, the files are complete up to that moment
};

struct CaseArguments {
  std::filesystem::path file;
  std::vector<std::string> overrides;  // key=value
  std::filesystem::path share;         // where installed libraries lie
  std::string device = "auto";         // cpu, cuda, auto
  int threads = 0;                     // 0: all cores
};

struct RunArguments {
  CaseArguments scene;
  std::filesystem::path output;  // empty: <case>.out in the current folder
  bool force = false;
  bool resume = false;  // from the newest checkpoint in the output folder
  bool quiet = false;
};

struct RenderArguments {
  std::filesystem::path results, picture, ids;  // ids: body numbers as colours; empty: none
  int frame = -1;
  std::string size = "1280x960";
  std::optional<double> azimuth, elevation;  // of the camera [deg]; none: its own choice
  std::string frames;                        // "first:last[:step]": a sequence; empty: `frame` alone
  std::string colour = "kind";               // see core/render_colours.h
  double colour_limit = 0;                   // of a scale; 0: the largest value in the (first) frame
  std::vector<double> cut;                   // point and normal of a plane, 6 numbers; empty: none
  std::string device = "auto";               // cpu, cuda, auto: evaluates the networks
  int threads = 0;
  bool recover = false;
};

struct EnergyArguments {
  std::filesystem::path results, picture;  // .png or .svg
  bool recover = false;
};

struct InfoArguments {
  std::filesystem::path file;      // results or model
  std::filesystem::path expected;  // figures the run must reproduce, see core/expected_figures.h; empty: not asked
  bool figures = false;            // what was measured, as comma-separated values
  bool recover = false;
  bool overlap = false;  // measure the overlaps of a frame, see core/overlap_meter.h
  int points = 20000;    // a grain
  int frame = -1;
  int threads = 0;
};

struct ExportArguments {
  std::filesystem::path results, folder;  // folder empty: "paraview" beside the results
  bool recover = false;
  bool vtkhdf = false;         // one file, `folder`, instead of a folder
  bool surfaces = false;       // mesh files instead of ParaView's; `folder` is then a file, or a folder with per_grain
  bool per_grain = false;      // one file a grain
  bool walls = false;          // the walls, too
  bool force = false;          // replace existing mesh files
  std::string format = "stl";  // stl, ply, obj
  int frame = -1;
  int triangles = 1280;  // a grain
};

struct EnvelopesArguments {
  std::vector<std::filesystem::path> results;  // pooled
  std::filesystem::path folder;                // of tables and pictures
  std::vector<double> direction;               // x, y, z of the run-out; empty: the case's
  double bin = 0;                              // [m]; 0: chosen
  bool force = false;                          // replace existing tables
  bool recover = false;
};

struct ReportArguments {
  std::filesystem::path folder, page;  // of a run; page empty: report.html in it
  int threads = 0;
  bool recover = false;
};

struct ValidateArguments {
  std::vector<std::string> names;  // of entries, see tools/book_process.h; empty: all
  std::filesystem::path output = "validation.out";
  bool full = false;  // long variants, too
  bool list = false;  // print names only
  int threads = 0;    // entries at once; 0: all cores
};

struct CostArguments {
  std::filesystem::path output = "cost.out";
  std::filesystem::path library, share;     // grains.h5; empty: looked for; where installed libraries lie
  std::vector<std::filesystem::path> nets;  // more networks of the same body
  std::vector<int> nodes;                   // a grain; empty: 250 to 16,000
  bool large = false;                       // 64,000 nodes, too, compared with 256,000
  bool quick = false;                       // seconds, for figures that mean nothing
  int promise = 0;                          // instead: settings in which [accuracy] has to keep its word
  int seed = 1;                             // of the list of settings
  int from = 0;                             // first of the promise's settings: long trials can be run in parts
  int threads = 1;                          // of the promise; costs are of one thread
};

int run_command(RunArguments const& arguments);
int plan_command(CaseArguments const& arguments);
int check_command(CaseArguments const& arguments);
int keys_command(std::string const& prefix);
int info_command(InfoArguments const& arguments);
int render_command(RenderArguments const& arguments);
int energy_command(EnergyArguments const& arguments);
int report_command(ReportArguments const& arguments);
int export_command(ExportArguments const& arguments);
int envelopes_command(EnvelopesArguments const& arguments);
int validate_command(ValidateArguments const& arguments);
int cost_command(CostArguments const& arguments);
int promise_command(CostArguments const& arguments);    // where arguments.promise is set
int export_surfaces(ExportArguments const& arguments);  // where arguments.surfaces is set

// Threads to use: all cores unless the user says otherwise.
int choose_threads(CaseArguments const& arguments);

// Where a case runs. `cuda` without a usable device throws DeviceError; `auto` then falls back to the CPU. `note` says
// what was chosen and why.
SimulationOptions choose_backend(CaseArguments const& arguments, std::string* note = nullptr);

}  // namespace scree

// scree.cpp: the engine's program: run, plan, check, keys, info, energy, render, report, export,
// envelopes, validate, cost.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <iostream>
#include <new>
#include <system_error>

#include "core/case.h"
#include "kernels/base/build_info.h"
#include "kernels/base/device.h"
#include "kernels/sdf/sdf_batch.h"
#include "tools/scree_commands.h"

namespace {

using namespace scree;

std::string version() {
  BuildInfo const& b = build_info();
  return fmt::format("scree {} (commit {}, {}, {}; sdf kernels: {}; parts: {})", b.version, b.commit, b.compiler,
                     b.build_type, sdf_isa(), b.features[0] ? b.features : "engine only");
}

// <prefix>/bin/scree -> <prefix>/share/scree
std::filesystem::path share_folder() {
  std::error_code error;
  std::filesystem::path const program = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::filesystem::path() : program.parent_path().parent_path() / "share" / "scree";
}

void add_machine_options(CLI::App& command, std::string& device, int& threads) {
  command.add_option("--device", device, "cpu, cuda or auto")
      ->check(CLI::IsMember({"cpu", "cuda", "auto"}))
      ->capture_default_str();
  command.add_option("--threads", threads, "CPU threads (default: all cores)")->check(CLI::Range(1, 4096));
}

void add_case_options(CLI::App& command, CaseArguments& arguments) {
  command.add_option("case", arguments.file, "Case file (TOML)")->required();
  command.add_option("--set", arguments.overrides, "Override a key: time.end=2, grains.mix.count=50; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  add_machine_options(command, arguments.device, arguments.threads);
  arguments.share = share_folder();
}

void add_run(CLI::App& app, RunArguments& a, std::function<int()>& chosen) {
  CLI::App* const c = app.add_subcommand("run", "Run a case");
  add_case_options(*c, a.scene);
  c->add_option("-o,--output", a.output, "Output folder (default: <case>.out)");
  CLI::Option* const force =
      c->add_flag("--force", a.force, "Replace the results of an earlier run in the output folder");
  c->add_flag("--resume", a.resume,
              "Go on from the newest whole checkpoint in the output folder; from the start where there is no run yet")
      ->excludes(force);
  c->add_flag("-q,--quiet", a.quiet, "No progress, only warnings and the final summary");
  c->callback([&] { chosen = [&] { return run_command(a); }; });
}

void add_plan(CLI::App& app, CaseArguments& a, std::function<int()>& chosen) {
  CLI::App* const plan = app.add_subcommand("plan", "Print stages, law, memory and time step of a case");
  add_case_options(*plan, a);
  plan->callback([&] { chosen = [&] { return plan_command(a); }; });
}

void add_check(CLI::App& app, CaseArguments& a, std::function<int()>& chosen) {
  CLI::App* const check = app.add_subcommand("check", "Check a case and the model files it names");
  add_case_options(*check, a);
  check->callback([&] { chosen = [&] { return check_command(a); }; });
}

void add_keys(CLI::App& app, std::string& prefix, std::function<int()>& chosen) {
  CLI::App* const c = app.add_subcommand("keys", "Print the reference of the case file's keys (Markdown)");
  c->add_option("prefix", prefix, "Only keys that start with it: wall, grains.insert (default: all)");
  c->callback([&] { chosen = [&] { return keys_command(prefix); }; });
}

void add_info(CLI::App& app, InfoArguments& a, std::function<int()>& chosen) {
  CLI::App* const c = app.add_subcommand("info", "Describe a results or model file");
  c->add_option("file", a.file, "results.h5 or model.h5")->required();
  c->add_flag("--recover", a.recover, "Read the unfinished file of a run that was killed");
  CLI::Option* const overlap = c->add_flag(
      "--overlap", a.overlap, "Measure how deep grains are in each other and in walls, apart from the nodes");
  c->add_option("--points", a.points, "Surface points a grain of that measurement")
      ->check(CLI::Range(100, 10'000'000))
      ->capture_default_str()
      ->needs(overlap);
  c->add_option("--frame", a.frame, "Frame of that measurement; negative counts from the end")
      ->capture_default_str()
      ->needs(overlap);
  c->add_option("--threads", a.threads, "CPU threads of that measurement (default: all cores)")
      ->check(CLI::Range(1, 4096))
      ->needs(overlap);
  CLI::Option* const figures = c->add_flag("--figures", a.figures, "What the run measured, as comma-separated values");
  c->add_option("--expected", a.expected, "expected.toml: exit with 1 when the run does not reproduce its figures")
      ->excludes(overlap)
      ->excludes(figures);
  c->callback([&] { chosen = [&] { return info_command(a); }; });
}

void add_render(CLI::App& app, RenderArguments& a, std::function<int()>& chosen) {
  CLI::App* const c = app.add_subcommand("render", "Draw a frame of a results file");
  c->add_option("results", a.results, "results.h5")->required();
  c->add_option("-o,--output", a.picture, "Picture to write (PNG)")->required();
  c->add_option("--frame", a.frame, "Frame number; negative counts from the end")->capture_default_str();
  c->add_option("--size", a.size, "Width x height in pixels")->capture_default_str();
  c->add_option("--azimuth", a.azimuth, "Camera's direction from the scene round the vertical, 0 from +x [deg]");
  c->add_option("--elevation", a.elevation, "Camera's height above the horizon [deg]")->check(CLI::Range(-89.0, 89.0));
  c->add_option("--frames", a.frames,
                "A sequence with one camera, FIRST:LAST or FIRST:LAST:STEP; negative counts from the end. Pictures are "
                "named PICTURE-0000.png ...")
      ->excludes("--frame");
  c->add_option("--colour,--color", a.colour,
                "Of the grains: by kind, [[grains]] entry, replica, speed, spin or deepest overlap")
      ->check(CLI::IsMember({"kind", "entry", "replica", "speed", "spin", "overlap"}))
      ->capture_default_str();
  c->add_option("--colour-limit,--color-limit", a.colour_limit,
                "Speed [m/s], spin [rad/s] or overlap [d] at the bright end of the scale (default: the largest in the "
                "first frame)")
      ->check(CLI::PositiveNumber);
  c->add_option("--cut", a.cut, "Plane X,Y,Z,NX,NY,NZ [m]: grains are cut open, the side the normal points to is gone")
      ->delimiter(',')
      ->expected(6);
  c->add_option("--ids", a.ids,
                "Also write which body each pixel shows: number + 1 = red + 256 green + 65536 blue, 0: none");
  add_machine_options(*c, a.device, a.threads);
  c->add_flag("--recover", a.recover, "Read the unfinished file of a run that was killed");
  c->callback([&] { chosen = [&] { return render_command(a); }; });
}

void add_energy(CLI::App& app, EnergyArguments& a, std::function<int()>& chosen) {
  CLI::App* const c = app.add_subcommand("energy", "Draw the energy ledger of a results file over time");
  c->add_option("results", a.results, "results.h5")->required();
  c->add_option("-o,--output", a.picture, "Picture to write (.png, .svg)")->required();
  c->add_flag("--recover", a.recover, "Read the unfinished file of a run that was killed");
  c->callback([&] { chosen = [&] { return energy_command(a); }; });
}

void add_report(CLI::App& app, ReportArguments& a, std::function<int()>& chosen) {
  CLI::App* const c = app.add_subcommand("report", "Write one self-contained HTML page about a run");
  c->add_option("run", a.folder, "Output folder of the run, or its results.h5")->required()->check(CLI::ExistingPath);
  c->add_option("-o,--output", a.page, "Page to write (default: report.html in the folder)");
  c->add_option("--threads", a.threads, "CPU threads of the picture (default: all cores)")->check(CLI::Range(1, 4096));
  c->add_flag("--recover", a.recover, "Read the unfinished file of a run that was killed");
  c->callback([&] { chosen = [&] { return report_command(a); }; });
}

void add_export(CLI::App& app, ExportArguments& a, std::function<int()>& chosen) {
  CLI::App* const c = app.add_subcommand(
      "export", "Write a results file for ParaView (PVD + VTP or VTKHDF), or a frame's grains as meshes");
  c->add_option("results", a.results, "results.h5")->required();
  c->add_option("-o,--output", a.folder,
                "Folder to write (default: paraview beside the results); with --vtkhdf and --stl a file");
  CLI::Option* const vtkhdf = c->add_flag(
      "--vtkhdf", a.vtkhdf, "Write one VTKHDF time series, a point a grain, for ParaView 5.12, VTK 9.3 and later");
  CLI::Option* const stl =
      c->add_flag("--stl", a.surfaces, "Write the grains of one frame as a mesh in world coordinates")
          ->excludes(vtkhdf);
  c->add_option("--format", a.format, "Of the meshes")
      ->needs(stl)
      ->check(CLI::IsMember({"stl", "ply", "obj"}))
      ->capture_default_str();
  c->add_flag("--per-grain", a.per_grain, "One mesh file a grain, in the folder --output")->needs(stl);
  c->add_flag("--walls", a.walls, "The walls, too; an endless plane as far as the walls and grains of the case reach")
      ->needs(stl);
  c->add_option("--frame", a.frame, "Frame, negative from the end")->needs(stl)->capture_default_str();
  c->add_option("--triangles", a.triangles, "A grain")
      ->needs(stl)
      ->check(CLI::Range(20, 1000000))
      ->capture_default_str();
  c->add_flag("--force", a.force, "Replace existing meshes")->needs(stl);
  c->add_flag("--recover", a.recover, "Read the unfinished file of a run that was killed");
  c->callback([&] { chosen = [&] { return a.surfaces ? export_surfaces(a) : export_command(a); }; });
}

void add_envelopes(CLI::App& app, EnvelopesArguments& a, std::function<int()>& chosen) {
  CLI::App* const c = app.add_subcommand(
      "envelopes", "Run-out, map, energies at screens and speeds of each [[grains]] entry: tables and pictures");
  c->add_option("results", a.results, "results.h5 of one or several runs, which are pooled")->required();
  c->add_option("-o,--output", a.folder, "Folder for tables (CSV) and pictures")->required();
  c->add_option("--direction", a.direction, "Of the run-out (default: of the case's first run_out measurement)")
      ->type_name("X,Y,Z")
      ->delimiter(',')
      ->expected(3);
  c->add_option("--bin", a.bin, "Width of bins and cells, distance of the screens [m] (default: about 30 on the way)")
      ->check(CLI::PositiveNumber);
  c->add_flag("--force", a.force, "Replace existing tables");
  c->add_flag("--recover", a.recover, "Read unfinished files of runs that were killed");
  c->callback([&] { chosen = [&] { return envelopes_command(a); }; });
}

void add_validate(CLI::App& app, ValidateArguments& a, std::function<int()>& chosen) {
  CLI::App* const c = app.add_subcommand(
      "validate", "Run the validation book: known solutions and hard cases, measured against expected");
  c->add_option("names", a.names, "Entries by number (7a), part (validation, hard) or a piece of the name; none: all");
  c->add_flag("--full", a.full, "Long variants of the entries, too: hours");
  c->add_flag("--list", a.list, "Names of the entries");
  c->add_option("-o,--output", a.output, "Folder for tables, curves and plots")->capture_default_str();
  c->add_option("--threads", a.threads, "Entries at once (default: all cores)")->check(CLI::Range(1, 4096));
  c->callback([&] { chosen = [&] { return validate_command(a); }; });
}

void add_cost(CLI::App& app, CostArguments& a, std::function<int()>& chosen) {
  CLI::App* const c = app.add_subcommand(
      "cost", "Measure what accuracy costs in time on this machine: error and time of evaluators and node counts");
  c->add_option("-o,--output", a.output, "Folder for tables and the picture; its heap.h5 is used again")
      ->capture_default_str();
  c->add_option("--library", a.library, "The shipped grains.h5 (default: looked for)");
  c->add_option("--net", a.nets, "More networks to compare, each a file of scree-train fit ellipsoid:1.5:1.25:1")
      ->check(CLI::ExistingFile);
  c->add_option("--nodes", a.nodes, "Node counts a grain (default: 250,1000,4000,16000)")
      ->delimiter(',')
      ->check(CLI::Range(100, 256000));
  c->add_flag("--large", a.large, "64,000 nodes, too, compared with 256,000: an hour");
  c->add_flag("--quick", a.quick, "Seconds: shows that it works, its figures mean nothing");
  c->add_option(
       "--promise", a.promise,
       "Instead: errors of so many random settings with what [accuracy] picks for them; exit code 1 where less "
       "than 95 % keep their budget. 50 take half an hour of processor time")
      ->check(CLI::Range(1, 10000));
  c->add_option("--seed", a.seed, "Of the settings of --promise")->check(CLI::Range(1, 1000000))->capture_default_str();
  c->add_option("--from", a.from, "First setting of --promise, refused ones counted: a long trial in parts")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  c->add_option("--threads", a.threads, "Of --promise")->check(CLI::Range(1, 4096))->capture_default_str();
  a.share = share_folder();
  c->callback([&] { chosen = [&] { return a.promise > 0 ? promise_command(a) : cost_command(a); }; });
}

int complain(ExitCode code, std::string const& what) {
  std::fflush(stdout);
  fmt::print(stderr, "scree: error: {}\n", what);
  return code;
}

int complain(InputError const& error) {
  std::fflush(stdout);
  if (error.problems.size() == 1) return complain(exit_bad_input, error.problems[0]);
  fmt::print(stderr, "scree: {} errors:\n", error.problems.size());
  for (std::string const& p : error.problems) fmt::print(stderr, "  {}\n", p);
  return exit_bad_input;
}

// The one place where failures become exit codes.
int guarded(std::function<int()> const& work) {
  try {
    int const code = work();
    if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return code;
    return code != exit_ok ? code : complain(exit_file, "standard output: cannot be written; is the disk full?");
  } catch (InputError const& error) {
    return complain(error);
  } catch (DeviceError const& error) {
    return complain(exit_device, error.what());
  } catch (std::system_error const& error) {  // filesystem_error too
    return complain(exit_file, error.what());
  } catch (std::bad_alloc const&) {
    return complain(exit_bad_input, "the case does not fit into this machine's memory");
  } catch (std::invalid_argument const& error) {
    return complain(exit_bad_input, error.what());
  } catch (std::exception const& error) {
    return complain(exit_file, error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Scree: discrete elements whose surface is a signed distance field"};
  app.set_version_flag("--version", version());
  app.require_subcommand(1);
  std::function<int()> chosen;
  RunArguments run;
  CaseArguments plan, check;
  std::string keys;
  InfoArguments info;
  EnergyArguments energy;
  RenderArguments render;
  ReportArguments report;
  ExportArguments exported;
  EnvelopesArguments envelopes;
  ValidateArguments validate;
  CostArguments cost;
  add_run(app, run, chosen);
  add_plan(app, plan, chosen);
  add_check(app, check, chosen);
  add_keys(app, keys, chosen);
  add_info(app, info, chosen);
  add_energy(app, energy, chosen);
  add_render(app, render, chosen);
  add_report(app, report, chosen);
  add_export(app, exported, chosen);
  add_envelopes(app, envelopes, chosen);
  add_validate(app, validate, chosen);
  add_cost(app, cost, chosen);
  try {
    app.parse(argc, argv);
  } catch (CLI::ParseError const& error) {
    return app.exit(error) == 0 ? exit_ok : exit_bad_input;  // --help and --version come this way too
  }
  return guarded(chosen);
}

// scree_show.cpp: the commands that look and do not step: plan, check, keys, info, export.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/case.h"
#include "core/case_reference.h"
#include "core/overlap_meter.h"
#include "core/paraview.h"
#include "core/results.h"
#include "core/simulation.h"
#include "core/vtkhdf.h"
#include "shapes/file_container.h"
#include "shapes/model_file.h"
#include "tools/picked_case.h"
#include "tools/scree_commands.h"
#include "tools/scree_measures.h"
#include "tools/scree_report.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

Simulation simulation_of(CaseArguments const& arguments, Case const& c) {
  return Simulation(c, choose_backend(arguments));
}

// A certificate's figure; a negative one was not measured.
std::string figure(double value) { return value < 0 ? "-" : fmt::format("{:.2e}", value); }

void print_shapes(Library const& library) {
  fmt::print("{:<32} {:<14} {:>8} {:>8} {:>9} {:>9} {:>9} {:>9}\n", "shape", "kind", "radius", "area", "mae", "max",
             "normal95", "volume");
  for (Shape const& s : library.shape) {
    std::string const kind = s.is_net() ? fmt::format("network {}", s.net) : to_string(s.kind);
    fmt::print("{:<32} {:<14} {:>8.4f} {:>8.4f} {:>9} {:>9} {:>9} {:>9}\n", s.name, kind, s.bounding_radius, s.area,
               figure(s.certificate.mae), figure(s.certificate.max), figure(s.certificate.normal_p95),
               figure(s.certificate.volume_error));
  }
}

void print_networks(Library const& library) {
  for (std::size_t k = 0; k < library.net.size(); ++k) {
    Mlp const& net = library.net[k];
    fmt::print("network {}: widths {}, {} ({:g}), code of {} numbers\n", k, fmt::join(net.width, "-"),
               to_string(net.activation), net.parameter, net.code_size());
  }
}

void describe_model(fs::path const& file) {
  Library const library = read_model(file);
  fmt::print("{}: model file, {} shapes, {} networks; lengths in d of the equal-volume sphere, phi > 0 inside\n",
             file.string(), library.shape.size(), library.net.size());
  print_networks(library);
  print_shapes(library);
}

void describe_results(fs::path const& file, bool recover) {
  ResultsReader const reader(file, recover);
  ResultsHeader const& h = reader.header();
  fmt::print("{}: results file, {} bodies of {} shapes, {} walls, {} frames\n", file.string(), h.shape.size(),
             h.shape_name.size(), h.wall.size() + h.wall_body.size(), reader.frames());
  if (reader.frames() > 0) {
    Frame const first = reader.frame(0), last = reader.frame(-1);
    fmt::print("t {:g} ... {:g} s, step {} ... {}\n", first.time, last.time, grouped(first.step), grouped(last.step));
    if (h.activity) {
      auto const count = [&](Activity a) { return std::count(last.activity.begin(), last.activity.end(), a); };
      fmt::print("bodies at the end: {} active, {} not inserted, {} deleted\n", count(Activity::active),
                 count(Activity::pending), count(Activity::deleted));
    }
  }
  print_networks(h.library);
  print_shapes(h.library);
  std::vector<LedgerRow> const ledger = reader.ledger();
  if (!ledger.empty()) fmt::print("{}", ledger_table(ledger.back()));
  if (auto const measures = reader.measures(); !measures.empty()) fmt::print("{}", measure_table(measures));
  std::vector<StageRow> const stages = reader.stages();
  double seconds = 0;
  for (StageRow const& s : stages) seconds += s.seconds;
  if (seconds > 0) fmt::print("{}", stage_table(stages, seconds));
}

std::string wall_name(int wall, ResultsHeader const& h) {
  int const planes = static_cast<int>(h.wall.size());
  return wall < planes ? h.wall[wall].name : h.wall_body[wall - planes].name;
}

std::string place(OverlapAt const& at, ResultsHeader const& h) {
  if (at.a < 0) return "no contact";
  std::string const other = at.b < 0 ? "wall '" + wall_name(-1 - at.b, h) + "'" : fmt::format("grain {}", at.b);
  return fmt::format("{:.4f} % d, grain {} and {}", 100 * at.depth, at.a, other);
}

void print_overlap(InfoArguments const& arguments) {
  ResultsReader const reader(arguments.file, arguments.recover);
  ResultsHeader const& h = reader.header();
  int const frames = reader.frames();
  if (arguments.frame >= frames || arguments.frame < -frames)
    throw InputError(
        {fmt::format("{}: --frame {}: there are {} frames", arguments.file.string(), arguments.frame, frames)});
  Frame const frame = reader.frame(arguments.frame);
  CaseArguments machine;
  machine.threads = arguments.threads;
  OverlapReport const r = measure_overlap(h, frame, arguments.points, choose_threads(machine));
  fmt::print("overlap at t = {:g} s, {} surface points a grain, against phi in double; d of the smaller grain\n",
             frame.time, grouped(arguments.points));
  fmt::print("  grain - grain  {}\n  grain - wall   {}\n", place(r.grain_grain, h), place(r.grain_wall, h));
  fmt::print("  mean {:.4f} % d, 99th percentile {:.4f} % d of {} contacts ({} with walls), {:.2f} a grain\n",
             100 * r.mean, 100 * r.p99, grouped(r.contacts), grouped(r.wall_contacts), r.coordination);
}

// The figures of a results file: InputError when it has none.
std::vector<MeasureSummary> figures_of(InfoArguments const& arguments) {
  std::vector<MeasureSummary> measures = ResultsReader(arguments.file, arguments.recover).measures();
  if (measures.empty())
    throw InputError({arguments.file.string() + ": holds no measurements: the case needs [[measure]] entries, and a "
                                                "run its end"});
  return measures;
}

int compare(InfoArguments const& arguments) {
  bool good = false;
  fmt::print("{}", check_table(check_figures(read_expected(arguments.expected), figures_of(arguments)), good));
  return good ? exit_ok : exit_watch;
}

bool is_model(fs::path const& file) {
  try {
    check_container(file, "scree.model", 1);
    return true;
  } catch (std::exception const&) {
    return false;  // whatever it is, the results reader says it better
  }
}

int export_vtkhdf(ExportArguments const& arguments, ResultsReader const& reader) {
  fs::path file = arguments.folder;
  if (file.empty()) {
    file = arguments.results.parent_path() / "paraview" / "grains.vtkhdf";
    fs::create_directories(file.parent_path());
  }
  // It replaces what is there, like the folder's files do: not the results by a slip of the pen.
  if (file.extension() != ".vtkhdf") throw InputError({file.string() + ": --output must end in .vtkhdf"});
  if (reader.frames() == 0) throw InputError({arguments.results.string() + ": has no frame to export"});
  VtkhdfWriter writer(file, reader.header());
  for (int k = 0; k < reader.frames(); ++k) writer.write_frame(reader.frame(k));
  writer.finish();
  fmt::print("ParaView  {}\n", file.string());
  return exit_ok;
}

}  // namespace

int plan_command(CaseArguments const& arguments) {
  PickedCase const picked = load_picked_case(arguments);
  Case const& c = picked.c;
  Plan const plan = simulation_of(arguments, c).plan();
  fmt::print("{}: {} bodies, {} shapes, {} networks, up to {} nodes a grain\n", c.name, plan.bodies, plan.shapes,
             plan.networks, plan.nodes_max);
  fmt::print("stages   {}\n", fmt::join(plan.stages, " -> "));
  fmt::print("effects  {}\n", plan.effects.empty() ? "none" : fmt::format("{}", fmt::join(plan.effects, ", ")));
  fmt::print("law\n{}\n", plan.law);
  fmt::print("step     {:.4g} s, {} steps to t = {:g} s\n", plan.step, grouped(plan.steps), c.time.end);
  std::int64_t total = 0;
  fmt::print("arrays\n");
  for (Plan::Array const& a : plan.arrays) {
    fmt::print("  {:<28} {:>16} bytes\n", a.name, grouped(a.bytes));
    total += a.bytes;
  }
  fmt::print("  {:<28} {:>16} bytes\n", "together", grouped(total));
  for (std::string const& word : picked.words) fmt::print("note     {}\n", word);
  for (std::string const& note : plan.notes) fmt::print("note     {}\n", note);
  return exit_ok;
}

int check_command(CaseArguments const& arguments) {
  PickedCase const picked = load_picked_case(arguments);
  Plan const plan = simulation_of(arguments, picked.c).plan();
  fmt::print("{}: good: {} bodies of {} shapes\n", arguments.file.string(), plan.bodies, plan.shapes);
  for (std::string const& word : picked.words) fmt::print("note: {}\n", word);
  for (std::string const& note : plan.notes) fmt::print("note: {}\n", note);
  return exit_ok;
}

int keys_command(std::string const& prefix) {
  std::string const reference = case_reference(prefix);
  if (reference.empty()) throw InputError({fmt::format("no key of the case file starts with '{}'", prefix)});
  fmt::print("{}", reference);
  return exit_ok;
}

int info_command(InfoArguments const& arguments) {
  if (!arguments.expected.empty()) return compare(arguments);
  if (arguments.figures) {
    fmt::print("{}", figures_csv(figures_of(arguments)));
    return exit_ok;
  }
  bool const model = is_model(arguments.file);
  if (arguments.overlap && model)
    throw InputError({arguments.file.string() + ": --overlap needs a results file, this is a model file"});
  if (arguments.overlap)
    print_overlap(arguments);
  else if (model)
    describe_model(arguments.file);
  else
    describe_results(arguments.file, arguments.recover);
  return exit_ok;
}

int export_command(ExportArguments const& arguments) {
  ResultsReader const reader(arguments.results, arguments.recover);
  if (arguments.vtkhdf) return export_vtkhdf(arguments, reader);
  fs::path const folder = arguments.folder.empty() ? arguments.results.parent_path() / "paraview" : arguments.folder;
  ParaviewOptions options;
  options.frames_expected = std::max(1, reader.frames());
  ParaviewWriter writer(folder, reader.header(), options);
  for (int k = 0; k < reader.frames(); ++k) writer.write_frame(reader.frame(k));
  writer.finish();
  fmt::print("ParaView  {}\n", (folder / "scene.pvd").string());
  return exit_ok;
}

}  // namespace scree

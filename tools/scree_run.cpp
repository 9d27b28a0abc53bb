// scree_run.cpp: `scree run`: one case from reading to sealed files.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <optional>
#include <system_error>
#include <thread>

#include "core/case.h"
#include "core/paraview.h"
#include "core/results_layout.h"
#include "core/simulation.h"
#include "tools/scree_commands.h"
#include "tools/scree_folder.h"
#include "tools/scree_measures.h"
#include "tools/scree_report.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

std::sig_atomic_t volatile interrupt_signal = 0;

// The first signal asks the loop to stop and seal its files; a second one kills as usual.
extern "C" void on_signal(int signal) {
  interrupt_signal = signal;
  std::signal(signal, SIG_DFL);
}

// Writes a small text file whole; throws std::system_error.
void write_text(fs::path const& file, std::string const& text) {
  errno = 0;
  std::ofstream stream(file, std::ios::binary);
  stream << text << std::flush;
  if (!stream)
    throw std::system_error(errno ? errno : EIO, std::generic_category(), file.string() + ": cannot be written");
}

// Everything a run writes while it goes.
class Recorder {
 public:
  Recorder(OutputFolder const& folder, Case const& c, Simulation const& simulation)
      : results_(folder.file("results.h5"), simulation.results_header()),
        ledger_(folder.file("ledger.csv")),
        measures_(folder, c, simulation),
        column_(results_layout::columns_with(simulation.results_header().ledger)),
        every_(c.output.every) {
    write_text(folder.file("case.effective.toml"), to_toml(c));
    std::string header;
    for (results_layout::LedgerColumn const& column : column_)
      header += fmt::format("{}{}", header.empty() ? "" : ",", column.name);
    ledger_ << header << "\n";
    if (c.output.paraview) {
      ParaviewOptions options;
      options.frames_expected = static_cast<int>(std::min(1e6, c.time.end / c.output.every)) + 2;
      paraview_.emplace(folder.file("paraview"), simulation.results_header(), options);
    }
    write(simulation);
  }

  void write_if_due(Simulation& s) {
    measures_.write(s);
    if (s.time() + s.time_step() / 2 >= static_cast<double>(frames_) * every_) write(s);
  }

  // The last state, unless it was just written, and the seal.
  void finish(Simulation& s, std::vector<StageRow> const& stages) {
    measures_.write(s);
    results_.write_measures(s.measure_summary());
    if (last_step_ != s.steps()) write(s);
    if (paraview_) paraview_->finish();
    results_.finish(stages);
  }

  int frames() const { return frames_; }

 private:
  void write(Simulation const& s) {
    Frame const frame = s.frame();
    LedgerRow const row = s.ledger();
    results_.write_ledger(row);
    results_.write_frame(frame);
    if (paraview_) paraview_->write_frame(frame);
    std::string line;
    for (results_layout::LedgerColumn const& column : column_)
      line += fmt::format("{}{:.9g}", line.empty() ? "" : ",", row.*column.value);
    ledger_ << line << "\n" << std::flush;
    if (!ledger_) throw std::system_error(EIO, std::generic_category(), "ledger.csv: cannot be written");
    last_step_ = s.steps();
    ++frames_;
  }

  ResultsWriter results_;
  std::ofstream ledger_;
  MeasureLog measures_;
  std::vector<results_layout::LedgerColumn> column_;  // of the ledger
  std::optional<ParaviewWriter> paraview_;
  double every_;  // [s]
  int frames_ = 0;
  std::int64_t last_step_ = -1;
};

struct Ending {
  ExitCode code = exit_ok;
  std::string text;
};

// Steps until the case ends, a watch stops it or a signal comes.
Ending step_to_the_end(Simulation& simulation, Recorder& recorder, Progress& progress, RunLog& log) {
  try {
    while (simulation.step() == RunState::running) {
      recorder.write_if_due(simulation);
      for (std::string const& message : simulation.messages()) {
        progress.clear();
        log.say(message);
      }
      progress.show(simulation);
      if (interrupt_signal)
        return {exit_interrupted, fmt::format("interrupted by signal {}", static_cast<int>(interrupt_signal))};
    }
  } catch (WatchStop const& stop) {
    return {exit_watch, stop.what()};
  }
  return {exit_ok, simulation.state() == RunState::at_rest ? "at rest" : "reached time.end"};
}

void introduce(RunLog& log, Case const& c, Simulation const& simulation, std::string const& device) {
  Plan const plan = simulation.plan();
  log.say(fmt::format("{}: {} grains of {} shapes, {} networks, {}", c.name, plan.bodies, plan.shapes, plan.networks,
                      device));
  log.say(fmt::format("{} steps of {:.3g} s to t = {:g} s", grouped(plan.steps), plan.step, c.time.end));
  for (std::string const& note : plan.notes) log.say(note);
  if (c.checkpoint) log.say("[checkpoint] is read, but this version writes no checkpoints");
}

void summarise(RunLog& log, OutputFolder const& folder, Case const& c, Simulation const& s, Recorder const& recorder,
               Ending const& ending, std::vector<StageRow> const& stages, double wall) {
  double const particle_steps = static_cast<double>(s.bodies()) * static_cast<double>(s.steps());
  log.say(fmt::format("{} after {:.6g} s: {} steps, {} frames, {}, {:.4g} particle-steps/s", ending.text, s.time(),
                      grouped(s.steps()), recorder.frames(), duration(wall), particle_steps / std::max(wall, 1e-9)));
  log.say(stage_table(stages, wall));
  log.say(ledger_table(s.ledger()));
  if (LedgerRow const row = s.ledger(); std::abs(row.residual) > c.limits.ledger * row.moved)
    log.say(
        fmt::format("warning: the ledger leaves {:.2g} of the energy moved unaccounted for, limits.ledger is {:.2g}; a "
                    "smaller time.safety closes it",
                    std::abs(row.residual) / row.moved, c.limits.ledger));
  log.say(fmt::format("largest overlap at the nodes {:.3f} % d, largest kinetic energy of a grain {:.2e} m g d",
                      100 * s.largest_overlap(), s.largest_kinetic_per_grain()));
  if (!c.measure.empty()) log.say(measure_table(s.measure_summary()));
  log.say(fmt::format("results   {}", folder.file("results.h5").string()));
  log.say(fmt::format("ledger    {}", folder.file("ledger.csv").string()));
  if (!c.measure.empty()) log.say(fmt::format("measures  {}", folder.file("measures.csv").string()));
  log.say(fmt::format("stages    {}", folder.file("stages.json").string()));
  if (c.output.paraview) log.say(fmt::format("ParaView  {}", (folder.file("paraview") / "scene.pvd").string()));
}

}  // namespace

int choose_threads(CaseArguments const& arguments, std::string* note) {
  if (arguments.device == "cuda")
    throw DeviceError("--device cuda: this version of the engine has no CUDA backend; use --device cpu or auto");
  int const cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  int const threads = arguments.threads > 0 ? arguments.threads : cores;
  if (note) *note = fmt::format("CPU, {} thread{}", threads, threads == 1 ? "" : "s");
  if (note && arguments.device == "auto") *note += " (auto: no CUDA backend in this build)";
  return threads;
}

int run_command(RunArguments const& arguments) {
  std::string device;
  int const threads = choose_threads(arguments.scene, &device);
  // Everything that can be wrong with the input is found before the output folder is touched.
  Case const c = load_case(arguments.scene.file, arguments.scene.overrides, arguments.scene.share);
  fs::path const output =
      arguments.output.empty() ? fs::path(arguments.scene.file.stem().string() + ".out") : arguments.output;
  OutputFolder::check(output, arguments.force);
  SimulationOptions options;
  options.threads = threads;
  Simulation simulation(c, options);

  OutputFolder const folder(output, arguments.force);
  RunLog log(folder.file("run.log"));
  introduce(log, c, simulation, device);
  Recorder recorder(folder, c, simulation);
  Progress progress(c.time.end, arguments.quiet);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  auto const start = std::chrono::steady_clock::now();
  Ending const ending = step_to_the_end(simulation, recorder, progress, log);
  double const wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  progress.clear();

  for (std::string const& message : simulation.messages()) log.say(message);
  std::vector<StageRow> const stages = stage_rows(simulation.profile());
  recorder.finish(simulation, stages);
  write_text(folder.file("stages.json"), stages_json(stages, simulation, threads, wall));
  summarise(log, folder, c, simulation, recorder, ending, stages, wall);
  if (ending.code == exit_watch) fmt::print(stderr, "scree: error: {}\n", ending.text);
  return ending.code;
}

}  // namespace scree

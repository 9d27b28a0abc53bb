// scree_run.cpp: `scree run`: one case from reading to sealed files.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <chrono>
#include <csignal>
#include <optional>
#include <thread>

#include "core/appended_file.h"
#include "core/case.h"
#include "core/frame_journal.h"
#include "core/paraview.h"
#include "core/results_layout.h"
#include "core/simulation.h"
#include "kernels/base/device.h"
#include "shapes/whole_file.h"
#include "tools/picked_case.h"
#include "tools/run_checkpoints.h"
#include "tools/scree_commands.h"
#include "tools/scree_folder.h"
#include "tools/scree_measures.h"
#include "tools/scree_report.h"
#include "tools/step_meter.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

std::sig_atomic_t volatile interrupt_signal = 0;

// The first signal asks the loop to stop and seal its files; a second one kills as usual.
extern "C" void on_signal(int signal) {
  interrupt_signal = signal;
  std::signal(signal, SIG_DFL);
}

// Everything a run writes while it goes.
class Recorder {
 public:
  // `header` is that of the run's beginning. `earlier`: the frames of an earlier process, which are written again;
  // `schedule`: how far it was. Null: the run begins, with its first frame.
  Recorder(OutputFolder const& folder, PickedCase const& picked, ResultsHeader const& header, Simulation& simulation,
           EarlierFrames const* earlier, OutputProgress const* schedule)
      : results_(folder.file("results.h5"), header),
        ledger_(folder.file("ledger.csv"), 0),
        measures_(folder, picked.c, simulation, schedule),
        column_(results_layout::columns_with(header.ledger)),
        every_(picked.c.output.every) {
    Case const& c = picked.c;
    write_whole_file(folder.file("case.effective.toml"), effective_text(picked), true);
    std::string names;
    for (results_layout::LedgerColumn const& column : column_)
      names += fmt::format("{}{}", names.empty() ? "" : ",", column.name);
    ledger_.append(names + "\n");
    if (c.output.paraview) {
      ParaviewOptions options;
      options.frames_expected = static_cast<int>(std::min(1e6, c.time.end / c.output.every)) + 2;
      paraview_.emplace(folder.file("paraview"), header, options);
    }
    journal_file_ = CheckpointFolder(OutputFolder::checkpoints(folder.path())).journal();
    if (earlier) earlier->for_each([&](Frame const& frame, LedgerRow const& row) { write(frame, row); });
    if (c.checkpoint) start_journal(earlier);
    if (!schedule)
      write_if_due(simulation);
    else if (schedule->every == every_)
      due_ = schedule->due;
    else
      due_ = static_cast<std::int64_t>((simulation.time() + simulation.time_step() / 2) / every_) + 1;
  }

  void write_if_due(Simulation& s) {
    measures_.write(s);
    if (s.time() + s.time_step() / 2 < static_cast<double>(due_) * every_) return;
    write(s.frame(), s.ledger());
    ++due_;
  }

  // For a checkpoint: after this, what was written so far cannot be lost.
  OutputProgress progress(Simulation& s) {
    measures_.write(s);
    if (journal_) journal_->sync();
    OutputProgress out{frames_, due_, every_};
    measures_.note_sizes(out);
    return out;
  }

  // The last state, unless it was just written, and the seal.
  void finish(Simulation& s, std::vector<StageRow> const& stages) {
    measures_.write(s);
    results_.write_measures(s.measure_summary());
    if (last_step_ != s.steps()) write(s.frame(), s.ledger());
    if (paraview_) paraview_->finish();
    results_.finish(stages);
    journal_.reset();
    fs::remove(journal_file_);  // results.h5 holds it all now
  }

  int frames() const { return frames_; }

 private:
  // Frames come from a file again only if a kill cannot have torn it: see core/frame_journal.h.
  void start_journal(EarlierFrames const* earlier) {
    fs::create_directories(journal_file_.parent_path());
    journal_.emplace(journal_file_, earlier ? earlier->journal_bytes() : 0);
    if (earlier && earlier->journal_bytes() == 0)
      earlier->for_each([&](Frame const& frame, LedgerRow const& row) { journal_->append(frame, row); });
  }

  void write(Frame const& frame, LedgerRow const& row) {
    results_.write_ledger(row);
    results_.write_frame(frame);
    if (paraview_) paraview_->write_frame(frame);
    std::string line;
    for (results_layout::LedgerColumn const& column : column_)
      line += fmt::format("{}{:.9g}", line.empty() ? "" : ",", row.*column.value);
    ledger_.append(line + "\n");
    if (journal_) journal_->append(frame, row);
    last_step_ = frame.step;
    ++frames_;
  }

  ResultsWriter results_;
  AppendedFile ledger_;
  MeasureLog measures_;
  std::vector<results_layout::LedgerColumn> column_;  // of the ledger
  std::optional<ParaviewWriter> paraview_;
  fs::path journal_file_;
  std::optional<JournalWriter> journal_;  // with [checkpoint]
  double every_;                          // [s]
  int frames_ = 0;
  std::int64_t due_ = 0;  // the next frame is due at due_ every_
  std::int64_t last_step_ = -1;
};

struct Ending {
  ExitCode code = exit_ok;
  std::string text;
};

// Steps until the case ends, a watch stops it or a signal comes.
Ending step_to_the_end(Simulation& simulation, Recorder& recorder, RunCheckpoints& checkpoints, Progress& progress,
                       RunLog& log) {
  try {
    while (simulation.step() == RunState::running) {
      recorder.write_if_due(simulation);
      if (checkpoints.due(simulation)) checkpoints.write(simulation, recorder.progress(simulation));
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

void introduce(RunLog& log, PickedCase const& picked, Simulation const& simulation, std::string const& device) {
  Case const& c = picked.c;
  Plan const plan = simulation.plan();
  log.say(fmt::format("{}: {} grains of {} shapes, {} networks, {}", c.name, plan.bodies, plan.shapes, plan.networks,
                      device));
  log.say(fmt::format("{} steps of {:.3g} s to t = {:g} s", grouped(plan.steps), plan.step, c.time.end));
  for (std::string const& word : picked.words) log.say(word);
  for (std::string const& note : plan.notes) log.say(note);
}

// What [accuracy] promised beside what the run took: `cpu` of all threads [s].
std::string cost_in_words(AccuracyPick const& pick, Simulation const& s, double cpu) {
  double const particle_steps = static_cast<double>(s.bodies()) * static_cast<double>(s.own_steps());
  return fmt::format(
      "accuracy: {:.3g} us of processor time a particle-step, predicted {:.3g}; {:.3g} s in all, predicted {:.3g} to "
      "time.end; estimated error {:.2g} % of a contact's force",
      1e6 * cpu / std::max(1.0, particle_steps), pick.step_us, cpu, pick.seconds, 100 * pick.error());
}

void summarise(RunLog& log, OutputFolder const& folder, Case const& c, Simulation const& s, Recorder const& recorder,
               Ending const& ending, std::vector<StageRow> const& stages, NetworkRate const& rate, double wall) {
  double const particle_steps = static_cast<double>(s.bodies()) * static_cast<double>(s.own_steps());
  log.say(fmt::format("{} after {:.6g} s: {} steps, {} frames, {}, {:.4g} particle-steps/s", ending.text, s.time(),
                      grouped(s.steps()), recorder.frames(), duration(wall), particle_steps / std::max(wall, 1e-9)));
  log.say(stage_table(stages, wall));
  if (std::string const queries = query_table(s.query_counts(), rate); !queries.empty()) log.say(queries);
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

int choose_threads(CaseArguments const& arguments) {
  int const cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return arguments.threads > 0 ? arguments.threads : cores;
}

SimulationOptions choose_backend(CaseArguments const& arguments, std::string* note) {
  SimulationOptions options;
  options.threads = choose_threads(arguments);
  std::string const cpu = fmt::format("CPU, {} thread{}", options.threads, options.threads == 1 ? "" : "s");
  std::string device = cpu;
  if (arguments.device != "cpu") {
    try {
      options.network_device = make_cuda_network_device();
      device = fmt::format("networks on {}; all else on {}", options.network_device->describe(), cpu);
    } catch (DeviceError const& error) {
      if (arguments.device == "cuda") throw DeviceError(fmt::format("--device cuda: {}", error.what()));
      device += fmt::format(" (auto: {})", error.what());
    }
  }
  if (note) *note = device;
  return options;
}

int run_command(RunArguments const& arguments) {
  std::string device;
  SimulationOptions const options = choose_backend(arguments.scene, &device);
  // Everything that can be wrong with the input is found before the output folder is touched.
  fs::path const output =
      arguments.output.empty() ? fs::path(arguments.scene.file.stem().string() + ".out") : arguments.output;
  PickedCase const picked = load_picked_case(arguments.scene, arguments.resume ? output : fs::path());
  Case const& c = picked.c;
  FolderUse const use = arguments.resume ? FolderUse::resume : arguments.force ? FolderUse::replace : FolderUse::fresh;
  OutputFolder::check(output, use);
  Simulation simulation(c, options);
  ResultsHeader const header = simulation.results_header();
  std::vector<std::string> remarks;
  std::optional<Checkpoint> checkpoint;
  if (arguments.resume) checkpoint = checkpoint_to_resume(output, remarks);
  if (checkpoint) simulation.restore(*checkpoint);
  if (checkpoint && simulation.state() != RunState::running) {
    fmt::print("{}: the run is finished, at t = {:.6g} s; a later time.end prolongs one that reached its end\n",
               output.string(), simulation.time());
    return exit_ok;
  }

  OutputFolder const folder(output, use);
  std::optional<EarlierFrames> earlier;
  if (checkpoint) earlier.emplace(output, checkpoint->output);
  RunLog log(folder.file("run.log"), checkpoint.has_value());
  introduce(log, picked, simulation, device);
  for (std::string const& remark : remarks) log.say(remark);
  if (arguments.resume)
    log.say(checkpoint ? fmt::format("goes on from t = {:.6g} s, step {}", simulation.time(), simulation.steps())
                       : "no earlier run in " + output.string() + ": starts at t = 0");
  Recorder recorder(folder, picked, header, simulation, earlier ? &*earlier : nullptr,
                    checkpoint ? &checkpoint->output : nullptr);
  RunCheckpoints checkpoints(output, c, simulation);
  Progress progress(simulation.time(), c.time.end, arguments.quiet);
  recorder.write_if_due(simulation);  // the step at which the run ended or was stopped by a watch
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  auto const start = std::chrono::steady_clock::now();
  double const cpu_before = process_seconds();
  Ending const ending = step_to_the_end(simulation, recorder, checkpoints, progress, log);
  double const wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  double const cpu = process_seconds() - cpu_before;
  progress.clear();

  for (std::string const& message : simulation.messages()) log.say(message);
  std::vector<StageRow> const stages = stage_rows(simulation.profile());
  // A run that is stopped can always be gone on from; one that ends when it has checkpoints, with sealed files only.
  OutputProgress const written = recorder.progress(simulation);
  std::optional<fs::path> last;
  if (ending.code == exit_watch) last = checkpoints.write_stopped(simulation, written);
  if (ending.code == exit_interrupted) last = checkpoints.write(simulation, written);
  recorder.finish(simulation, stages);
  if (ending.code == exit_ok && checkpoints.scheduled()) last = checkpoints.write(simulation, written);
  if (last) log.say(fmt::format("checkpoint {}", last->string()));
  NetworkRate const rate = network_rate(simulation.query_counts(), stages, options.threads);
  write_whole_file(folder.file("stages.json"), stages_json(stages, rate, simulation, wall), true);
  summarise(log, folder, c, simulation, recorder, ending, stages, rate, wall);
  if (picked.pick) log.say(cost_in_words(*picked.pick, simulation, cpu));
  if (ending.code == exit_watch) fmt::print(stderr, "scree: error: {}\n", ending.text);
  return ending.code;
}

}  // namespace scree

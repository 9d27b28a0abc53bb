// bench_step.cpp: cost of a whole time step from a saved state: at rest, and flowing with random velocities.
// Every round restores the same state and repeats the same steps, rounds of all subjects are interleaved, and medians
// are reported: a neighbour on the machine hits all alike.
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>
#include <fmt/core.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>

#include "core/results.h"
#include "kernels/base/build_info.h"
#include "kernels/sdf/sdf_batch.h"
#include "tools/bench/google_benchmarks.h"
#include "tools/guarded.h"
#include "tools/measured_on.h"
#include "tools/step_meter.h"

namespace scree::bench {
namespace {

namespace fs = std::filesystem;

struct Options {
  fs::path state;  // results file; empty: a heap of its own
  int frame = -1;
  std::vector<std::string> overrides;
  fs::path library = SCREE_SOURCE_DIR "/shapes/library/grains.h5";
  int grains = 60, nodes = 1000;
  double fall = 1.2;  // of the heap's own simulation [s] at most
  double speed = 0.5;
  int steps = 200, warm_up = 50, rounds = 5;
  std::vector<int> threads{1, 2};
  std::string output;
};

// The case of a results file is text in its header; the reader of cases takes files.
Case case_of(ResultsHeader const& header, std::vector<std::string> const& overrides) {
  fs::path const file = fs::temp_directory_path() / fmt::format("bench_step_{}.toml", std::random_device{}());
  std::ofstream(file) << header.case_text;
  try {
    Case c = load_case(file, overrides);
    fs::remove(file);
    return c;
  } catch (...) {
    fs::remove(file);
    throw;
  }
}

std::unique_ptr<Simulation> simulation_of(Options const& o) {
  if (!o.state.empty()) {
    ResultsReader const reader(o.state);
    return std::make_unique<Simulation>(case_of(reader.header(), o.overrides), SimulationOptions{},
                                        reader.frame(o.frame));
  }
  auto s = std::make_unique<Simulation>(heap_case({{"grains", o.library}}, {"grains:*"}, o.grains, o.nodes, o.fall),
                                        SimulationOptions{.threads = 2});
  while (s->step() == RunState::running) {
  }
  return s;
}

class Contest {
 public:
  explicit Contest(Options const& o) : options_(o), simulation_(simulation_of(o)), meter_(*simulation_) {
    State const rest = simulation_->impl().state;
    Workspace const work = simulation_->impl().work;
    warm_up("rest", rest, work);
    warm_up("flowing", flowing(rest, o.speed), work);
  }

  void measure(SteppedScene& s) { meter_.measure(s, options_.steps); }
  std::vector<SteppedScene>& subjects() { return subjects_; }
  Simulation& simulation() { return *simulation_; }

 private:
  void warm_up(std::string const& name, State const& state, Workspace const& work) {
    SteppedScene const warm = meter_.warm(name, state, work, options_.warm_up);
    for (int threads : options_.threads) subjects_.push_back(warm), subjects_.back().threads = threads;
  }

  Options options_;
  std::unique_ptr<Simulation> simulation_;
  StepMeter meter_;
  std::vector<SteppedScene> subjects_;
};

// The figures of one subject, by name.
std::vector<std::pair<std::string, double>> figures(Contest& c, SteppedScene const& s, Options const& o) {
  double const wall = median(s.wall) / o.steps, steps = o.steps;
  double const queries = static_cast<double>(s.counts.queries()) / steps;
  return {{"particle_steps_per_second", c.simulation().bodies() / wall},
          {"us_per_step", 1e6 * wall},
          {"cpu_us_per_step", 1e6 * median(s.cpu) / o.steps},
          {"queries_per_second", queries / wall},
          {"queries_per_step", queries},
          {"block_queries_per_step", static_cast<double>(s.counts.block) / steps},
          {"listed_queries_per_step", static_cast<double>(s.counts.listed) / steps},
          {"gradient_queries_per_step", static_cast<double>(s.counts.active) / steps},
          {"repeated_queries_per_step", static_cast<double>(s.counts.again) / steps},
          {"rebuilt_sides_per_step", static_cast<double>(s.counts.rebuilt) / steps},
          {"listed_nodes", static_cast<double>(s.work.gather.lists.node.size())},
          {"sides", static_cast<double>(s.work.gather.lists.side.size())}};
}

std::vector<std::pair<std::string, double>> shares(SteppedScene const& s) {
  std::vector<std::pair<std::string, double>> out(s.stages.begin(), s.stages.end());
  double const total = s.wall.back();
  for (auto& [name, seconds] : out) seconds /= total;
  std::sort(out.begin(), out.end(), [](auto const& a, auto const& b) { return a.second > b.second; });
  return out;
}

void print_table(Contest& c, Options const& o) {
  fmt::print("{} grains, time step {:.3g} s, {} steps a round, medians of {} rounds\n", c.simulation().bodies(),
             c.simulation().time_step(), o.steps, o.rounds);
  for (SteppedScene const& s : c.subjects()) {
    fmt::print("\n{}, {} thread(s)\n", s.name, s.threads);
    for (auto const& [name, value] : figures(c, s, o)) fmt::print("  {:<28} {:>14.1f}\n", name, value);
    for (auto const& [name, share] : shares(s))
      if (share >= 0.01) fmt::print("  {:<28} {:>13.1f}%\n", name, 100 * share);
  }
}

std::string json_object(std::vector<std::pair<std::string, double>> const& values, char const* format) {
  std::string text;
  for (auto const& [name, value] : values)
    text += fmt::format("{}\"{}\": {}", text.empty() ? "" : ", ", name, fmt::format(fmt::runtime(format), value));
  return "{" + text + "}";
}

void write_json(Contest& c, Options const& o) {
  auto out = fmt::output_file(o.output);
  out.print("{{\n  \"program\": \"bench_step\", \"commit\": \"{}\", \"compiler\": \"{}\", \"date\": \"{}\",\n",
            build_info().commit, build_info().compiler, utc_date());
  out.print("  \"isa\": \"{}\", \"state\": \"{}\", \"grains\": {}, \"time_step\": {:.6g},\n", sdf_isa(),
            o.state.empty() ? "heap" : o.state.filename().string(), c.simulation().bodies(),
            c.simulation().time_step());
  out.print("  \"steps\": {}, \"rounds\": {},\n  \"results\": [", o.steps, o.rounds);
  char const* separator = "\n";
  for (SteppedScene const& s : c.subjects()) {
    out.print("{}    {{\"scene\": \"{}\", \"threads\": {},\n     \"figures\": {},\n     \"shares\": {}}}", separator,
              s.name, s.threads, json_object(figures(c, s, o), "{:.1f}"), json_object(shares(s), "{:.4f}"));
    separator = ",\n";
  }
  out.print("\n  ]\n}}\n");
}

int run(int argc, char** argv) {
  CLI::App app("Cost of whole time steps from a saved state. Flags of Google Benchmark work too.");
  Options o;
  app.add_option("--state", o.state, "results.h5 to start from; without it a heap is made first");
  app.add_option("--frame", o.frame, "frame of --state; negative counts from the end");
  app.add_option("--set", o.overrides, "override a key of the case of --state")->allow_extra_args(false);
  app.add_option("--library", o.library, "model file of the heap");
  app.add_option("--grains", o.grains, "grains of the heap")->check(CLI::Range(1, 100'000));
  app.add_option("--nodes", o.nodes, "nodes a grain of the heap")->check(CLI::Range(100, 100'000));
  app.add_option("--fall", o.fall, "longest time the heap may take to come to rest [s]")->check(CLI::PositiveNumber);
  app.add_option("--speed", o.speed, "flowing: velocity components are up to this [m/s]");
  app.add_option("--steps", o.steps, "steps a round")->check(CLI::Range(1, 1'000'000));
  app.add_option("--warm-up", o.warm_up, "steps before the first round")->check(CLI::Range(1, 1'000'000));
  app.add_option("--rounds", o.rounds, "rounds of each subject")->check(CLI::Range(1, 1000));
  app.add_option("--threads", o.threads, "thread counts to measure")->delimiter(',')->check(CLI::Range(1, 4096));
  app.add_option("--output", o.output, "write the figures as JSON");
  app.set_version_flag("--version", fmt::format("{} ({})", build_info().version, build_info().commit));
  app.allow_extras();
  CLI11_PARSE(app, argc, argv);

  std::vector<std::string> flags = app.remaining();
  flags.insert(flags.begin(), "--benchmark_enable_random_interleaving=true");
  if (!take_benchmark_flags(argv[0], flags)) return exit_bad_input;

  Contest contest(o);
  for (SteppedScene& s : contest.subjects())
    benchmark::RegisterBenchmark(fmt::format("{}/threads:{}", s.name, s.threads).c_str(),
                                 [&](benchmark::State& state) {
                                   for (auto _ : state) {
                                     contest.measure(s);
                                     state.SetIterationTime(s.wall.back());
                                   }
                                 })
        ->UseManualTime()
        ->Iterations(1)
        ->Repetitions(o.rounds)
        ->ReportAggregatesOnly()
        ->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
  bool const complete =
      std::all_of(contest.subjects().begin(), contest.subjects().end(), [](auto const& s) { return !s.wall.empty(); });
  if (!complete) return 0;  // a filter was set
  print_table(contest, o);
  if (!o.output.empty()) write_json(contest, o);
  return 0;
}

}  // namespace
}  // namespace scree::bench

int main(int argc, char** argv) {
  return scree::guarded("bench_step", [&] { return scree::bench::run(argc, argv); });
}

// bench_sdf.cpp: queries per second of the batch evaluator on one core, as a share of the peak measured in the same
// run and against Eigen, LibTorch and a level-set grid. Every sample has its own peak measurement round it, samples of
// all subjects are shuffled, and medians are reported: a clock that wanders or a neighbour hits all alike.
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>
#include <fmt/core.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <map>
#include <random>

#include "kernels/base/build_info.h"
#include "kernels/sdf/sdf_batch.h"
#include "tools/bench/google_benchmarks.h"
#include "tools/bench/opponents.h"
#include "tools/guarded.h"
#include "tools/measured_on.h"

namespace scree::bench {
namespace {

int constexpr chunks[] = {128, 256, 1024, 8192};
double constexpr half_size = 0.8;  // queries fill the cube [-0.8, 0.8]^3, units of d

struct Subject {
  std::string name;
  double flop = 0;  // useful ones a query, 2 * sum(in * out), doubled with the gradient; 0: not counted
  std::function<void()> run;
  std::vector<double> seconds, peak;  // a sample each
};

double median(std::vector<double> v) {
  if (v.empty()) return 0;
  std::nth_element(v.begin(), v.begin() + v.size() / 2, v.end());
  return v[v.size() / 2];
}

// Time of the one thread at work: a sample that was preempted is not lost.
double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Mlp random_net(Activation activation, double parameter) {
  Mlp net;
  net.activation = activation;
  net.parameter = parameter;
  net.width = {3, 40, 40, 40, 40, 40, 1};
  std::mt19937 random(1);
  for (int l = 0; l < net.layers(); ++l) {
    int const in = net.width[l], out = net.width[l + 1];
    double const gain = activation == Activation::sine ? 1 / parameter : 1;
    std::normal_distribution<float> weight(0, static_cast<float>(gain * std::sqrt(2.0 / in))), bias(0, 0.1f);
    for (auto& w : net.weight.emplace_back(in * out)) w = weight(random);
    for (auto& b : net.bias.emplace_back(out)) b = bias(random);
  }
  return net;
}

double flop_of(Mlp const& net) {
  double flop = 0;
  for (int l = 0; l < net.layers(); ++l) flop += 2.0 * net.width[l] * net.width[l + 1];
  return flop;
}

// Everything that is measured, over the same queries.
class Contest {
 public:
  explicit Contest(int queries) : point_(queries), phi_(queries), gradient_(queries), row_(queries) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform(-half_size, half_size);
    for (auto& p : point_) p = {uniform(random), uniform(random), uniform(random)};
    add_ours();
    add_opponents();
    subjects_.push_back({"peak", 0, [this] { clock_.push_back(measure_clock()); }, {}, {}});
  }

  void register_all(int rounds) {
    for (auto& s : subjects_)
      benchmark::RegisterBenchmark(s.name.c_str(), [this, &s](benchmark::State& state) { sample(s, state); })
          ->Iterations(1)
          ->Repetitions(rounds)
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
  }

  double queries_per_second(Subject const& s) const { return static_cast<double>(point_.size()) / median(s.seconds); }
  double peak_share(Subject const& s) const {
    std::vector<double> share;
    for (std::size_t i = 0; i < s.seconds.size(); ++i)
      share.push_back(s.flop * static_cast<double>(point_.size()) / s.seconds[i] / s.peak[i]);
    return median(share);
  }
  // Speeds at the same clock: queries per measured peak FLOP, over the other's.
  double ratio(std::string const& name, std::string const& other) const {
    auto const speed = [&](Subject const& s) {
      std::vector<double> v;
      for (std::size_t i = 0; i < s.seconds.size(); ++i) v.push_back(1 / (s.seconds[i] * s.peak[i]));
      return median(v);
    };
    return speed(find(name)) / speed(find(other));
  }
  // The name with the chunk at which an opponent is fastest, or "" where it is not built.
  std::string best(std::string const& prefix) const {
    std::string found;
    for (auto const& s : subjects_)
      if (s.name.starts_with(prefix) && (found.empty() || queries_per_second(s) > queries_per_second(find(found))))
        found = s.name;
    return found;
  }
  Subject const& find(std::string const& name) const {
    return *std::find_if(subjects_.begin(), subjects_.end(), [&](auto const& s) { return s.name == name; });
  }
  std::vector<Subject> const& subjects() const { return subjects_; }
  double clock() const { return median(clock_); }
  double peak() const { return median(find("peak").peak); }
  // Median over samples of what the meter reaches of clock x units.
  double meter_share() const {
    std::vector<double> share;
    for (std::size_t i = 0; i < clock_.size(); ++i)
      share.push_back(find("peak").peak[i] / (clock_[i] * flop_per_cycle()));
    return median(share);
  }

 private:
  struct Ours {
    PackedMlp net;
    std::vector<float> rows;
    explicit Ours(Mlp const& mlp) : net(mlp) {
      for (int i = 0; i < 16; ++i) net.append_bias(mlp.bias[0], rows);
    }
  };

  void add_ours() {
    for (auto const& [activation, parameter] :
         {std::pair(Activation::leaky_relu, 0.01), std::pair(Activation::sine, 5.0)}) {
      Mlp const mlp = random_net(activation, parameter);
      auto& ours = ours_.emplace_back(std::make_unique<Ours>(mlp));
      double const flop = flop_of(mlp);
      std::string const name = std::string("scree/") + to_string(activation);
      subjects_.push_back({name + "/forward",
                           flop,
                           [&, o = ours.get()] { sdf_forward({}, o->net, o->rows, point_, {}, phi_); },
                           {},
                           {}});
      subjects_.push_back(
          {name + "/gradient",
           2 * flop,
           [&, o = ours.get()] { sdf_forward_gradient({}, o->net, o->rows, point_, {}, phi_, gradient_); },
           {},
           {}});
    }
    for (std::size_t i = 0; i < row_.size(); ++i) row_[i] = static_cast<int>(i % 16);
    subjects_.push_back({"scree/leaky_relu/forward/row_a_point",
                         flop_of(ours_[0]->net.net()),
                         [&] { sdf_forward({}, ours_[0]->net, ours_[0]->rows, point_, row_, phi_); },
                         {},
                         {}});
  }

  void add_opponents() {
    Mlp const& mlp = ours_[0]->net.net();
    double const flop = flop_of(mlp);
    auto const add = [&](std::string const& name, std::unique_ptr<Opponent> made) {
      Opponent* const o = opponents_.emplace_back(std::move(made)).get();
      for (int c : chunks) {
        subjects_.push_back(
            {fmt::format("{}/forward/chunk_{}", name, c), flop, [=, this] { o->forward(point_, c, phi_); }, {}, {}});
        subjects_.push_back({fmt::format("{}/gradient/chunk_{}", name, c),
                             2 * flop,
                             [=, this] { o->gradient(point_, c, phi_, gradient_); },
                             {},
                             {}});
      }
    };
    add("eigen", make_plain_eigen(mlp));
    add("eigen_tuned", make_eigen(mlp));
#if defined(SCREE_BENCH_TORCH)
    add("torch", make_torch(mlp));
#endif
    Opponent* const grid = opponents_.emplace_back(make_grid(mlp, half_size)).get();
    subjects_.push_back({"grid/forward", 0, [=, this] { grid->forward(point_, 0, phi_); }, {}, {}});
    subjects_.push_back({"grid/gradient", 0, [=, this] { grid->gradient(point_, 0, phi_, gradient_); }, {}, {}});
  }

  void sample(Subject& s, benchmark::State& state) {
    for (auto _ : state) {
      double const before = measure_peak();
      double const start = thread_seconds();
      s.run();
      double const seconds = thread_seconds() - start;
      s.seconds.push_back(seconds);
      s.peak.push_back((before + measure_peak()) / 2);
      state.SetIterationTime(seconds);
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(point_.size()));
    if (s.flop > 0)
      state.counters["peak_share"] = s.flop * static_cast<double>(point_.size()) / s.seconds.back() / s.peak.back();
    benchmark::DoNotOptimize(phi_.data());
  }

  std::vector<Vec3f> point_;
  std::vector<float> phi_;
  std::vector<Vec3f> gradient_;
  std::vector<int> row_;
  std::vector<std::unique_ptr<Ours>> ours_;
  std::vector<std::unique_ptr<Opponent>> opponents_;
  std::vector<Subject> subjects_;
  std::vector<double> clock_;
};

// A line a run on stderr; the table at the end is what matters.
class Progress final : public benchmark::BenchmarkReporter {
 public:
  explicit Progress(std::size_t runs) : runs_(runs) {}
  bool ReportContext(Context const&) override { return true; }
  void ReportRuns(std::vector<Run> const& runs) override {
    for (auto const& r : runs)
      if (r.run_type == Run::RT_Iteration) fmt::print(stderr, "\r{:4} of {} samples", ++done_, runs_);
    std::fflush(stderr);
  }
  void Finalize() override { fmt::print(stderr, "\n"); }

 private:
  std::size_t runs_, done_ = 0;
};

std::string blas() {
#if defined(SCREE_BENCH_TORCH)
  return blas_in_use();
#else
  return "not used (built without LibTorch)";
#endif
}

struct Gate {
  std::string name;
  double value, target;
};

std::vector<Gate> gates(Contest const& c) {
  std::vector<Gate> g = {
      {"peak meter / (clock x FMA units)", c.meter_share(), 0.90},
      {"leaky_relu forward / peak", c.peak_share(c.find("scree/leaky_relu/forward")), 0.75},
      {"leaky_relu forward + gradient / peak", c.peak_share(c.find("scree/leaky_relu/gradient")), 0.70},
      {"sine forward / peak", c.peak_share(c.find("scree/sine/forward")), 0.65},
      {"sine forward + gradient / peak", c.peak_share(c.find("scree/sine/gradient")), 0.60},
      {"forward, times Eigen as written plainly", c.ratio("scree/leaky_relu/forward", c.best("eigen/forward")), 1.7},
      {"forward + gradient, times Eigen", c.ratio("scree/leaky_relu/gradient", c.best("eigen/gradient")), 1.7},
      // No target: hand-tuned Eigen reaches 60 % of the peak itself.
      {"forward, times Eigen tuned", c.ratio("scree/leaky_relu/forward", c.best("eigen_tuned/forward")), 0},
      {"forward + gradient, times Eigen tuned", c.ratio("scree/leaky_relu/gradient", c.best("eigen_tuned/gradient")),
       0}};
  if (!c.best("torch/forward").empty()) {
    g.push_back(
        {"forward, times LibTorch at its best", c.ratio("scree/leaky_relu/forward", c.best("torch/forward")), 1.8});
    g.push_back(
        {"forward + gradient, times LibTorch", c.ratio("scree/leaky_relu/gradient", c.best("torch/gradient")), 1.8});
  }
  g.push_back({"forward, times the trilinear 43^3 grid", c.ratio("scree/leaky_relu/forward", "grid/forward"), 0});
  return g;
}

void print_table(Contest const& c) {
  fmt::print("{}, {}; clock {:.2f} GHz, peak {:.1f} GFLOP/s\nBLAS: {}\n\n{:44} {:>10} {:>10} {:>8}\n", cpu_name(),
             sdf_isa(), c.clock() * 1e-9, c.peak() * 1e-9, blas(), "medians", "Mqueries/s", "GFLOP/s", "of peak");
  for (auto const& s : c.subjects()) {
    if (s.name == "peak") continue;
    double const q = c.queries_per_second(s);
    fmt::print("{:44} {:10.2f}", s.name, q * 1e-6);
    if (s.flop > 0) fmt::print(" {:10.1f} {:7.1f} %", q * s.flop * 1e-9, 100 * c.peak_share(s));
    fmt::print("\n");
  }
  fmt::print("\n");
  for (auto const& g : gates(c))
    fmt::print(
        "{:44} {:10.3f}{}\n", g.name, g.value,
        g.target > 0 ? fmt::format("  target {:.2f}: {}", g.target, g.value >= g.target ? "met" : "MISSED") : "");
}

void write_json(Contest const& c, std::string const& file, int queries, int rounds) {
  auto const& b = build_info();
  auto out = fmt::output_file(file);
  out.print(
      "{{\n  \"benchmark\": \"bench_sdf\",\n  \"version\": \"{}\",\n  \"commit\": \"{}\",\n  \"compiler\": \"{} "
      "{}\",\n",
      b.version, b.commit, b.compiler, b.build_type);
  out.print("  \"date\": \"{}\",\n  \"machine\": \"{}\",\n  \"isa\": \"{}\",\n  \"blas\": \"{}\",\n", utc_date(),
            cpu_name(), sdf_isa(), blas());
  out.print("  \"network\": \"3-40-40-40-40-40-1\",\n  \"queries\": {},\n  \"rounds\": {},\n  \"threads\": 1,\n",
            queries, rounds);
  out.print("  \"clock_hz\": {:.4g},\n  \"flop_per_cycle\": {},\n  \"peak_flop_per_s\": {:.4g},\n  \"subjects\": {{\n",
            c.clock(), flop_per_cycle(), c.peak());
  std::string line;
  for (auto const& s : c.subjects()) {
    if (s.name == "peak") continue;
    if (!line.empty()) out.print("{},\n", line);
    line = fmt::format("    \"{}\": {{\"queries_per_s\": {:.4g}", s.name, c.queries_per_second(s));
    if (s.flop > 0) line += fmt::format(", \"flop_per_query\": {}, \"peak_share\": {:.4f}", s.flop, c.peak_share(s));
    line += "}";
  }
  out.print("{}\n  }},\n  \"results\": {{\n", line);
  line.clear();
  for (auto const& g : gates(c)) {
    if (!line.empty()) out.print("{},\n", line);
    line = fmt::format("    \"{}\": {{\"value\": {:.4f}", g.name, g.value);
    if (g.target > 0) line += fmt::format(", \"target\": {:.2f}", g.target);
    line += "}";
  }
  out.print("{}\n  }}\n}}\n", line);
}

int run(int argc, char** argv) {
  CLI::App app(
      "Network queries per second on one core, against the machine's peak and other ways. Flags of Google Benchmark "
      "work too.");
  int queries = 1'000'000, rounds = 9;
  std::string output;
  app.add_option("--queries", queries, "random queries a sample")->check(CLI::Range(1000, 100'000'000));
  app.add_option("--rounds", rounds, "samples of each subject")->check(CLI::Range(1, 1000));
  app.add_option("--output", output, "write the medians as JSON");
  app.set_version_flag("--version", fmt::format("{} ({})", build_info().version, build_info().commit));
  app.allow_extras();
  CLI11_PARSE(app, argc, argv);

  std::vector<std::string> flags = app.remaining();
  flags.insert(flags.begin(), "--benchmark_enable_random_interleaving=true");
  if (!take_benchmark_flags(argv[0], flags)) return exit_bad_input;
#if defined(SCREE_BENCH_TORCH)
  use_one_thread();
#endif
  Contest contest(queries);
  contest.register_all(rounds);
  Progress progress(contest.subjects().size() * static_cast<std::size_t>(rounds));
  benchmark::RunSpecifiedBenchmarks(&progress);
  bool const complete = std::all_of(contest.subjects().begin(), contest.subjects().end(),
                                    [](auto const& s) { return !s.seconds.empty(); });
  if (!complete) return 0;  // a filter was set: nothing to compare
  print_table(contest);
  if (!output.empty()) write_json(contest, output, queries, rounds);
  return 0;
}

}  // namespace
}  // namespace scree::bench

int main(int argc, char** argv) {
  return scree::guarded("bench_sdf", [&] { return scree::bench::run(argc, argv); });
}

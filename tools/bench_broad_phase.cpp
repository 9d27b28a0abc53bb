// bench_broad_phase.cpp: pairs of overlapping boxes per second by their number: the engine's hierarchy, CGAL's
// box_self_intersection_d, and every box against every other.
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "kernels/base/build_info.h"
#include "kernels/broad_phase.h"
#include "shapes/random.h"
#include "tools/bench/google_benchmarks.h"
#include "tools/bench/opponent_boxes.h"
#include "tools/guarded.h"
#include "tools/measured_on.h"

namespace scree::bench {
namespace {

// Cubes as a bed of grains has them: one a lattice cell, moved by up to 0.2 cells, 1.1 cells wide; or, with `mixed`,
// between 0.3 and 1.3 cells wide.
std::vector<Box> bed(int count, bool mixed) {
  Random random(1);
  int const across = static_cast<int>(std::ceil(std::cbrt(count)));
  std::vector<Box> boxes;
  for (int i = 0; i < count; ++i) {
    Vec3 const cell{static_cast<double>(i % across), static_cast<double>(i / across % across),
                    static_cast<double>(i / across / across)};
    Vec3 const centre = cell + Vec3{random.uniform(), random.uniform(), random.uniform()} * 0.4;
    double const half = 0.5 * (mixed ? 0.3 + random.uniform() : 1.1);
    boxes.push_back({centre - Vec3{half, half, half}, centre + Vec3{half, half, half}});
  }
  // Bodies that have moved for long stand in any order.
  for (int i = count; i > 1; --i) std::swap(boxes[i - 1], boxes[random.below(i)]);
  return boxes;
}

std::size_t by_hierarchy(std::vector<Box> const& boxes, int threads, BroadPhase& work) {
  Queue queue;
  queue.threads = threads;
  find_pairs(queue, SceneView{}, boxes, {}, work);
  return work.pair.size();
}

std::size_t by_trying_all(std::vector<Box> const& boxes) {
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size(); ++j) {
      Box const &a = boxes[i], &b = boxes[j];
      pairs += static_cast<std::size_t>(a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y &&
                                        b.min.y <= a.max.y && a.min.z <= b.max.z && b.min.z <= a.max.z);
    }
  return pairs;
}

// One subject at one size: `find` gives the number of pairs, which must be what `expected` says.
template <class Find>
void measure(benchmark::State& state, bool mixed, Find const& find) {
  int const count = static_cast<int>(state.range(0));
  std::vector<Box> const boxes = bed(count, mixed);
  BroadPhase work;
  std::size_t const expected = by_hierarchy(boxes, 1, work);
  std::size_t pairs = 0;
  for (auto _ : state) pairs = find(boxes);
  if (pairs != expected) {
    state.SkipWithError(fmt::format("{} pairs, the hierarchy finds {}", pairs, expected).c_str());
    return;
  }
  auto const rounds = static_cast<double>(state.iterations());
  state.counters["pairs"] = static_cast<double>(pairs);
  state.counters["pairs_per_s"] = benchmark::Counter(static_cast<double>(pairs) * rounds, benchmark::Counter::kIsRate);
  state.counters["s_per_box"] =
      benchmark::Counter(count * rounds, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void add(std::string const& name, std::vector<int> const& sizes, bool mixed,
         std::function<std::size_t(std::vector<Box> const&)> const& find) {
  auto* const b = benchmark::RegisterBenchmark((name + (mixed ? "/mixed" : "/alike")).c_str(),
                                               [=](benchmark::State& state) { measure(state, mixed, find); });
  for (int const n : sizes) b->Arg(n);
  b->Unit(benchmark::kMicrosecond);
}

int run(int argc, char** argv) {
  CLI::App app("Overlapping boxes by their number, against CGAL and all pairs. Flags of Google Benchmark work too.");
  std::vector<int> sizes{100, 1000, 10000, 100000};
  int threads = 1;
  app.add_option("--boxes", sizes, "numbers of boxes")->delimiter(',')->check(CLI::Range(1, 10'000'000));
  app.add_option("--threads", threads, "of the hierarchy; the others have one")->check(CLI::Range(1, 4096));
  app.set_version_flag("--version", fmt::format("{} ({})", build_info().version, build_info().commit));
  app.allow_extras();
  CLI11_PARSE(app, argc, argv);
  std::vector<int> few;  // all pairs of more take seconds
  std::copy_if(sizes.begin(), sizes.end(), std::back_inserter(few), [](int n) { return n <= 10000; });
  BroadPhase work;
  std::vector<Pair> pairs;
  for (bool const mixed : {false, true}) {
    add("scree", sizes, mixed, [&](auto const& boxes) { return by_hierarchy(boxes, threads, work); });
#ifdef SCREE_BENCH_CGAL
    add("cgal", sizes, mixed, [&](auto const& boxes) { return by_cgal(boxes, pairs); });
#endif
    add("all_pairs", few, mixed, by_trying_all);
  }
  benchmark::AddCustomContext("benchmark", "bench_broad_phase");
  benchmark::AddCustomContext("commit", build_info().commit);
  benchmark::AddCustomContext("compiler", build_info().compiler);
  benchmark::AddCustomContext("machine", cpu_name());
  if (!take_benchmark_flags(argv[0], app.remaining())) return exit_bad_input;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace scree::bench

int main(int argc, char** argv) {
  return scree::guarded("bench_broad_phase", [&] { return scree::bench::run(argc, argv); });
}

// bench_scaling.cpp: what a grain and step cost in scenes of 100 to 100,000 grains: it must not depend on their number.
// A pile is settled once and stands side by side with its copies, so that every scene asks the same of each grain;
// rounds of all scenes are interleaved and medians are reported.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <stdexcept>

#include "core/process_memory.h"
#include "kernels/base/build_info.h"
#include "kernels/sdf/sdf_batch.h"
#include "tools/guarded.h"
#include "tools/measured_on.h"
#include "tools/pile_tiles.h"
#include "tools/step_meter.h"

namespace scree::bench {
namespace {

struct Options {
  std::filesystem::path library = SCREE_SOURCE_DIR "/shapes/library/grains.h5";
  std::vector<std::string> shapes{"grains:*"};
  std::vector<int> grains{100, 1000, 10000, 100000};
  int tile = 100, nodes = 400, threads = 1, reference = 1000;
  double fall = 1.5, speed = 0.5, limit = 0;
  int steps = 50, warm_up = 50, rounds = 3;
  bool ordered = false;
  std::string output;
};

// One number of grains, at rest and flowing.
struct Size {
  std::unique_ptr<Simulation> simulation;
  std::unique_ptr<StepMeter> meter;
  std::vector<SteppedScene> scenes;
  double bytes = 0;         // of the process, a grain
  double seconds_made = 0;  // to make scene and state
  int bodies() const { return simulation->bodies(); }
};

Size make_size(Pile const& pile, int tiles, Options const& o) {
  Size size;
  std::size_t const before = resident_bytes();
  double const begin = process_seconds();
  size.simulation =
      std::make_unique<Simulation>(tiled_case(pile, tiles, !o.ordered, 1), SimulationOptions{.threads = o.threads});
  size.seconds_made = process_seconds() - begin;
  size.meter = std::make_unique<StepMeter>(*size.simulation);
  for (int k = 0; k < 2; ++k) size.simulation->step();  // every array is there now
  size.bytes = (static_cast<double>(resident_bytes()) - static_cast<double>(before)) / size.bodies();
  State const start = size.simulation->impl().state;
  Workspace const work = size.simulation->impl().work;
  size.scenes.push_back(size.meter->warm("rest", start, work, o.warm_up));
  size.scenes.push_back(size.meter->warm("flowing", flowing(start, o.speed), work, o.warm_up));
  for (SteppedScene& s : size.scenes) s.threads = o.threads;
  return size;
}

// us of one thread's wall time a grain and step.
double cost(Size const& size, SteppedScene const& s, Options const& o) {
  return 1e6 * median(s.wall) / o.steps / size.bodies();
}

int contacts(SteppedScene const& s) {
  return static_cast<int>(
      std::count_if(s.work.result.begin(), s.work.result.end(), [](PairResult const& r) { return r.active > 0; }));
}

struct Row {
  std::string scene;
  int grains;
  double us, cpu_us, ratio, contacts, queries, bytes;
  std::vector<std::pair<std::string, double>> stages;  // [us] a grain and step
};

std::vector<Row> rows_of(std::vector<Size> const& sizes, Options const& o) {
  std::vector<Row> rows;
  for (std::size_t k = 0; k < sizes[0].scenes.size(); ++k) {
    double reference = 0;
    for (Size const& size : sizes)
      if (size.bodies() == o.reference) reference = cost(size, size.scenes[k], o);
    for (Size const& size : sizes) {
      SteppedScene const& s = size.scenes[k];
      double const n = size.bodies(), all = o.steps * n;
      Row row{s.name,
              size.bodies(),
              cost(size, s, o),
              1e6 * median(s.cpu) / all,
              0,
              contacts(s) / n,
              static_cast<double>(s.counts.queries()) / all,
              size.bytes,
              {}};
      row.ratio = reference > 0 ? row.us / reference : 0;
      for (auto const& [name, seconds] : s.stages) row.stages.emplace_back(name, 1e6 * seconds / all);
      std::sort(row.stages.begin(), row.stages.end(), [](auto const& a, auto const& b) { return a.second > b.second; });
      rows.push_back(row);
    }
  }
  return rows;
}

void print_table(std::vector<Row> const& rows, Options const& o) {
  fmt::print(
      "| scene | grains | us a grain and step | of processor time | ratio to {} | contacts a grain | queries a "
      "grain and step | bytes a grain |\n|---|---|---|---|---|---|---|---|\n",
      o.reference);
  for (Row const& r : rows)
    fmt::print("| {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | {:.0f} |\n", r.scene, r.grains, r.us, r.cpu_us,
               r.ratio, r.contacts, r.queries, r.bytes);
  for (std::string const scene : {"rest", "flowing"}) {
    fmt::print("\n{}, us a grain and step by stage (last round)\n", scene);
    Row const* largest = nullptr;
    for (Row const& r : rows)
      if (r.scene == scene) largest = &r;
    for (auto const& [name, us] : largest->stages) {
      if (us < 0.005 * largest->us) continue;
      fmt::print("  {:<28}", name);
      for (Row const& r : rows) {
        auto const at = std::find_if(r.stages.begin(), r.stages.end(), [&](auto const& s) { return s.first == name; });
        if (r.scene == scene) fmt::print(" {:>9.4f}", at == r.stages.end() ? 0 : at->second);
      }
      fmt::print("\n");
    }
  }
}

void write_json(std::vector<Row> const& rows, Options const& o) {
  auto out = fmt::output_file(o.output);
  out.print("{{\n  \"benchmark\": \"bench_scaling\", \"commit\": \"{}\", \"compiler\": \"{}\", \"date\": \"{}\",\n",
            build_info().commit, build_info().compiler, utc_date());
  out.print("  \"machine\": \"{}\", \"isa\": \"{}\", \"shapes\": \"{}\", \"nodes\": {}, \"threads\": {},\n", cpu_name(),
            sdf_isa(), o.shapes[0], o.nodes, o.threads);
  out.print("  \"order\": \"{}\", \"tile\": {}, \"steps\": {}, \"rounds\": {},\n  \"results\": [",
            o.ordered ? "tiles" : "random", o.tile, o.steps, o.rounds);
  char const* separator = "\n";
  for (Row const& r : rows) {
    out.print(
        "{}    {{\"scene\": \"{}\", \"grains\": {}, \"us\": {:.4f}, \"cpu_us\": {:.4f}, \"ratio\": {:.4f}, "
        "\"contacts\": {:.3f}, \"queries\": {:.3f}, \"bytes\": {:.0f},\n     \"stages_us\": {{",
        separator, r.scene, r.grains, r.us, r.cpu_us, r.ratio, r.contacts, r.queries, r.bytes);
    char const* comma = "";
    for (auto const& [name, us] : r.stages)
      if (us >= 0.005 * r.us) out.print("{}\"{}\": {:.4f}", comma, name, us), comma = ", ";
    out.print("}}}}");
    separator = ",\n";
  }
  out.print("\n  ]\n}}\n");
}

int run(Options o) {
  std::sort(o.grains.begin(), o.grains.end());
  std::vector<Size> sizes;
  Pile pile;
  for (int const n : o.grains) {
    int const tile = std::min(n, o.tile);
    if (n % tile != 0) throw std::invalid_argument(fmt::format("{} grains are not whole tiles of {}", n, tile));
    if (static_cast<int>(pile.position.size()) != tile)
      pile = settle_pile(pile_case(heap_case({{"grains", o.library}}, o.shapes, tile, o.nodes, o.fall)), o.threads);
    sizes.push_back(make_size(pile, n / tile, o));
    fmt::print(stderr, "{} grains: scene made in {:.1f} s\n", n, sizes.back().seconds_made);
  }
  for (int round = 0; round < o.rounds; ++round)
    for (std::size_t k = 0; k < sizes[0].scenes.size(); ++k)
      for (Size& size : sizes) size.meter->measure(size.scenes[k], o.steps);
  std::vector<Row> const rows = rows_of(sizes, o);
  print_table(rows, o);
  if (!o.output.empty()) write_json(rows, o);
  double worst = 0;
  for (Row const& r : rows)
    if (r.grains > o.reference) worst = std::max(worst, r.ratio);
  if (o.limit > 0 && worst > o.limit) {
    fmt::print("a grain costs {:.3f} times what it costs among {}: above the limit {}\n", worst, o.reference, o.limit);
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace scree::bench

int main(int argc, char** argv) {
  scree::bench::Options o;
  CLI::App app("Cost of a grain and step, and its memory, by the number of grains; exit code 1 above --limit");
  app.add_option("--grains", o.grains, "numbers of grains: below --tile any, above it multiples")
      ->delimiter(',')
      ->check(CLI::Range(1, 10'000'000));
  app.add_option("--tile", o.tile, "grains of the pile that larger scenes are copies of")
      ->check(CLI::Range(1, 100'000));
  app.add_option("--reference", o.reference, "number of grains that ratios refer to");
  app.add_option("--shapes", o.shapes, "as a case file names them; library: grains")->delimiter(',');
  app.add_option("--library", o.library, "model file");
  app.add_option("--nodes", o.nodes, "surface nodes a grain")->check(CLI::Range(100, 100'000));
  app.add_option("--threads", o.threads, "threads")->check(CLI::Range(1, 4096));
  app.add_option("--fall", o.fall, "time the pile has to come to rest [s]")->check(CLI::PositiveNumber);
  app.add_option("--speed", o.speed, "flowing: velocity components are up to this [m/s]");
  app.add_option("--steps", o.steps, "steps a round")->check(CLI::Range(1, 1'000'000));
  app.add_option("--warm-up", o.warm_up, "steps before the first round")->check(CLI::Range(1, 1'000'000));
  app.add_option("--rounds", o.rounds, "rounds of each scene")->check(CLI::Range(1, 1000));
  app.add_flag("--ordered", o.ordered, "bodies tile by tile instead of in random order");
  app.add_option("--limit", o.limit, "largest ratio allowed above --reference grains; 0: any");
  app.add_option("-o,--output", o.output, "JSON file");
  CLI11_PARSE(app, argc, argv);
  return scree::guarded("bench_scaling", [&] { return scree::bench::run(o); });
}

// bench_memory.cpp: memory and seconds of unique grains of a shared decoder, from what the process holds.
// Codes are drawn around those of the library; every grain is made, normalised and put into a scene as `run` does.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <ctime>

#include "core/process_memory.h"
#include "core/unique_grains.h"
#include "kernels/base/build_info.h"
#include "shapes/model_file.h"
#include "shapes/random.h"
#include "tools/guarded.h"

namespace scree::bench {
namespace {

struct Options {
  std::string library = SCREE_SOURCE_DIR "/shapes/library/grains.h5", output;
  int grains = 100000, nodes = 1000, net = 0, threads = 1;
  double spread = 0.1;
  std::uint64_t seed = 1;
};

// Codes of known shapes, each component moved by `spread` of its standard deviation over the library.
std::vector<float> codes_around(Library const& library, Options const& o, int count, Random& random) {
  std::vector<std::vector<float>> known;
  for (Shape const& s : library.shape)
    if (s.is_net() && s.net == o.net) known.push_back(s.code);
  std::size_t const size = known.empty() ? 0 : known[0].size();
  std::vector<double> mean(size, 0), deviation(size, 0);
  for (auto const& code : known)
    for (std::size_t k = 0; k < size; ++k) mean[k] += code[k] / static_cast<double>(known.size());
  for (auto const& code : known)
    for (std::size_t k = 0; k < size; ++k)
      deviation[k] += (code[k] - mean[k]) * (code[k] - mean[k]) / static_cast<double>(known.size());
  std::vector<float> codes;
  codes.reserve(count * size);
  for (int i = 0; i < count; ++i) {
    auto const& code = known[random.below(static_cast<int>(known.size()))];
    for (std::size_t k = 0; k < size; ++k)
      codes.push_back(static_cast<float>(code[k] + o.spread * std::sqrt(deviation[k]) * random.normal()));
  }
  return codes;
}

double cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

int run(Options const& o) {
  Library const library = read_model(o.library);
  CompactGrainMaker const maker(library, o.net, o.nodes);
  Random random(o.seed);
  Scene scene;
  int const net = scene_network(scene, library.net[o.net]);
  std::size_t const before = resident_bytes();
  double const cpu = cpu_seconds();
  auto const start = std::chrono::steady_clock::now();
  UniqueGrainsMade made;
  int codes = 0;
  // Refused codes are drawn again, until there are as many grains as asked for.
  while (made.made < o.grains && codes < 20 * o.grains) {
    int const missing = o.grains - made.made;
    UniqueGrainsMade const more = add_unique_grains(scene, maker, net, codes_around(library, o, missing, random),
                                                    fmt::format("draw{}/", codes), o.threads);
    codes += missing;
    made.made += more.made;
    for (std::size_t f = 0; f < made.faults.size(); ++f) made.faults[f] += more.faults[f];
  }
  double const wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  double const used = cpu_seconds() - cpu;
  std::size_t const resident = resident_bytes() - before;
  CompactBytes const b = compact_bytes(scene);
  double const n = made.made > 0 ? made.made : 1;
  std::string text = fmt::format(
      "{{\n  \"commit\": \"{}\", \"grains\": {}, \"nodes\": {}, \"codes\": {}, \"threads\": {}, \"spread\": {},\n"
      "  \"resident_bytes_per_grain\": {:.1f},\n"
      "  \"arrays_bytes_per_grain\": {{\"nodes\": {:.1f}, \"culling\": {:.1f}, \"bias\": {:.1f}, \"record\": {:.1f}, "
      "\"host\": {:.1f}, \"total\": {:.1f}}},\n"
      "  \"refused\": {{",
      build_info().commit, made.made, o.nodes, codes, o.threads, o.spread, static_cast<double>(resident) / n,
      b.nodes / n, b.culling / n, b.bias / n, b.record / n, b.host / n, b.total() / n);
  for (int f = 1; f < static_cast<int>(made.faults.size()); ++f)
    text += fmt::format("{}\"{}\": {}", f > 1 ? ", " : "", to_string(static_cast<GrainFault>(f)), made.faults[f]);
  text += fmt::format("}},\n  \"wall_seconds\": {:.2f}, \"cpu_ms_per_code\": {:.3f}\n}}\n", wall, 1e3 * used / codes);
  fmt::print("{}", text);
  if (!o.output.empty()) fmt::output_file(o.output).print("{}", text);
  return 0;
}

}  // namespace
}  // namespace scree::bench

int main(int argc, char** argv) {
  scree::bench::Options o;
  CLI::App app("Memory of unique grains of a shared decoder, from the process's resident set (JSON)");
  app.add_option("--grains", o.grains, "grains that are made")->check(CLI::Range(1, 1000000));
  app.add_option("--nodes", o.nodes, "surface nodes a grain")->check(CLI::Range(32, 20000));
  app.add_option("--threads", o.threads, "threads that make grains")->check(CLI::Range(1, 1024));
  app.add_option("--spread", o.spread, "of the codes, in standard deviations of the library's")
      ->check(CLI::Range(0.0, 3.0));
  app.add_option("--library", o.library, "model file");
  app.add_option("--net", o.net, "its network");
  app.add_option("--seed", o.seed, "of the codes");
  app.add_option("-o,--output", o.output, "JSON file");
  CLI11_PARSE(app, argc, argv);
  return scree::guarded("bench_memory", [&] { return scree::bench::run(o); });
}

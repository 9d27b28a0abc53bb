// cost.cpp: time of a million distances and memory a grain, by kind of shape, Fig. 24 and Table 1.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <memory>
#include <stdexcept>

#include "kernels/sdf/grid.h"
#include "kernels/sdf/sdf_batch.h"
#include "shapes/compact_grain.h"
#include "shapes/mesh/mesh_distance.h"
#include "shapes/mesh_tree.h"
#include "shapes/model_file.h"
#include "shapes/random.h"
#include "training/studies/csv_file.h"
#include "training/studies/recipes.h"

namespace scree {
namespace {

double constexpr paper_cells[] = {0.05, 0.033};  // of its level sets [d]

// Time of this thread: a neighbour on the machine is not counted.
double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

// What the allocator has handed out [bytes].
double allocated() {
  auto const info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

// The truth at the points of a grid round the ball of 1.1 bounding radii, `cell` in d.
SdfGrid level_set(Body const& body, double cell, int threads) {
  double const half = 1.1 * body.bounding_radius;
  int const n = static_cast<int>(std::ceil(2 * half / cell)) + 1;
  SdfGrid grid{{{-half, -half, -half}, cell, n, n, n}, {}};
  std::vector<Vec3> point;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) point.push_back(grid.frame.origin + Vec3{i * cell, j * cell, k * cell});
  std::vector<double> phi(point.size());
  body.distance->evaluate(point, phi, {}, threads);
  grid.value.assign(phi.begin(), phi.end());
  return grid;
}

// Untrained: cost does not depend on the weights.
TrainedNet untrained(std::vector<Body> const& bodies, TrainOptions train) {
  train.steps = train.test_count = 1;
  train.samples.count = 100;
  return scree::train(bodies, train);
}

struct Networks {
  Mlp single, coded;
  std::vector<float> code;
  explicit Networks(Body const& body) {
    single = untrained({body}, default_single_options()).net;
    TrainedNet const decoder = untrained({body}, default_coded_options());
    coded = decoder.net;
    code = decoder.code[0];
  }
};

std::string net_detail(Mlp const& net) {
  return fmt::format("{}x{} {}", net.layers() - 1, net.width[1], to_string(net.activation));
}

}  // namespace

// One thread. Queries are uniform in the box of the bounding ball, all in one call. Trimesh as others have it (CGAL's
// tree, the sign from ray casting) and as the engine has it; level set and networks as the engine has them.
void study_query_time(StudyOptions const& options) {
  int const queries = options.quick ? 20000 : 1000000;
  Body const body = representative_grains()[1];
  CsvFile csv(options.folder / "query-time.csv", {"method", "detail", "seconds_per_million", "of_trimesh", "paper"});
  Random random(24);
  std::vector<Vec3> point(queries);
  std::vector<Vec3f> point_float(queries);
  for (int i = 0; i < queries; ++i) {
    for (int k = 0; k < 3; ++k) point[i][k] = body.bounding_radius * random.uniform(-1, 1);
    point_float[i] = to_float(point[i]);
  }
  double trimesh = 0;
  auto const time = [&](std::string const& method, std::string const& detail, double paper, int repeats,
                        std::function<void()> const& work) {
    std::vector<double> seconds;
    for (int i = 0; i < repeats; ++i) {
      double const start = thread_seconds();
      work();
      seconds.push_back((thread_seconds() - start) * 1e6 / queries);
    }
    std::sort(seconds.begin(), seconds.end());
    double const median = seconds[seconds.size() / 2];
    if (trimesh == 0) trimesh = median;
    csv.row(method, detail, median, median / trimesh, paper);
  };
  std::vector<double> phi(queries);
  std::vector<float> phi_float(queries);
  std::string const triangles = fmt::format("{} triangles", body.mesh.triangle.size());
  MeshDistance const cgal(body.mesh);
  time("Trimesh, CGAL", triangles, 1, 1, [&] { cgal.evaluate(point, phi, {}, 1); });
  MeshTree const tree(body.mesh);
  time("Trimesh, engine", triangles, 1, 3, [&] {
    for (int i = 0; i < queries; ++i) phi[i] = mesh_distance(tree.sdf(), point[i], nullptr);
  });
  for (double cell : paper_cells) {
    SdfGrid const grid = level_set(body, cell, options.threads);
    time("level set", fmt::format("cell {}", cell), 0.01, 5, [&] {
      for (int i = 0; i < queries; ++i) phi[i] = grid_distance(grid.frame, grid.value, point[i], nullptr);
    });
  }
  Networks const nets(body);
  auto const time_net = [&](std::string const& method, Mlp const& net, std::vector<float> const& code) {
    PackedMlp const packed(net);
    std::vector<float> rows;
    packed.append_bias(fold_code(net, code), rows);
    time(method, net_detail(net), 0.5, 5, [&] { sdf_forward({}, packed, rows, point_float, {}, phi_float); });
  };
  time_net("SingleNetSDF", nets.single, {});
  time_net("CodedNetSDF", nets.coded, nets.code);
}

// Bytes that the allocator hands out for many copies, over their number: what a particle costs that keeps its own
// shape, as in the paper, and with a library what it costs in a shared decoder.
void study_memory(StudyOptions const& options) {
  Body const body = representative_grains()[1];
  CsvFile csv(options.folder / "memory.csv", {"method", "detail", "kilobytes", "paper"});
  auto const measure = [&](std::string const& method, std::string const& detail, double paper,
                           std::function<std::shared_ptr<void>()> const& make) {
    std::vector<std::shared_ptr<void>> all(options.quick ? 4 : 50);
    double const before = allocated();
    for (auto& one : all) one = make();
    csv.row(method, detail, (allocated() - before) / static_cast<double>(all.size()) / 1000, paper);
  };
  std::string const triangles = fmt::format("{} triangles", body.mesh.triangle.size());
  double constexpr paper_trimesh = 386.99, paper_level_set[] = {235.11, 615.25}, paper_single = 48.42,
                   paper_coded = 66.12;  // [kB]
  measure("Trimesh, CGAL", triangles, paper_trimesh, [&] { return std::make_shared<MeshDistance>(body.mesh); });
  measure("Trimesh, engine", triangles, paper_trimesh, [&] { return std::make_shared<MeshTree>(body.mesh); });
  for (int i : {0, 1}) {
    SdfGrid const grid = level_set(body, paper_cells[i], options.threads);
    measure("level set", fmt::format("cell {}", paper_cells[i]), paper_level_set[i],
            [&] { return std::make_shared<SdfGrid>(grid); });
  }
  Networks const nets(body);
  measure("SingleNetSDF, weights", net_detail(nets.single), paper_single,
          [&] { return std::make_shared<Mlp>(nets.single); });
  measure("SingleNetSDF, evaluator", net_detail(nets.single), paper_single,
          [&] { return std::make_shared<PackedMlp>(nets.single); });
  measure("CodedNetSDF, own weights", net_detail(nets.coded), paper_coded,
          [&] { return std::make_shared<Mlp>(nets.coded); });
  measure("CodedNetSDF, own evaluator", net_detail(nets.coded), paper_coded,
          [&] { return std::make_shared<PackedMlp>(nets.coded); });
  if (options.library.empty()) return;
  // What a grain adds to a decoder that all share: its nodes, culling data, frame and folded first layer.
  struct SharedGrain {
    CompactGrain grain;
    std::vector<float> first_bias;
  };
  Library const library = read_model(options.library);
  int constexpr nodes = 1000;
  CompactGrainMaker const maker(library, 0, nodes);
  SharedGrain shared;
  std::vector<float> const code = library.shape.at(0).code;
  if (maker.make(code, shared.grain) != GrainFault::none)
    throw std::invalid_argument(options.library.string() + ": its first shape makes no compact grain");
  shared.first_bias = fold_code(library.net[0], code);
  // A copy has no spare capacity.
  measure("CodedNetSDF, shared network", fmt::format("{} nodes", nodes), paper_coded,
          [&] { return std::make_shared<SharedGrain>(shared); });
}

}  // namespace scree

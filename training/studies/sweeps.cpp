// sweeps.cpp: error against one number of the recipe, Figs. 20 to 23.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <functional>

#include "training/studies/csv_file.h"
#include "training/studies/recipes.h"

namespace scree {
namespace {

struct Sweep {
  std::string study;               // and file
  std::string column;              // the number that varies
  std::vector<int> single, coded;  // its values; empty: this kind of network is left out
  std::function<void(TrainOptions&, int)> set;
};

// A quick run takes the ends only.
std::vector<int> values(std::vector<int> const& all, bool quick) {
  return quick && all.size() > 2 ? std::vector<int>{all.front(), all.back()} : all;
}

void run(StudyOptions const& options, Sweep const& sweep) {
  std::vector<Body> const bodies = representative_grains();
  CsvFile csv(options.folder / (sweep.study + ".csv"),
              {"recipe", "model", "shape", sweep.column, "mae", "p99", "max", "seconds"});
  auto const train_and_add = [&](Recipe recipe, std::string const& model, std::vector<Body> const& group, int value) {
    sweep.set(recipe.train, value);
    std::string const name = group.size() == 1 ? group[0].name : "four grains";
    TrainedNet const net =
        train_announced(fmt::format("{} {} {} {}", recipe.name, name, sweep.column, value), group, recipe.train);
    for (std::size_t b = 0; b < group.size(); ++b) {
      FieldErrors const e = field_errors(trained_phi(net, static_cast<int>(b), options.threads), group[b],
                                         error_points(options), options.threads);
      csv.row(recipe.name, model, group[b].name, value, e.mae, e.p99, e.max, net.seconds);
    }
  };
  for (Recipe const& recipe : single_recipes(options, Effort::sweep))
    for (Body const& body : bodies)
      for (int value : values(sweep.single, options.quick)) train_and_add(recipe, "single", {body}, value);
  for (Recipe const& recipe : coded_recipes(options, static_cast<int>(bodies.size()), Effort::sweep))
    for (int value : values(sweep.coded, options.quick)) train_and_add(recipe, "coded", bodies, value);
}

}  // namespace

// The paper trains by epochs, so its steps follow the number of samples; ours are a fixed number.
void study_samples(StudyOptions const& options) {
  auto const set = [](TrainOptions& train, int count) {
    if (train.schedule == Schedule::constant)
      train.steps = static_cast<int>(1.0 * train.steps * count / train.samples.count);
    train.samples.count = count;
  };
  run(options, {"samples", "samples", {500, 1000, 2000, 5000, 10000, 20000}, {}, set});
}

void study_layers(StudyOptions const& options) {
  run(options, {"layers", "layers", {2, 3, 4, 5, 6, 7, 9}, {1, 2, 3, 4, 5, 6, 8}, [](TrainOptions& train, int layers) {
                  train.layers = layers;
                }});
}

// 64 neurons are what the evaluators take at most; the paper goes further and finds no gain beyond 70.
void study_nodes(StudyOptions const& options) {
  run(options, {"nodes", "nodes", {15, 20, 30, 40, 50, 64}, {20, 30, 40, 50, 64}, [](TrainOptions& train, int width) {
                  train.width = width;
                }});
}

void study_latent_size(StudyOptions const& options) {
  run(options, {"latent-size", "latent_size", {}, {2, 4, 6, 8, 10, 12, 16}, [](TrainOptions& train, int size) {
                  train.code_size = size;
                }});
}

}  // namespace scree

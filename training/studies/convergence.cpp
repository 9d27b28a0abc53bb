// convergence.cpp: errors by epoch and the epoch that is kept, Figs. 10 and 13.
// SPDX-License-Identifier: Apache-2.0
#include "training/studies/csv_file.h"
#include "training/studies/recipes.h"

namespace scree {
namespace {

std::vector<std::string> const columns{"recipe", "shape", "epoch", "step", "train_mae", "test_mae", "kept"};

void write_history(CsvFile& csv, Recipe const& recipe, std::vector<Body> const& bodies, TrainedNet const& net) {
  for (std::size_t b = 0; b < bodies.size(); ++b)
    for (EpochRecord const& r : net.history)
      csv.row(recipe.name, bodies[b].name, r.epoch, r.step, r.train_mae, r.body_mae[b],
              r.epoch == net.best_epoch ? 1 : 0);
}

}  // namespace

// One network a grain. Training MAE: of the samples as they were trained on, not in the paper's shell for `ours`.
void study_convergence(StudyOptions const& options) {
  CsvFile csv(options.folder / "convergence.csv", columns);
  for (Recipe const& recipe : single_recipes(options, Effort::full))
    for (Body const& body : representative_grains())
      write_history(csv, recipe, {body}, train_announced(recipe.name + " " + body.name, {body}, recipe.train));
}

// One decoder for four grains. The paper tells of a plateau near 200 epochs: its recipe gets 250 here.
void study_coded_convergence(StudyOptions const& options) {
  std::vector<Body> const bodies = representative_grains();
  CsvFile csv(options.folder / "coded-convergence.csv", columns);
  for (Recipe recipe : coded_recipes(options, static_cast<int>(bodies.size()), Effort::full)) {
    if (recipe.name == "paper" && !options.quick)
      recipe.train.steps = steps_of_epochs(recipe.train, static_cast<int>(bodies.size()), 250);
    write_history(csv, recipe, bodies, train_announced(recipe.name + " four grains", bodies, recipe.train));
  }
}

}  // namespace scree

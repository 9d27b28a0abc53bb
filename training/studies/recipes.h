// recipes.h: what studies train, and how well it came out.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "shapes/phi_batch.h"
#include "training/studies/study.h"
#include "training/train.h"

namespace scree {

// "paper": that of Li et al. (2026); "ours": Scree's defaults with fewer steps.
struct Recipe {
  std::string name;
  TrainOptions train;
};

// How long `ours` trains: `sweep` a quarter of the steps, for studies that train dozens of networks.
enum class Effort { sweep, full };

std::vector<Recipe> single_recipes(StudyOptions const& options, Effort effort);
std::vector<Recipe> coded_recipes(StudyOptions const& options, int shapes, Effort effort);

// One of each kind, the middle of its five aspect ratios: ballast/2, cobble/2, ellipsoid/2, sand/2.
std::vector<Body> representative_grains();
std::vector<Body> all_grains();

// Against the truth, at points that no training of the studies sees [d].
struct FieldErrors {
  double mae = 0, p99 = 0, max = 0;  // in the paper's shell
  double band_mae = 0;               // within 0.05 d of the surface
};
FieldErrors field_errors(PhiBatch const& phi, Body const& body, int points, int threads);

// phi of one body of a trained network, in the body's frame.
PhiBatch trained_phi(TrainedNet const& net, int body, int threads);

// Trains, and says so in one line on stdout: what, how long, mean MAE.
TrainedNet train_announced(std::string const& what, std::vector<Body> const& bodies, TrainOptions const& options);

// all_grains() in one decoder: read from options.library, else trained. Their phi is in the bodies' frames, as trained:
// a published shape's own normalisation is left out.
Library grain_library(StudyOptions const& options);

int error_points(StudyOptions const& options);  // for field_errors

}  // namespace scree

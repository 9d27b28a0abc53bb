// train_commands.h: the commands of scree-train, each in a file of its own, and what they share.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "shapes/triangle_mesh.h"
#include "training/dataset.h"
#include "training/options.h"
#include "training/train.h"

namespace scree {

// What `fit` and `coded` are given on the command line.
struct TrainArguments {
  std::filesystem::path mesh, output, log;  // log: a CSV line an epoch; empty: none
  std::string name;                         // of the shape; empty: the mesh file's stem
  bool repair = false;                      // the mesh first, where it bounds no solid
  std::string set = "grains20";
  std::uint64_t set_seed = 1;      // of the procedural grains
  std::string recipe = "default";  // or "paper"
  double seconds = 0;              // 0: `steps` decides
  int epochs = 0;                  // 0: `steps` decides
  bool force = false, quiet = false;
  Checkpointing checkpointing;
  TrainOptions train;
};

// Options shared by every training; `arguments` holds their defaults and must outlive the parsing.
void add_training_options(CLI::App& command, TrainArguments& arguments);

// Trains, certifies, writes the model and prints what came out. Returns the exit code.
int train_and_write(TrainArguments const& arguments, std::vector<Body> const& bodies);

// A closed mesh, normalised. One with defects is repaired where `repair` asks for it, telling what was done; else
// std::invalid_argument names the file, all its defects and the way out.
TriangleMesh read_closed_mesh(std::filesystem::path const& file, bool repair);

// Each adds its subcommand, which sets `chosen` when it is called.
void add_fit_command(CLI::App& app, std::function<int()>& chosen);
void add_coded_command(CLI::App& app, std::function<int()>& chosen);
void add_encode_command(CLI::App& app, std::function<int()>& chosen);
void add_study_command(CLI::App& app, std::function<int()>& chosen);
void add_dataset_command(CLI::App& app, std::function<int()>& chosen);

}  // namespace scree

// study.h: the reference paper's figures 8 to 24 and its table 1, each as one function that writes CSV files.
// Pictures are drawn from the CSV files by tools/python/plot_study.py.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace scree {

struct StudyOptions {
  std::filesystem::path folder;   // exists; CSV files and meshes/ are written into it, replacing what is there
  std::filesystem::path library;  // model file of the 20 grains; empty: studies that need one train it
  bool quick = false;             // seconds instead of minutes: fewer shapes, points and steps; shows no accuracy
  int threads = 1;                // change no result but times
};

struct Study {
  char const* name;
  char const* figure;   // of the reference paper
  char const* subject;  // one line
  void (*run)(StudyOptions const&);
};

// In the paper's order.
std::vector<Study> const& studies();

// Throws std::invalid_argument listing all names.
Study const& find_study(std::string const& name);

void study_templates(StudyOptions const& options);
void study_convergence(StudyOptions const& options);
void study_superellipsoids(StudyOptions const& options);
void study_single_scatter(StudyOptions const& options);
void study_coded_convergence(StudyOptions const& options);
void study_extremes(StudyOptions const& options);
void study_coded_scatter(StudyOptions const& options);
void study_coded_grains(StudyOptions const& options);
void study_interpolation(StudyOptions const& options);
void study_latent(StudyOptions const& options);
void study_samples(StudyOptions const& options);
void study_layers(StudyOptions const& options);
void study_nodes(StudyOptions const& options);
void study_latent_size(StudyOptions const& options);
void study_query_time(StudyOptions const& options);
void study_memory(StudyOptions const& options);

}  // namespace scree

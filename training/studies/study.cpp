// study.cpp: the table of studies.
// SPDX-License-Identifier: Apache-2.0
#include "training/studies/study.h"

#include <stdexcept>

namespace scree {

std::vector<Study> const& studies() {
  static std::vector<Study> const table{
      {"templates", "Figs. 8, 9", "the benchmark shapes", study_templates},
      {"convergence", "Fig. 10", "error by epoch, SingleNetSDF", study_convergence},
      {"superellipsoids", "Fig. 11", "errors of 125 superellipsoids, SingleNetSDF", study_superellipsoids},
      {"single-scatter", "Fig. 12", "predicted against true distance, SingleNetSDF", study_single_scatter},
      {"coded-convergence", "Fig. 13", "error by epoch, CodedNetSDF", study_coded_convergence},
      {"extremes", "Fig. 14", "sphere and strip, CodedNetSDF", study_extremes},
      {"coded-scatter", "Fig. 15", "predicted against true distance, CodedNetSDF", study_coded_scatter},
      {"coded-grains", "Fig. 16", "errors of 20 grains in one CodedNetSDF", study_coded_grains},
      {"interpolation", "Figs. 17, 18", "shapes between two codes", study_interpolation},
      {"latent", "Fig. 19", "codes in two dimensions, and sampled shapes", study_latent},
      {"samples", "Fig. 20", "error by samples a shape", study_samples},
      {"layers", "Fig. 21", "error by hidden layers", study_layers},
      {"nodes", "Fig. 22", "error by neurons a layer", study_nodes},
      {"latent-size", "Fig. 23", "error by latent numbers", study_latent_size},
      {"query-time", "Fig. 24", "time of a million queries", study_query_time},
      {"memory", "Table 1", "memory a grain", study_memory}};
  return table;
}

Study const& find_study(std::string const& name) {
  std::string names;
  for (Study const& study : studies()) {
    if (name == study.name) return study;
    names += std::string(names.empty() ? "" : ", ") + study.name;
  }
  throw std::invalid_argument("no study '" + name + "'; there are " + names);
}

}  // namespace scree

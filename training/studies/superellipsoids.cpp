// superellipsoids.cpp: one network for each of the 125 superellipsoids, Fig. 11.
// SPDX-License-Identifier: Apache-2.0
#include "training/studies/csv_file.h"
#include "training/studies/recipes.h"
#include "training/studies/superellipsoid_set.h"

namespace scree {

void study_superellipsoids(StudyOptions const& options) {
  CsvFile csv(options.folder / "superellipsoids.csv",
              {"recipe", "exponent", "elongation", "flatness", "mae", "p99", "max", "band_mae", "seconds"});
  std::vector<SetSuperellipsoid> const set = superellipsoid_set();
  for (std::size_t i = 0; i < set.size(); ++i) {
    SetSuperellipsoid const& s = set[i];
    bool const corner = (s.elongation == 0.4 || s.elongation == 1) && s.elongation == s.flatness;
    if (options.quick && !corner) continue;
    Body const body = superellipsoid_body(s);
    for (Recipe const& recipe : single_recipes(options, Effort::full)) {
      TrainedNet const net = train_announced(recipe.name + " " + body.name, {body}, recipe.train);
      FieldErrors const e =
          field_errors(trained_phi(net, 0, options.threads), body, error_points(options), options.threads);
      csv.row(recipe.name, s.exponent, s.elongation, s.flatness, e.mae, e.p99, e.max, e.band_mae, net.seconds);
    }
  }
}

}  // namespace scree

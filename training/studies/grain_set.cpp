// grain_set.cpp: the benchmark shapes, and the 20 grains in one decoder, Figs. 8, 9 and 16.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/descriptors.h"
#include "training/studies/csv_file.h"
#include "training/studies/pictures.h"
#include "training/studies/recipes.h"
#include "training/studies/superellipsoid_set.h"

namespace scree {

void study_templates(StudyOptions const& options) {
  CsvFile csv(options.folder / "templates.csv", {"shape", "sphericity", "convexity", "elongation", "flatness", "mesh"});
  auto const add = [&](std::string const& name, TriangleMesh const& mesh) {
    Descriptors const d = describe(mesh);
    csv.row(name, d.sphericity, d.convexity, d.elongation, d.flatness, write_picture_mesh(options, name, mesh));
  };
  int const cells = options.quick ? 8 : 24;
  for (double exponent : superellipsoid_exponents)
    for (double ratio : {1.0, 0.7, 0.4}) {
      Shape const shape = set_superellipsoid(ratio, ratio, exponent).shape;
      add(shape.name, superellipsoid_mesh(shape, cells));
    }
  for (Body const& body : all_grains()) add(body.name, body.mesh);
}

// The paper's recipe is trained here; ours is options.library where one is given.
void study_coded_grains(StudyOptions const& options) {
  std::vector<Body> const bodies = all_grains();
  CsvFile csv(options.folder / "coded-grains.csv", {"recipe", "shape", "mae", "p99", "max", "band_mae"});
  auto const add = [&](std::string const& recipe, Body const& body, PhiBatch const& phi) {
    FieldErrors const e = field_errors(phi, body, error_points(options), options.threads);
    csv.row(recipe, body.name, e.mae, e.p99, e.max, e.band_mae);
  };
  int const shapes = static_cast<int>(bodies.size());
  Library const ours = grain_library(options);
  Recipe const paper = coded_recipes(options, shapes, Effort::full).front();
  TrainedNet const theirs = train_announced("paper 20 grains", bodies, paper.train);
  for (int i = 0; i < shapes; ++i) add("paper", bodies[i], trained_phi(theirs, i, options.threads));
  for (int i = 0; i < shapes; ++i) add("ours", bodies[i], fast_phi(ours, ours.shape[i], options.threads));
}

}  // namespace scree

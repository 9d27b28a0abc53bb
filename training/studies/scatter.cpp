// scatter.cpp: predicted against true distance, and the surfaces themselves, Figs. 12, 14 and 15.
// SPDX-License-Identifier: Apache-2.0
#include "training/studies/csv_file.h"
#include "training/studies/pictures.h"
#include "training/studies/recipes.h"
#include "training/studies/superellipsoid_set.h"

namespace scree {
namespace {

// Two tables: <study>.csv of errors with the meshes' files, <study>-points.csv of single points.
class Scatter {
 public:
  Scatter(StudyOptions const& options, std::string const& study)
      : options_(options),
        errors_(options.folder / (study + ".csv"),
                {"recipe", "shape", "mae", "p99", "max", "band_mae", "true_mesh", "net_mesh"}),
        points_(options.folder / (study + "-points.csv"), {"recipe", "shape", "true_phi", "net_phi"}),
        study_(study) {}

  void add(std::string const& recipe, Body const& body, PhiBatch const& phi) {
    FieldErrors const e = field_errors(phi, body, error_points(options_), options_.threads);
    errors_.row(recipe, body.name, e.mae, e.p99, e.max, e.band_mae,
                write_picture_mesh(options_, study_ + "-true-" + body.name, body.mesh),
                write_picture_mesh(options_, study_ + "-" + recipe + "-" + body.name,
                                   picture_surface(options_, phi, 1.1 * body.bounding_radius).mesh));
    int constexpr drawn = 400;
    std::uint64_t constexpr seed = 0xd07;
    Samples const truth = shell_samples(body, drawn, seed, options_.threads);
    std::vector<double> net(drawn);
    phi(truth.point, net, {});
    for (int i = 0; i < drawn; ++i) points_.row(recipe, body.name, truth.phi[i], net[i]);
  }

  // One decoder for all bodies.
  void add_coded(std::vector<Body> const& bodies, std::string const& what) {
    for (Recipe const& recipe : coded_recipes(options_, static_cast<int>(bodies.size()), Effort::full)) {
      TrainedNet const net = train_announced(recipe.name + " " + what, bodies, recipe.train);
      for (std::size_t b = 0; b < bodies.size(); ++b)
        add(recipe.name, bodies[b], trained_phi(net, static_cast<int>(b), options_.threads));
    }
  }

 private:
  StudyOptions options_;
  CsvFile errors_, points_;
  std::string study_;
};

}  // namespace

void study_single_scatter(StudyOptions const& options) {
  Scatter scatter(options, "single-scatter");
  for (Recipe const& recipe : single_recipes(options, Effort::full))
    for (Body const& body : representative_grains()) {
      TrainedNet const net = train_announced(recipe.name + " " + body.name, {body}, recipe.train);
      scatter.add(recipe.name, body, trained_phi(net, 0, options.threads));
    }
}

// The roundest and the longest body of the set.
void study_extremes(StudyOptions const& options) {
  Body sphere = superellipsoid_body(set_superellipsoid(1, 1, 1));
  Body strip = superellipsoid_body(set_superellipsoid(0.4, 0.4, 0.6));
  sphere.name = "sphere", strip.name = "strip";
  Scatter(options, "extremes").add_coded({sphere, strip}, "sphere and strip");
}

void study_coded_scatter(StudyOptions const& options) {
  Scatter(options, "coded-scatter").add_coded(representative_grains(), "four grains");
}

}  // namespace scree

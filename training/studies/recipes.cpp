// recipes.cpp: what studies train, and how well it came out.
// SPDX-License-Identifier: Apache-2.0
#include "training/studies/recipes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <stdexcept>

#include "shapes/mesh/procedural_grains.h"
#include "shapes/model_file.h"
#include "shapes/random.h"

namespace scree {
namespace {

std::uint64_t constexpr unseen =
    0x7e57;                    // seed of points to measure with; trainings draw theirs from 1, 501, 1001, ...
double constexpr band = 0.05;  // the contact region [d]

// Quick runs keep the recipe and shorten it.
TrainOptions adapted(TrainOptions train, StudyOptions const& options) {
  train.threads = options.threads;
  if (options.quick) {
    train.steps = std::min(train.steps, train.rows <= 256 ? 600 : 100);
    train.samples.count = std::min(train.samples.count, train.rows <= 256 ? 4000 : 8000);
    train.test_count = 500;
  }
  return train;
}

Body body_of(ProceduralGrain grain) { return make_body(grain.name, std::move(grain.mesh), grain.formula); }

// Network 0 of a library, evaluated where it was trained.
Shape raw_shape(std::string const& name, std::vector<float> const& code) {
  Shape shape;
  shape.name = name;
  shape.kind = ShapeKind::net;
  shape.net = 0;
  shape.code = code;
  return shape;
}

}  // namespace

std::vector<Recipe> single_recipes(StudyOptions const& options, Effort effort) {
  TrainOptions ours = default_single_options();
  ours.steps = effort == Effort::sweep ? 1000 : 4000;
  return {{"paper", adapted(paper_single_options(), options)}, {"ours", adapted(ours, options)}};
}

std::vector<Recipe> coded_recipes(StudyOptions const& options, int shapes, Effort effort) {
  TrainOptions ours = default_coded_options();
  ours.steps = effort == Effort::sweep ? 1000 : 4000;
  return {{"paper", adapted(paper_coded_options(shapes), options)}, {"ours", adapted(ours, options)}};
}

std::vector<Body> representative_grains() {
  std::vector<Body> bodies;
  for (GrainKind kind : {GrainKind::ballast, GrainKind::cobble, GrainKind::ellipsoid, GrainKind::sand})
    bodies.push_back(body_of(procedural_grain(kind, 2)));
  return bodies;
}

std::vector<Body> all_grains() {
  std::vector<Body> bodies;
  for (ProceduralGrain& grain : procedural_grains()) bodies.push_back(body_of(std::move(grain)));
  return bodies;
}

FieldErrors field_errors(PhiBatch const& phi, Body const& body, int points, int threads) {
  auto const errors = [&](Samples const& truth) {
    std::vector<double> value(truth.point.size());
    phi(truth.point, value, {});
    for (std::size_t i = 0; i < value.size(); ++i) value[i] = std::abs(value[i] - truth.phi[i]);
    return value;
  };
  auto const mean = [](std::vector<double> const& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
  };
  FieldErrors result;
  std::vector<double> shell = errors(shell_samples(body, points, unseen, threads));
  std::sort(shell.begin(), shell.end());
  result.mae = mean(shell);
  result.p99 = shell[static_cast<std::size_t>(0.99 * static_cast<double>(shell.size() - 1))];
  result.max = shell.back();

  Random random(unseen + 1);
  Samples near = surface_samples(body, points, unseen + 2);
  for (std::size_t i = 0; i < near.point.size(); ++i) near.point[i] += near.gradient[i] * random.uniform(-band, band);
  body.distance->evaluate(near.point, near.phi, {}, threads);
  result.band_mae = mean(errors(near));
  return result;
}

PhiBatch trained_phi(TrainedNet const& net, int body, int threads) {
  Shape const shape = raw_shape("", net.code.at(body));
  Library library;
  library.net.push_back(net.net);
  return fast_phi(library, shape, threads);
}

TrainedNet train_announced(std::string const& what, std::vector<Body> const& bodies, TrainOptions const& options) {
  fmt::print("{}: {} steps ... ", what, options.steps);
  std::fflush(stdout);
  TrainedNet net = train(bodies, options);
  double const mae = std::accumulate(net.mae.begin(), net.mae.end(), 0.0) / static_cast<double>(net.mae.size());
  fmt::print("MAE {:.2e} d, {:.1f} s\n", mae, net.seconds);
  std::fflush(stdout);
  return net;
}

Library grain_library(StudyOptions const& options) {
  std::vector<Body> const bodies = all_grains();
  Library library;
  if (options.library.empty()) {
    int const shapes = static_cast<int>(bodies.size());
    TrainedNet const trained =
        train_announced("ours 20 grains", bodies, coded_recipes(options, shapes, Effort::full).back().train);
    library.net.push_back(trained.net);
    for (int i = 0; i < shapes; ++i) library.shape.push_back(raw_shape(bodies[i].name, trained.code[i]));
  } else {
    try {
      library = read_model(options.library);
    } catch (std::runtime_error const& error) {
      throw std::invalid_argument(error.what());
    }
    for (Shape& shape : library.shape) shape = raw_shape(shape.name, shape.code);
  }
  bool same = library.shape.size() == bodies.size() && library.net.size() == 1;
  for (std::size_t i = 0; same && i < bodies.size(); ++i)
    same = library.shape[i].name == bodies[i].name && !library.shape[i].code.empty();
  if (!same)
    throw std::invalid_argument(options.library.string() +
                                ": the 20 procedural grains in one decoder are needed, as scree-train coded writes");
  for (std::size_t i = 0; i < bodies.size(); ++i) library.shape[i].bounding_radius = bodies[i].bounding_radius;
  return library;
}

int error_points(StudyOptions const& options) { return options.quick ? 1000 : 20000; }

}  // namespace scree

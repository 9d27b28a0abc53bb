// bad_network_entries.cpp: networks of bad quality: what is differentiable conserves energy, the gate names the rest.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include "core/certificate_gate.h"
#include "shapes/certify_phi.h"
#include "shapes/generate.h"
#include "shapes/latent.h"
#include "shapes/model_file.h"
#include "shapes/normalise.h"
#include "tests/hard/course.h"
#include "tests/support/pebble_decoder.h"

namespace scree::book {
namespace {

using namespace testing;
namespace fs = std::filesystem;

class ModelFile {
 public:
  ModelFile() : path(fs::temp_directory_path() / ("scree_bad_net_" + std::to_string(::getpid()) + ".h5")) {}
  ~ModelFile() { fs::remove(path); }
  fs::path const path;
};

Library one_net(Mlp const& net, double radius, std::string const& name) {
  Library library;
  library.net = {net};
  Shape shape;
  shape.name = name;
  shape.kind = ShapeKind::net;
  shape.net = 0;
  library.shape = {shape};
  normalise_net(library, 0, radius);
  certify_phi(library, library.shape[0], {3000, 500, 1}, library.shape[0].certificate);
  return library;
}

// The convex network of the pebbles without its code; `noise`: relative, on every weight.
Mlp pebble(double noise, unsigned seed) {
  Mlp const coded = test::pebble_net();
  int const hidden = coded.width[1];
  Mlp net = coded;
  net.width = {3, hidden, 1};
  net.weight[0].resize(3 * std::size_t(hidden));  // inputs first: the rows of the code fall away
  std::mt19937 random(seed);
  std::normal_distribution<float> draw(0, static_cast<float>(noise));
  for (auto& layer : net.weight)
    for (float& w : layer) w *= 1 + draw(random);
  for (float& b : net.bias[0]) b += 0.3f * draw(random);
  return net;
}

// One body slopes twice as much on its +x side as a distance would, and half as much on the other.
Mlp warped() {
  Mlp net = pebble(0, 1);
  int const hidden = net.width[1];
  for (int i = 0; i < hidden; ++i) {
    double const nx = net.weight[0][i];  // input-major: row 0 is x
    net.weight[1][i] *= static_cast<float>(1 + 0.6 * nx);
  }
  return net;
}

// phi = sum of cosines: its positive part inside the ball is two blobs.
Mlp two_blobs() {
  Mlp net;
  net.activation = Activation::sine;
  net.parameter = 1;
  net.width = {3, 3, 1};
  float const w = static_cast<float>(2 * M_PI);
  net.weight = {{w, 0, 0, 0, w / 2, 0, 0, 0, w / 2}, {-0.1f, 0.1f, 0.1f}};
  net.bias = {std::vector<float>(3, static_cast<float>(M_PI / 2)), {-0.2f}};
  return net;
}

struct Collisions {
  double worst = 0;  // relative change of the kinetic energy
  double overlap = 0;
  std::string stopped;
};

Collisions collide(fs::path const& model, std::string const& shape, LimitsCase const& limits, int poses) {
  Collisions out;
  for (int pose = 0; pose < poses; ++pose) {
    std::mt19937 random(pose);
    std::uniform_real_distribution<double> u(-1, 1);
    Case c = rock_case();
    c.limits = limits;
    c.limits.overlap = 0.5;
    c.library = {{"bad", model}};
    GrainsCase a = grains_at("bad:" + shape, {{-0.1, 0.01 * u(random), 0.01 * u(random)}});
    GrainsCase b = grains_at("bad:" + shape, {{0.1, 0, 0}});
    b.name = "other";
    for (GrainsCase* g : {&a, &b})
      g->insert.quaternion = {normalized(Quat{u(random), u(random), u(random), u(random)})};
    a.insert.velocity = {2, 0, 0}, b.insert.velocity = {-2, 0.2, 0};
    c.grains = {a, b};
    c.time.end = 0.05;
    Simulation s(c, {});
    double const before = s.ledger().kinetic;
    Course const run = follow(s);
    if (!run.stopped.empty()) out.stopped = run.stopped;
    out.overlap = std::max(out.overlap, run.overlap);
    EXPECT_EQ(s.largest_overlap(), 0) << "still in contact";
    out.worst = std::max(out.worst, std::abs(s.ledger().kinetic / before - 1));
  }
  return out;
}

TEST(Hard, BadNetworksConserveEnergyOrAreRefused) {
  Entry book("hard", "bad-nets", "noisy phi, |grad phi| from 0.5 to 2, a code at 4 sigma",
             "exact gradient: kinetic energy kept to 3e-4 for any differentiable phi");
  ModelFile const file;
  struct Bad {
    char const* name;
    Mlp net;
  };
  for (Bad const& bad : {Bad{"noise 5 % on every weight", pebble(0.05, 3)},
                         Bad{"noise 15 % on every weight", pebble(0.15, 4)}, Bad{"warped slope", warped()}}) {
    Library const library = one_net(bad.net, 1.5, "bad");
    Certificate const& k = library.shape[0].certificate;
    write_model(file.path, library, true);
    std::vector<std::string> const refused = gate_problems(library.shape[0], file.path, {});
    for (std::string const& line : refused) EXPECT_TRUE(says(line, "'bad'") && says(line, "limits.")) << line;
    // The energy has to be kept whatever the gate thinks of it.
    LimitsCase open;
    open.gradient_low = 0.01, open.gradient_high = 100, open.falling = 1, open.components = 10, open.handles = 10;
    open.gap = 1;
    Collisions const c = collide(file.path, "bad", open, full() ? 20 : 2);
    EXPECT_EQ(c.stopped, "");
    EXPECT_GT(c.overlap, 1e-3);
    std::string const name = bad.name;
    book.at_most(name + ": kinetic energy changed", "", c.worst, 3e-4);
    book.trend(name + ": |grad phi|, 1st percentile", "", k.gradient_p1);
    book.trend(name + ": |grad phi|, 99th percentile", "", k.gradient_p99);
    book.trend(name + ": limits of the gate exceeded", "", static_cast<double>(refused.size()));
  }
}

TEST(Hard, CodesAtFourSigmaAreJudged) {
  Entry book("hard", "code-4-sigma", "codes 4 standard deviations out", "kept to 3e-4, or refused by name");
  ModelFile const file;
  Library library = read_model(fs::path(SCREE_SOURCE_DIR) / "shapes/library/grains.h5");
  int judged = 0, refused = 0;
  double worst = 0;
  for (std::string const& category : coded_categories(library)) {
    CodeGaussian const gaussian = fit_codes(library, category);
    for (double sigma : {4.0, -4.0}) {
      std::vector<float> code;
      for (std::size_t k = 0; k < gaussian.mean.size(); ++k)
        code.push_back(static_cast<float>(gaussian.mean[k] + sigma * gaussian.axis[0][k]));
      Candidate candidate = judge_code(library, code_frame(library, gaussian.net), code, {}, "far", "code at 4 sigma");
      ++judged;
      if (candidate.verdict != Verdict::accepted) {
        EXPECT_GT(std::string(to_string(candidate.verdict)).size(), 0u);
        ++refused;
        continue;
      }
      if (!full() && judged > 4) continue;
      Library own;
      own.net = library.net;
      own.shape = {candidate.shape};
      write_model(file.path, own, true);
      if (!gate_problems(candidate.shape, file.path, {}).empty()) {
        ++refused;
        continue;
      }
      worst = std::max(worst, collide(file.path, "far", {}, 2).worst);
    }
  }
  book.at_least("codes judged", "", judged, 2);
  book.trend("refused by name", "", refused);
  book.at_most("those that run: kinetic energy changed", "", worst, 3e-4);
}

TEST(Hard, TheGateNamesWhatItRefuses) {
  Entry book("hard", "gate", "two components, NaN weights", "refused by name");
  ModelFile const file;
  Library const two = one_net(two_blobs(), 0.9, "twins");
  book.absolute("two blobs: components in the certificate", "", 2, two.shape[0].certificate.components, 0);
  write_model(file.path, two, true);
  Case c = rock_case();
  c.library = {{"bad", file.path}};
  c.grains = {grains_at("bad:twins", {{0, 0, 0}})};
  std::string why;
  try {
    Simulation s(c, {});
  } catch (InputError const& e) {
    why = e.what();
  }
  EXPECT_TRUE(says(why, "twins") && says(why, "components") && says(why, "limits.components")) << why;
  Library nan = two;
  nan.net[0].weight[0][1] = std::numeric_limits<float>::quiet_NaN();
  std::string refusal;
  try {
    write_model(file.path, nan, true);
    Simulation s(c, {});
  } catch (std::exception const& e) {
    refusal = e.what();
  }
  EXPECT_TRUE(says(refusal, "finite")) << refusal;
  book.at_least("networks refused", "", (!why.empty()) + (!refusal.empty()), 2);
}

}  // namespace
}  // namespace scree::book

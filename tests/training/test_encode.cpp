// test_encode.cpp: codes of unseen bodies under a frozen decoder: exact where a code exists, near where one is close.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "shapes/normalise.h"
#include "shapes/phi_batch.h"
#include "shapes/zero_set.h"
#include "tests/support/random_mlp.h"
#include "tests/support/shape_kinds.h"
#include "tests/training/training_bodies.h"
#include "training/encode.h"
#include "training/net_derivatives.h"
#include "training/publish.h"
#include "training/train.h"

namespace scree {
namespace {

// Bodies of a convex decoder without symmetry; the codes shift three of its faces.
Library faceted(std::vector<std::vector<float>> const& codes) {
  Library library;
  library.net = {testing::softplus_body(3)};
  for (std::size_t i = 0; i < codes.size(); ++i) {
    Shape s;
    s.name = (i % 2 ? "odd/" : "even/") + std::to_string(i);
    s.kind = ShapeKind::net;
    s.net = 0;
    s.code = codes[i];
    library.shape.push_back(s);
    normalise_net(library, static_cast<int>(i), 1.5, {.cells = 32});
  }
  return library;
}
Library const& known() {
  static Library const library =
      faceted({{0.1f, -0.05f, 0}, {-0.1f, 0.05f, 0.1f}, {0, 0.1f, -0.1f}, {0.05f, 0, 0.15f}, {-0.05f, -0.1f, 0}});
  return library;
}

// phi of a decoder as if it were the truth, in a frame turned by half a turn about y.
class TurnedPhi : public Truth {
 public:
  explicit TurnedPhi(PhiBatch phi) : phi_(std::move(phi)) {}
  void evaluate(Span<const Vec3> point, Span<double> phi, Span<Vec3> gradient, int) const override {
    std::vector<Vec3> turned(point.begin(), point.end());
    for (Vec3& x : turned) x = {-x.x, x.y, -x.z};
    phi_(turned, phi, gradient);
    for (Vec3& g : gradient) g = {-g.x, g.y, -g.z};
  }

 private:
  PhiBatch phi_;
};

TriangleMesh surface(Library const& library, Shape const& s) {
  return find_zero_set(fast_phi(library, s), {1.05 * s.bounding_radius, 32, s.lipschitz}).mesh;
}

EncodeOptions quick() {
  EncodeOptions o;
  o.samples = o.test = 2000;
  o.trial = 300;
  return o;
}

TEST(NetDerivatives, AreThoseOfTheReference) {
  std::pair<Activation, double> const kinds[] = {
      {Activation::leaky_relu, 0.1}, {Activation::sine, 5}, {Activation::softplus, 8}};
  for (auto const& [activation, parameter] : kinds) {
    Mlp const net = test::random_mlp(activation, parameter, {5, 12, 9, 1}, 3);
    std::vector<float> code{0.3f, -0.2f};
    Vec3 const x{0.2, -0.4, 0.3};
    NetDerivatives::Output out;
    NetDerivatives(net).evaluate(Eigen::Vector3d(x.x, x.y, x.z), Eigen::Vector2d(code[0], code[1]), out);
    Vec3 gradient;
    double const phi = evaluate_reference(net, fold_code(net, code), x, &gradient);
    EXPECT_NEAR(out.phi(0), phi, 1e-6);  // the folded bias is a float
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(out.by_point(k, 0), gradient[k], 1e-6);
    for (int k = 0; k < 2; ++k) {
      // Central difference of the same evaluation: error h^2, and rounding 1e-16 / h.
      double const h = 1e-5;
      Eigen::Vector2d z(code[0], code[1]);
      NetDerivatives::Output more, less;
      z(k) += h;
      NetDerivatives(net).evaluate(Eigen::Vector3d(x.x, x.y, x.z), z, more);
      z(k) -= 2 * h;
      NetDerivatives(net).evaluate(Eigen::Vector3d(x.x, x.y, x.z), z, less);
      EXPECT_NEAR(out.by_code(k, 0), (more.phi(0) - less.phi(0)) / (2 * h), 1e-6);
    }
  }
}

TEST(Encode, FindsTheCodeAndTheTurnOfAGrainOfItsOwn) {
  std::vector<float> const code{-0.08f, 0.12f, 0.06f};
  Library const own = faceted({code});
  TriangleMesh mesh = surface(own, own.shape[0]);
  for (Vec3& v : mesh.vertex) v = {-v.x, v.y, -v.z};
  Body body = make_body("own", normalised(mesh), "zero set");
  body.distance = std::make_shared<TurnedPhi>(fast_phi(own, own.shape[0]));
  Encoding const found = encode(known(), body, quick());
  EXPECT_LT(found.start[0].after, 1e-5);  // the truth comes in float
  EXPECT_GT(found.start[0].before, 1e-3);
  EXPECT_EQ(found.start[0].turn, 2) << "it was turned about y";
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(found.shape.code[k], code[k], 1e-4);
  EXPECT_EQ(found.start.size(), 4 * (1 + 2 + 2));  // turns x (mean, two categories, two nearest)
}

TEST(Encode, AMeshOfItsOwnGrainIsMetAsWellAsByTheGrainItself) {
  Library own = faceted({{-0.08f, 0.12f, 0.06f}});
  Body const body = make_body("own", normalised(surface(own, own.shape[0])), "zero set");
  Library found = known();
  EncodeOptions options = quick();
  Encoding const made = encode(found, body, options);
  options.threads = 1;
  EXPECT_EQ(encode(found, body, options).shape.code, made.shape.code);
  found.shape.push_back(made.shape);
  PublishOptions publish;
  publish.points = 4000, publish.cells = 32, publish.nodes = 0;
  publish_shape(found, static_cast<int>(found.shape.size()) - 1, body, publish);
  publish_shape(own, 0, body, publish);  // the very code, against the same mesh
  Certificate const &a = found.shape.back().certificate, &b = own.shape[0].certificate;
  EXPECT_GT(b.mae, 1e-4);         // this phi is no distance
  EXPECT_LT(a.mae, 1.1 * b.mae);  // the shell has fewer points at the surface than what was fitted
  EXPECT_LT(a.band_mae, 1.1 * b.band_mae);
  EXPECT_EQ(a.components, 1);
  EXPECT_TRUE(problems(found).empty());
  EXPECT_NEAR(found.shape.back().volume, M_PI / 6, 1e-9);
}

// A decoder of five ellipsoids meets one between them, in another turn, better than any of the five does.
TEST(Encode, AnEllipsoidThatIsNotInTheSet) {
  std::vector<Body> bodies;
  Vec3 const axes[] = {{1.4, 1.2, 1}, {1.8, 1.2, 1}, {1.8, 1.6, 1}, {1.4, 1.3, 1}, {1.6, 1.2, 1}};
  for (Vec3 const& a : axes) bodies.push_back(ellipsoid_body("e/" + std::to_string(bodies.size()), a));
  TrainOptions train_options = tiny_options();
  train_options.code_size = 2;
  train_options.code_spread = 0.02;
  train_options.steps = 1200;
  PublishOptions publish_options;
  publish_options.points = 2000, publish_options.cells = 32, publish_options.nodes = 0;
  Library library = publish(train(bodies, train_options), bodies, publish_options);
  double worst = 0;
  for (Shape const& s : library.shape) worst = std::max(worst, s.certificate.mae);
  Encoding const made = encode(library, ellipsoid_body("new", {1.6, 1.4, 1}), quick());
  double nearest = 1;
  for (EncodeStart const& s : made.start) nearest = std::min(nearest, s.before);
  printf("known to %.1e, new %.1e -> %.1e\n", worst, nearest, made.start[0].after);
  EXPECT_LT(made.start[0].after, 0.5 * nearest);
  EXPECT_LT(made.start[0].after, 2 * worst);
}

TEST(Encode, WantsOneDecoderWithCodes) {
  Body const body = ellipsoid_body("e", {1.2, 1.1, 1}, 2);
  EXPECT_THROW(encode(Library{}, body, quick()), std::invalid_argument);
  EXPECT_THROW(encode(testing::library_of_kind("single_net"), body, quick()), std::invalid_argument);
  Library two = known();
  two.net.push_back(two.net[0]);
  two.shape[1].net = 1;
  EXPECT_THROW(encode(two, body, quick()), std::invalid_argument);
}

}  // namespace
}  // namespace scree

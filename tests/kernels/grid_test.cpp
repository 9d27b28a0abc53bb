// grid_test.cpp: trilinear phi against multilinear functions, its gradient against differences, and beyond the box.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sdf/grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace scree {
namespace {

GridFrame const frame{{-0.5, -0.4, -0.3}, 0.125, 9, 8, 7};

// Values of f at the grid points.
template <class F>
std::vector<float> sampled(F const& f) {
  std::vector<float> value;
  for (int k = 0; k < frame.nz; ++k)
    for (int j = 0; j < frame.ny; ++j)
      for (int i = 0; i < frame.nx; ++i)
        value.push_back(static_cast<float>(f(frame.origin + Vec3{double(i), double(j), double(k)} * frame.cell)));
  return value;
}

Vec3 far_corner() {
  return frame.origin + Vec3{double(frame.nx - 1), double(frame.ny - 1), double(frame.nz - 1)} * frame.cell;
}

// 0.3 - |x|, negative on all faces of the box.
double ball(Vec3 x) { return 0.28 - norm(x); }

TEST(GridDistance, ReproducesMultilinearFunctions) {
  auto const f = [](Vec3 x) {
    return -2 + 0.5 * x.x - x.y + 0.25 * x.z + x.x * x.y - 0.5 * x.y * x.z + 2 * x.z * x.x + 4 * x.x * x.y * x.z;
  };
  auto const slope = [](Vec3 x) {
    return Vec3{0.5 + x.y + 2 * x.z + 4 * x.y * x.z, -1 + x.x - 0.5 * x.z + 4 * x.x * x.z,
                0.25 - 0.5 * x.y + 2 * x.x + 4 * x.x * x.y};
  };
  std::vector<float> const value = sampled(f);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, 1);
  for (int i = 0; i < 200; ++i) {
    Vec3 const x = frame.origin + multiply(far_corner() - frame.origin, {u(random), u(random), u(random)});
    Vec3 gradient;
    EXPECT_NEAR(grid_distance(frame, value, x, &gradient), f(x), 1e-6);  // values are rounded to float
    EXPECT_LT(norm(gradient - slope(x)), 1e-5);                          // ... and divided by a cell
    EXPECT_EQ(grid_distance(frame, value, x, nullptr), grid_distance(frame, value, x, &gradient));
  }
}

TEST(GridDistance, MeetsItsValuesAtTheGridPoints) {
  std::vector<float> const value = sampled(ball);
  for (int k : {0, 3, 6})
    for (int j : {0, 4, 7})
      for (int i : {0, 5, 8}) {
        Vec3 const x = frame.origin + Vec3{double(i), double(j), double(k)} * frame.cell;
        EXPECT_NEAR(grid_distance(frame, value, x, nullptr), value[(k * frame.ny + j) * frame.nx + i], 1e-7);
      }
}

// The gradient is that of the interpolant itself, not of the function it was sampled from.
TEST(GridDistance, GradientIsTheDerivativeInsideAndBeyondTheBox) {
  std::vector<float> const value = sampled(ball);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(-1.2, 1.2);
  double const h = 1e-7;
  int compared = 0, steep = 0;
  for (int i = 0; i < 400; ++i) {
    Vec3 const x{u(random), u(random), u(random)};
    Vec3 gradient, difference;
    grid_distance(frame, value, x, &gradient);
    for (int k = 0; k < 3; ++k) {
      Vec3 plus = x, minus = x;
      plus[k] += h, minus[k] -= h;
      difference[k] =
          (grid_distance(frame, value, plus, nullptr) - grid_distance(frame, value, minus, nullptr)) / (2 * h);
    }
    steep += norm(gradient) > 1.1;
    if (norm(gradient - difference) < 1e-6) ++compared;
  }
  EXPECT_GE(compared, 398);  // a difference may straddle a face of a cell, where the gradient jumps
  EXPECT_EQ(steep, 0);
}

TEST(GridDistance, GoesOnBeyondTheBoxWithoutAJump) {
  std::vector<float> const value = sampled(ball);
  Vec3 const high = far_corner();
  for (Vec3 inside : {Vec3{high.x, 0.1, 0.05}, Vec3{high.x, high.y, 0.1}, high, frame.origin}) {
    Vec3 out;
    for (int k = 0; k < 3; ++k) out[k] = inside[k] == high[k] ? 1 : (inside[k] == frame.origin[k] ? -1 : 0);
    double const at = grid_distance(frame, value, inside, nullptr);
    EXPECT_NEAR(grid_distance(frame, value, inside + out * 1e-9, nullptr), at, 1e-8);
    double const away = norm(out) * 0.3;
    EXPECT_NEAR(grid_distance(frame, value, inside + out * 0.3, nullptr), -std::sqrt(at * at + away * away), 1e-12);
  }
  // Never less than the depth of the solid below: -phi is a lower bound of the distance to the ball's grid image.
  EXPECT_LT(grid_distance(frame, value, {5, 5, 5}, nullptr), -7);
}

TEST(GridDistance, SmallestGridIsOneCell) {
  GridFrame const one{{0, 0, 0}, 2, 2, 2, 2};
  std::vector<float> const value{0, 1, 2, 3, 4, 5, 6, 7};
  EXPECT_DOUBLE_EQ(grid_distance(one, value, {1, 1, 1}, nullptr), 3.5);
  EXPECT_DOUBLE_EQ(grid_distance(one, value, {2, 2, 2}, nullptr), 7);
}

}  // namespace
}  // namespace scree

// impulse_error.cpp: see impulse_error.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/impulse_error.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace scree {

double force_exponent(ContactLaw law) {
  switch (law) {
    case ContactLaw::winkler:
      return 2;
    case ContactLaw::hertz:
      return 1.5;
    case ContactLaw::linear:
      return 1;
  }
  throw std::invalid_argument("this ContactLaw does not exist");
}

namespace {

// x'' = -x^n from x' = 1: deepest where x^(n+1) = (n+1)/2; exactly, it leaves with x' = -1.
double impulse_error_at(double n, double safety) {
  int constexpr phases = 32;
  double const deepest = std::pow(0.5 * (n + 1), 1 / (n + 1)), stiffness = n * std::pow(deepest, n - 1);
  double const dt = safety * 2 / std::sqrt(stiffness);
  auto const force = [&](double x) { return x > 0 ? -std::pow(x, n) : 0.0; };
  double largest = 0;
  for (int phase = 0; phase < phases; ++phase) {
    double x = -dt * phase / phases, v = 1, f = force(x);
    do {
      v += 0.5 * dt * f;
      x += dt * v;
      f = force(x);
      v += 0.5 * dt * f;
    } while (x > 0 || v > 0);
    largest = std::max(largest, 0.5 * std::abs(v + 1));
  }
  return largest;
}

}  // namespace

double impulse_error(ContactLaw law, double safety) {
  double largest = 0;  // at single steps the errors of both ends cancel: not to be relied on
  for (double part : {1.0, 0.9, 0.8, 0.7})
    largest = std::max(largest, impulse_error_at(force_exponent(law), part * safety));
  return largest;
}

}  // namespace scree

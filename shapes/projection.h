// projection.h: surface projection (SPF): the points of phi = 0 that belong to query points, many at once.
// Algorithms 1 and 2 of the reference paper (section 2.2), with safeguards so that warped phi converges too.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "shapes/phi_batch.h"

namespace scree {

enum class ProjectionMethod {
  gradient,  // Algorithm 1: descent along grad phi to a surface point close by; on a true distance the closest one
  ray        // Algorithm 2: along the ray from the origin through the query, by phi alone
};

enum class ProjectionOutcome : unsigned char {
  converged,
  no_direction,  // the gradient vanishes (Algorithm 1), or the query is the origin (Algorithm 2)
  stalled,       // no step along the gradient lowers |phi|: a local extremum
  no_surface,    // phi keeps its sign along the whole ray, from the origin to the ball
  iterations,    // the limit was reached
  not_finite     // the query or phi there
};
int constexpr projection_outcomes = 6;
char const* to_string(ProjectionOutcome outcome);

struct ProjectionOptions {
  ProjectionMethod method = ProjectionMethod::gradient;
  double tolerance = 1e-6;   // converged when |phi| is below [d]; float networks resolve about 3e-7
  int max_iterations = 60;   // evaluations of phi after the first
  double lambda = 1;         // first step of Algorithm 2 in units of phi; of Algorithm 1 in units of phi / |grad phi|
  double radius = INFINITY;  // phi is never asked outside this ball: queries beyond start on it, steps end on it [d]
};

// One entry a query, in its order. A point that failed keeps the best position that was found; always finite, except
// for queries that were not.
struct Projection {
  std::vector<Vec3> position;   // [d]
  std::vector<double> phi;      // left at position [d]; NaN: never evaluated
  std::vector<int> iterations;  // evaluations of phi after the first
  std::vector<ProjectionOutcome> outcome;

  bool converged(int i) const { return outcome[i] == ProjectionOutcome::converged; }
};

// Algorithm 1: p <- p - a phi g / |g|^2, with phi of either sign; the share a starts at lambda, is halved while |phi|
// does not fall enough (Armijo) and doubled back after a step that does.
// Algorithm 2: s <- s + lambda phi (phi > 0 inside, hence the sign) with s = |p|. lambda follows the slope between the
// last two points and doubles where |phi| grows (a grazing ray); once the crossing is bracketed, a step that leaves the
// bracket or fails to halve it in three rounds is replaced by a bisection. Of several crossings one is found.
// A point's result depends neither on the other points nor on threads. Throws std::invalid_argument for bad options.
Projection project(PhiBatch const& phi, Span<const Vec3> query, ProjectionOptions const& options = {});

struct ProjectionSummary {
  int points = 0;
  double mean_iterations = 0;                    // of all points
  int max_iterations = 0;                        // of all points
  double worst_phi = 0;                          // largest |phi| left where it converged [d]
  std::array<int, projection_outcomes> count{};  // by outcome

  int failures() const { return points - count[0]; }
};
ProjectionSummary summary(Projection const& projection);

// "1000 points, 3.2 iterations (at most 7), all converged" or "... 2 failed: 1 no direction, 1 no surface".
std::string to_string(ProjectionSummary const& summary);

}  // namespace scree

// projection.cpp: see projection.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/projection.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

namespace scree {
namespace {

double constexpr least_slope = 1e-6;  // of |grad phi|, which is about 1: below, its direction is rounding noise
double constexpr least_share = 1e-6;  // of a gradient step; halved 20 times without gain, none will come
double constexpr armijo = 1e-4;       // share of the predicted decrease that a step must keep
int constexpr patience = 3;           // rounds in which a bracket must halve
double constexpr lambda_reach = 64;   // lambda stays within this factor of its first value

// Where phi may be asked: inside the ball.
Vec3 into_ball(Vec3 x, double radius) {
  double const length = norm(x);
  return length > radius ? x * (radius / length) : x;
}

// What a method keeps of a point between evaluations of phi.
struct GradientWalk {
  Vec3 gradient;     // at the accepted position
  double share = 1;  // of the full step
};

struct RayWalk {
  Vec3 direction;
  double lambda = 1;
  double s = 0;                      // |position| of the trial
  double low = -1, high = -1;        // phi > 0 at low, <= 0 at high; -1: not known
  double last_s = -1, last_phi = 0;  // the point before; -1: none
  double width = INFINITY;           // of the bracket when it last halved
  int rounds = 0;                    // since then
};

// The evaluation loop both share: `active` points have a trial position whose phi is wanted.
class Walkers {
 public:
  Walkers(PhiBatch const& phi, Span<const Vec3> query, ProjectionOptions const& options)
      : phi_(phi), options_(options) {
    int const n = query.size();
    result_.position.assign(query.begin(), query.end());
    result_.phi.assign(n, NAN);
    result_.iterations.assign(n, 0);
    result_.outcome.assign(n, ProjectionOutcome::iterations);
    for (int i = 0; i < n; ++i) {
      if (!is_finite(query[i])) {
        result_.outcome[i] = ProjectionOutcome::not_finite;
        continue;
      }
      result_.position[i] = into_ball(query[i], options.radius);
      active_.push_back(i);
    }
  }

  Projection run() {
    if (options_.method == ProjectionMethod::gradient)
      descend();
    else
      follow_rays();
    return std::move(result_);
  }

 private:
  void descend();
  void follow_rays();
  bool advance(RayWalk& ray, double phi) const;

  // phi (and gradient) at `trial` of every active point, in their order.
  void evaluate(bool gradient) {
    value_.resize(active_.size());
    gradient_.resize(gradient ? active_.size() : 0);
    if (!active_.empty()) phi_(trial_, value_, gradient_);
  }

  // True when the point is done, for better or worse.
  bool finished(int i, double phi, Vec3 at) {
    if (!std::isfinite(phi)) return end(i, ProjectionOutcome::not_finite);
    if (std::abs(phi) < options_.tolerance) {
      keep(i, phi, at);
      return end(i, ProjectionOutcome::converged);
    }
    return false;
  }
  void keep(int i, double phi, Vec3 at) { result_.phi[i] = phi, result_.position[i] = at; }
  bool end(int i, ProjectionOutcome outcome) {
    result_.outcome[i] = outcome;
    return true;
  }

  PhiBatch const& phi_;
  ProjectionOptions const& options_;
  Projection result_;
  std::vector<int> active_;     // points not finished
  std::vector<Vec3> trial_;     // of active points
  std::vector<double> value_;   // phi there
  std::vector<Vec3> gradient_;  // there
};

void Walkers::descend() {
  std::vector<GradientWalk> walk(result_.position.size());
  trial_.clear();
  for (int i : active_) trial_.push_back(result_.position[i]);
  for (int round = 0;; ++round) {
    evaluate(true);
    std::vector<int> left;
    std::vector<Vec3> next;
    for (std::size_t k = 0; k < active_.size(); ++k) {
      int const i = active_[k];
      GradientWalk& w = walk[i];
      result_.iterations[i] = round;
      if (finished(i, value_[k], trial_[k])) continue;
      bool const first = round == 0;
      double const before = std::abs(result_.phi[i]), now = std::abs(value_[k]);
      if (first || now <= (1 - armijo * w.share) * before) {
        keep(i, value_[k], trial_[k]);
        w.gradient = gradient_[k];
        w.share = first ? options_.lambda : std::min(2 * w.share, options_.lambda);
      } else if ((w.share /= 2) < least_share) {
        end(i, ProjectionOutcome::stalled);
        continue;
      }
      double const slope2 = norm2(w.gradient);
      if (!(slope2 > least_slope * least_slope)) {
        end(i, ProjectionOutcome::no_direction);
        continue;
      }
      if (round == options_.max_iterations) continue;  // its outcome says so already
      left.push_back(i);
      Vec3 const step = w.gradient * (w.share * result_.phi[i] / slope2);
      next.push_back(into_ball(result_.position[i] - step, options_.radius));
    }
    if (left.empty()) return;
    active_ = std::move(left);
    trial_ = std::move(next);
  }
}

// The next place on the ray, given phi at ray.s; false: there is no crossing to look for.
bool Walkers::advance(RayWalk& ray, double phi) const {
  (phi > 0 ? ray.low : ray.high) = ray.s;
  double const end = options_.radius;
  if ((phi > 0 && ray.s >= end) || (phi <= 0 && ray.s <= 0)) return false;

  if (ray.last_s >= 0 && ray.last_phi != phi) {
    double const measured = -(ray.s - ray.last_s) / (phi - ray.last_phi), first = options_.lambda;
    // Going away from zero: the ray grazes the surface, and what follows is far in units of phi.
    ray.lambda = measured > 0 ? std::clamp(measured, first / lambda_reach, first * lambda_reach)
                              : std::min(2 * ray.lambda, first * lambda_reach);
  }
  double next = std::clamp(ray.s + ray.lambda * phi, 0.0, end);
  if (ray.low >= 0 && ray.high >= 0) {
    double const width = std::abs(ray.high - ray.low);
    if (width <= ray.width / 2) ray.width = width, ray.rounds = 0;
    bool const slow = ++ray.rounds > patience;
    double const least = std::min(ray.low, ray.high), most = std::max(ray.low, ray.high);
    if (slow || !(next > least && next < most)) next = (least + most) / 2;
  }
  ray.last_s = ray.s, ray.last_phi = phi;
  ray.s = next;
  return true;
}

void Walkers::follow_rays() {
  std::vector<RayWalk> walk(result_.position.size());
  std::vector<int> with_direction;
  trial_.clear();
  for (int i : active_) {
    double const length = norm(result_.position[i]);
    if (!(length > 1e-12)) {
      end(i, ProjectionOutcome::no_direction);
      continue;
    }
    walk[i].direction = result_.position[i] / length;
    walk[i].s = length;
    walk[i].lambda = options_.lambda;
    with_direction.push_back(i);
    trial_.push_back(result_.position[i]);
  }
  active_ = std::move(with_direction);
  for (int round = 0;; ++round) {
    evaluate(false);
    std::vector<int> left;
    std::vector<Vec3> next;
    for (std::size_t k = 0; k < active_.size(); ++k) {
      int const i = active_[k];
      result_.iterations[i] = round;
      if (finished(i, value_[k], trial_[k])) continue;
      if (round == 0 || std::abs(value_[k]) < std::abs(result_.phi[i])) keep(i, value_[k], trial_[k]);
      if (!advance(walk[i], value_[k])) {
        end(i, ProjectionOutcome::no_surface);
        continue;
      }
      if (round == options_.max_iterations) continue;
      left.push_back(i);
      next.push_back(walk[i].direction * walk[i].s);
    }
    if (left.empty()) return;
    active_ = std::move(left);
    trial_ = std::move(next);
  }
}

void check(ProjectionOptions const& o) {
  if (!(o.tolerance > 0)) throw std::invalid_argument("project: tolerance must be positive");
  if (o.max_iterations < 0) throw std::invalid_argument("project: max_iterations must not be negative");
  if (!(o.lambda > 0 && o.lambda <= 2)) throw std::invalid_argument("project: lambda must be in (0, 2]");
  if (!(o.radius > 0)) throw std::invalid_argument("project: radius must be positive");
}

}  // namespace

char const* to_string(ProjectionOutcome outcome) {
  switch (outcome) {
    case ProjectionOutcome::converged:
      return "converged";
    case ProjectionOutcome::no_direction:
      return "no direction";
    case ProjectionOutcome::stalled:
      return "stalled";
    case ProjectionOutcome::no_surface:
      return "no surface";
    case ProjectionOutcome::iterations:
      return "too many iterations";
    case ProjectionOutcome::not_finite:
      return "not finite";
  }
  throw std::invalid_argument("unknown projection outcome");
}

Projection project(PhiBatch const& phi, Span<const Vec3> query, ProjectionOptions const& options) {
  check(options);
  return Walkers(phi, query, options).run();
}

ProjectionSummary summary(Projection const& projection) {
  ProjectionSummary s;
  s.points = static_cast<int>(projection.position.size());
  double sum = 0;
  for (int i = 0; i < s.points; ++i) {
    ++s.count[static_cast<int>(projection.outcome[i])];
    sum += projection.iterations[i];
    s.max_iterations = std::max(s.max_iterations, projection.iterations[i]);
    if (projection.converged(i)) s.worst_phi = std::max(s.worst_phi, std::abs(projection.phi[i]));
  }
  s.mean_iterations = s.points > 0 ? sum / s.points : 0;
  return s;
}

std::string to_string(ProjectionSummary const& s) {
  char text[96];
  std::snprintf(text, sizeof(text), "%d points, %.1f iterations (at most %d), ", s.points, s.mean_iterations,
                s.max_iterations);
  if (s.failures() == 0) return std::string(text) + "all converged";
  std::string out = text + std::to_string(s.failures()) + " failed:";
  for (int k = 1; k < projection_outcomes; ++k)
    if (s.count[k] > 0)
      out += (out.back() == ':' ? " " : ", ") + std::to_string(s.count[k]) + " " +
             to_string(static_cast<ProjectionOutcome>(k));
  return out;
}

}  // namespace scree

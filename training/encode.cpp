// encode.cpp: see encode.h.
// SPDX-License-Identifier: Apache-2.0
#include "training/encode.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "shapes/latent.h"
#include "training/net_derivatives.h"

namespace scree {
namespace {

double constexpr kink = 1e-3;  // w of the residual's measure [d]
int constexpr block = 256;     // points at a time: activations of a layer stay in cache
int constexpr pose_size = 7;   // turn, shift and logarithm of the size
int constexpr trial_steps = 12;

// What is sought: x_net = query(x), phi = phi_net(x_net, code) / scale.
struct Fit {
  Eigen::VectorXd code;
  QueryTransform query;
};

Fit moved(Fit const& fit, Eigen::VectorXd const& step) {
  Eigen::Index const n = fit.code.size();
  Fit out = fit;
  out.code += step.head(n);
  out.query.rotation =
      to_matrix(normalized(quat_from_rotation_vector({step(n), step(n + 1), step(n + 2)}))) * fit.query.rotation;
  out.query.shift += Vec3{step(n + 3), step(n + 4), step(n + 5)};
  out.query.scale *= std::exp(step(n + 6));
  return out;
}

// Sums over samples for one Gauss-Newton step.
struct Normal {
  Eigen::MatrixXd a;
  Eigen::VectorXd g;
  double cost = 0;   // sum of sqrt(r^2 + w^2) - w
  double error = 0;  // sum of |r|

  void add(Normal const& other) {
    a += other.a;
    g += other.g;
    cost += other.cost;
    error += other.error;
  }
};

class Residuals {
 public:
  Residuals(NetDerivatives const& net, Samples const& samples, int count, int threads)
      : net_(net), samples_(samples), count_(count), threads_(threads) {}

  // Means over the first `count` samples; blocks are added in their order, so that threads change no bit.
  Normal at(Fit const& fit, bool derivatives) const {
    int const blocks = (count_ + block - 1) / block;
    std::vector<Normal> part(blocks);
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads_)
    for (int b = 0; b < blocks; ++b) part[b] = sum(fit, b * block, std::min(count_, (b + 1) * block), derivatives);
    for (int b = 1; b < blocks; ++b) part[0].add(part[b]);
    Normal& all = part[0];
    all.a /= count_, all.g /= count_, all.cost /= count_, all.error /= count_;
    return all;
  }

 private:
  Normal sum(Fit const& fit, int begin, int end, bool derivatives) const {
    int const n = end - begin, codes = net_.code_size(), size = codes + pose_size;
    double const scale = fit.query.scale;
    Eigen::MatrixXd point(3, n);
    for (int i = 0; i < n; ++i) {
      Vec3 const x = fit.query(samples_.point[begin + i]);
      point.col(i) << x.x, x.y, x.z;
    }
    NetDerivatives::Output out;
    net_.evaluate(point, fit.code, out);
    Normal normal{Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
    Eigen::MatrixXd jacobian(size, n);
    Eigen::VectorXd weight(n), residual(n);
    for (int i = 0; i < n; ++i) {
      double const phi = out.phi(i) / scale, r = phi - samples_.phi[begin + i], length = std::hypot(r, kink);
      normal.cost += length - kink;
      normal.error += std::abs(r);
      if (!derivatives) continue;
      residual(i) = r, weight(i) = 1 / length;
      Eigen::Vector3d const slope = out.by_point.col(i) / scale;
      Eigen::Vector3d const arm =
          point.col(i) - Eigen::Vector3d(fit.query.shift.x, fit.query.shift.y, fit.query.shift.z);
      jacobian.col(i) << out.by_code.col(i) / scale, arm.cross(slope), slope, arm.dot(slope) - phi;
    }
    if (!derivatives) return normal;
    Eigen::MatrixXd const weighted = jacobian * weight.asDiagonal();
    normal.a = weighted * jacobian.transpose();
    normal.g = weighted * residual;
    return normal;
  }

  NetDerivatives const& net_;
  Samples const& samples_;
  int count_, threads_;
};

// Marquardt (1963): damping by the diagonal, less after a step that helped, more after one that did not.
double descend(Residuals const& residuals, Fit& fit, int iterations) {
  double constexpr least_gain = 1e-5;  // relative, of an iteration worth another one
  double damping = 1e-2;
  Normal here = residuals.at(fit, true);
  for (int k = 0; k < iterations; ++k) {
    Eigen::MatrixXd damped = here.a;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-12 * here.a.diagonal().maxCoeff();  // a network may ignore a number
    Fit const next = moved(fit, -damped.ldlt().solve(here.g));
    double const cost = residuals.at(next, false).cost;
    if (!(cost < here.cost)) {
      damping *= 8;
      if (damping > 1e8) break;
      continue;
    }
    bool const enough = here.cost - cost < least_gain * here.cost;
    fit = next;
    if (enough) break;
    damping = std::max(damping / 4, 1e-9);
    here = residuals.at(fit, true);
  }
  return residuals.at(fit, false).cost;
}

int network_of(Library const& library) {
  int net = -1;
  for (Shape const& s : library.shape) {
    if (!s.is_net() || s.code.empty()) continue;
    if (net >= 0 && s.net != net)
      throw std::invalid_argument("the codes belong to several networks; encode takes a model file with one decoder");
    net = s.net;
  }
  if (net < 0) throw std::invalid_argument("no shape has a latent code; encode takes the file of a coded training");
  return net;
}

Mat3 half_turn(int axis) {
  Mat3 turn;
  for (int k = 0; k < 3; ++k) turn.row[k][k] = axis == 0 || axis == k + 1 ? 1 : -1;
  return turn;
}

struct Run {
  EncodeStart start;
  Fit fit;
  double cost = 0;
};

Fit fit_of(Shape const& s) {
  Fit fit;
  fit.code = Eigen::Map<Eigen::VectorXf const>(s.code.data(), static_cast<Eigen::Index>(s.code.size())).cast<double>();
  fit.query = s.query;
  return fit;
}

// Codes of `category` (all where it is empty) at their mean, in the frame of the network at their mean size.
Fit mean_fit(std::vector<Shape const*> const& known, std::string const* category) {
  Fit mean;
  mean.code = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(known[0]->code.size()));
  mean.query.rotation = half_turn(0);
  mean.query.scale = 0;
  double n = 0;
  for (Shape const* s : known) {
    if (category && category_of(s->name) != *category) continue;
    Fit const one = fit_of(*s);
    mean.code += one.code;
    mean.query.scale += one.query.scale;
    ++n;
  }
  mean.code /= n;
  mean.query.scale /= n;
  return mean;
}

std::vector<Run> starts(Library const& library, int net, Residuals const& residuals, int nearest) {
  std::vector<Shape const*> known;
  for (Shape const& s : library.shape)
    if (s.is_net() && s.net == net && !s.code.empty()) known.push_back(&s);
  std::vector<std::pair<std::string, Fit>> means{{"mean", mean_fit(known, nullptr)}};
  for (std::string const& category : coded_categories(library))
    means.emplace_back("mean of " + category, mean_fit(known, &category));
  std::vector<Run> out;
  for (int turn = 0; turn < 4; ++turn) {
    auto const run = [&](std::string const& name, Fit fit) {
      fit.query.rotation = fit.query.rotation * half_turn(turn);
      return Run{{name, turn}, fit, residuals.at(fit, false).cost};
    };
    for (auto const& [name, fit] : means) out.push_back(run(name, fit));
    std::vector<Run> stored;
    for (Shape const* s : known) stored.push_back(run(s->name, fit_of(*s)));
    std::stable_sort(stored.begin(), stored.end(), [](Run const& a, Run const& b) { return a.cost < b.cost; });
    stored.resize(std::min(stored.size(), static_cast<std::size_t>(nearest)));
    out.insert(out.end(), stored.begin(), stored.end());
  }
  return out;
}

}  // namespace

Encoding encode(Library const& library, Body const& body, EncodeOptions const& options) {
  int const net = network_of(library);
  NetDerivatives const derivatives(library.net[net]);
  SamplingOptions sampling;
  sampling.count = options.samples;
  Samples const samples = training_samples(body, sampling, options.seed, options.threads);
  Samples const shell = shell_samples(body, options.test, options.seed + 1, options.threads);
  Residuals const few(derivatives, samples, std::min(options.trial, options.samples), options.threads);
  Residuals const all(derivatives, samples, options.samples, options.threads);
  Residuals const test(derivatives, shell, options.test, options.threads);

  std::vector<Run> run = starts(library, net, few, options.nearest);
  for (Run& r : run) {
    r.start.before = test.at(r.fit, false).error;
    r.cost = descend(few, r.fit, trial_steps);
  }
  auto const by_cost = [](Run const& a, Run const& b) { return a.cost < b.cost; };
  std::stable_sort(run.begin(), run.end(), by_cost);
  auto const last = run.begin() + std::min<std::ptrdiff_t>(options.finalists, std::ssize(run));
  for (auto r = run.begin(); r != last; ++r) {
    r->start.finalist = true;
    r->cost = descend(all, r->fit, options.iterations);
  }
  std::stable_sort(run.begin(), last, by_cost);

  Encoding out;
  for (Run& r : run) {
    r.start.after = test.at(r.fit, false).error;
    out.start.push_back(r.start);
  }
  Fit const& best = run[0].fit;
  out.shape.name = body.name;
  out.shape.kind = ShapeKind::net;
  out.shape.net = net;
  out.shape.query = best.query;
  Eigen::VectorXf const code = best.code.cast<float>();
  out.shape.code.assign(code.begin(), code.end());
  out.shape.certificate.source = body.source;
  out.shape.certificate.source_hash = body.source_hash;
  return out;
}

}  // namespace scree

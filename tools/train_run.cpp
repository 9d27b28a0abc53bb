// train_run.cpp: what every training command does: read the mesh, train with progress, certify, write.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <system_error>

#include "shapes/mesh/mesh_check.h"
#include "shapes/mesh_files.h"
#include "shapes/mesh_normalise.h"
#include "shapes/model_file.h"
#include "tools/certificate_table.h"
#include "tools/guarded.h"
#include "tools/train_commands.h"
#include "training/publish.h"

namespace scree {

TriangleMesh read_closed_mesh(std::filesystem::path const& file, bool repair) {
  TriangleMesh mesh;
  try {
    mesh = read_mesh(file);
  } catch (std::runtime_error const& error) {
    throw std::invalid_argument(error.what());
  }
  MeshReport const report = check_mesh(mesh, false);
  if (report.defects.empty()) return normalised(mesh);
  std::string found;
  for (std::string const& defect : report.defects) found += "\n  " + defect;
  if (!repair)
    throw std::invalid_argument(file.string() + ": the mesh bounds no solid:" + found +
                                "\nRepair it with `scree-shape import`, or add --repair to do both at once");
  fmt::print("{}: found:{}\n", file.string(), found);
  std::vector<std::string> actions;
  try {
    mesh = repair_mesh(mesh, &actions);
  } catch (std::runtime_error const& error) {
    throw std::invalid_argument(file.string() + ": " + error.what());
  }
  for (std::string const& action : actions) fmt::print("  {}\n", action);
  return normalised(mesh);
}

namespace {

// Prints an epoch line every few seconds (each one when `every` is 0) and the CSV log.
class Reporter {
 public:
  Reporter(TrainArguments const& a) : quiet_(a.quiet) {
    if (a.log.empty()) return;
    log_.open(a.log);
    if (!log_) throw std::system_error(errno, std::generic_category(), a.log.string());
    log_ << "epoch,step,loss,train_mae,mean_mae,worst_mae,best,seconds\n";
  }
  void operator()(EpochRecord const& r) {
    if (log_.is_open())
      log_ << fmt::format("{},{},{:.6e},{:.6e},{:.6e},{:.6e},{},{:.2f}\n", r.epoch, r.step, r.loss, r.train_mae,
                          r.mean_mae, r.worst_mae, r.best ? 1 : 0, r.seconds)
           << std::flush;
    best_ = std::min(best_, r.mean_mae);
    if (quiet_ || (r.step < r.steps && r.seconds - printed_ < 5)) return;
    printed_ = r.seconds;
    double const left = r.seconds / r.step * (r.steps - r.step);
    fmt::print(
        "epoch {:4d}  step {:6d}/{}  loss {:.3e}  test MAE {:.3e} (worst {:.3e}, best {:.3e})  {:.0f} s, {:.0f} s "
        "left\n",
        r.epoch, r.step, r.steps, r.loss, r.mean_mae, r.worst_mae, best_, r.seconds, left);
    std::fflush(stdout);
  }

 private:
  bool quiet_;
  std::ofstream log_;
  double best_ = INFINITY;
  double printed_ = -1e9;
};

}  // namespace

int train_and_write(TrainArguments const& a, std::vector<Body> const& bodies) {
  TrainOptions options = a.train;
  if (a.seconds > 0) {
    double constexpr share_of_steps = 0.93;  // the rest goes to the tests after each epoch
    options.steps = std::max(1, static_cast<int>(share_of_steps * a.seconds / seconds_per_step(bodies, options)));
    if (!a.quiet)
      fmt::print("{:.0f} s are {} steps here; --steps {} repeats the result\n", a.seconds, options.steps,
                 options.steps);
  }
  Reporter reporter(a);
  auto const start = std::chrono::steady_clock::now();
  TrainedNet const trained = train(bodies, options, std::ref(reporter), a.checkpointing);
  PublishOptions publish_options;
  publish_options.seed = options.seed;
  publish_options.threads = options.threads;
  Library const library = publish(trained, bodies, publish_options);
  write_model(a.output, library, a.force);
  double mean = 0, worst = 0;
  for (Shape const& shape : library.shape) {
    mean += shape.certificate.mae / static_cast<double>(library.shape.size());
    worst = std::max(worst, shape.certificate.mae);
  }
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!a.quiet) fmt::print("{}\n{}", error_table(library.shape), phi_table(library.shape));
  fmt::print(
      "{}: {} shapes, mean MAE {:.2e} d, worst {:.2e} d; trained in {:.0f} s, {:.0f} s with sampling and certificates "
      "(best epoch {})\n",
      a.output.string(), library.shape.size(), mean, worst, trained.seconds, seconds, trained.best_epoch);
  return exit_ok;
}

}  // namespace scree

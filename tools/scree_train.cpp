// scree_train.cpp: the training program: fit one network to a mesh, or one decoder to the procedural grains.
// Links LibTorch and CGAL; distributed binaries are under GPL-3 because of CGAL.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <system_error>

#include "shapes/mesh/mesh_check.h"
#include "shapes/mesh/mesh_normalise.h"
#include "shapes/mesh/procedural_grains.h"
#include "shapes/mesh_files.h"
#include "shapes/model_file.h"
#include "tools/guarded.h"
#include "training/publish.h"
#include "training/train.h"

namespace {

using namespace scree;
namespace fs = std::filesystem;

struct Arguments {
  fs::path mesh, output, log;  // log: a CSV line an epoch; empty: none
  std::string name;            // of the shape; empty: the mesh file's stem
  std::string set = "grains20";
  std::uint64_t set_seed = 1;  // of the procedural grains
  std::string activation = "sine";
  double parameter = 0;  // 0: the activation's default
  double seconds = 0;    // 0: `steps` decides
  bool force = false, quiet = false;
  TrainOptions train;
};

double parameter_of(Arguments const& a) {
  if (a.parameter > 0) return a.parameter;
  return a.activation == "sine" ? 8 : 0.01;
}

// Everything that can go wrong with the output is said before minutes are spent on it.
void check_output(fs::path const& file, bool force) {
  if (fs::is_directory(file)) throw std::invalid_argument(file.string() + " is a folder; name a file");
  if (fs::exists(file) && !force)
    throw std::invalid_argument(file.string() + " exists; choose another name or add --force");
  fs::path const folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (!fs::is_directory(folder))
    throw std::system_error(std::make_error_code(std::errc::no_such_file_or_directory), folder.string());
  if (::access(folder.c_str(), W_OK) != 0)
    throw std::system_error(errno, std::generic_category(), folder.string() + " cannot be written");
}

TriangleMesh read_closed_mesh(fs::path const& file) {
  TriangleMesh mesh;
  try {
    mesh = read_mesh(file);
  } catch (std::runtime_error const& error) {
    throw std::invalid_argument(error.what());
  }
  MeshReport const report = check_mesh(mesh, false);
  if (!report.defects.empty()) throw std::invalid_argument(file.string() + ": " + report.defects.front());
  return normalised(mesh);
}

// FNV-1a of the file's bytes: tells source meshes apart, protects against nothing.
std::string file_hash(fs::path const& file) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  std::ifstream in(file, std::ios::binary);
  for (char c; in.get(c);) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return fmt::format("fnv1a:{:016x}", hash);
}

// Prints an epoch line every few seconds (each one when `every` is 0) and the CSV log.
class Reporter {
 public:
  Reporter(Arguments const& a) : quiet_(a.quiet) {
    if (a.log.empty()) return;
    log_.open(a.log);
    if (!log_) throw std::system_error(errno, std::generic_category(), a.log.string());
    log_ << "epoch,step,loss,mean_mae,worst_mae,best,seconds\n";
  }
  void operator()(EpochRecord const& r) {
    if (log_.is_open())
      log_ << fmt::format("{},{},{:.6e},{:.6e},{:.6e},{},{:.2f}\n", r.epoch, r.step, r.loss, r.mean_mae, r.worst_mae,
                          r.best ? 1 : 0, r.seconds)
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

void print_certificates(Library const& library, std::vector<PublishReport> const& reports) {
  fmt::print("{:<14}{:>9}{:>9}{:>9}{:>9}{:>7}{:>7}{:>7}{:>7}{:>9}{:>9}{:>5}{:>9}\n", "shape", "MAE", "p99", "max",
             "band", "n50", "n95", "g1", "g99", "volume", "hausd.", "comp", "falling");
  for (std::size_t i = 0; i < library.shape.size(); ++i) {
    Certificate const& c = library.shape[i].certificate;
    fmt::print("{:<14}{:9.2e}{:9.2e}{:9.2e}{:9.2e}{:7.2f}{:7.2f}{:7.3f}{:7.3f}{:9.1e}{:9.1e}{:5d}{:9.1e}\n",
               library.shape[i].name, c.mae, c.p99, c.max, c.band_mae, c.normal_p50, c.normal_p95, c.gradient_p1,
               c.gradient_p99, c.volume_error, c.hausdorff, c.components, reports[i].interior.share_falling);
  }
}

int finish(Arguments const& a, std::vector<Body> const& bodies, TrainOptions options) {
  if (a.seconds > 0) {
    double constexpr share_of_steps = 0.93;  // the rest goes to the tests after each epoch
    options.steps = std::max(1, static_cast<int>(share_of_steps * a.seconds / seconds_per_step(bodies, options)));
    if (!a.quiet)
      fmt::print("{:.0f} s are {} steps here; --steps {} repeats the result\n", a.seconds, options.steps,
                 options.steps);
  }
  Reporter reporter(a);
  auto const start = std::chrono::steady_clock::now();
  TrainedNet const trained = train(bodies, options, std::ref(reporter));
  PublishOptions publish_options;
  publish_options.seed = options.seed;
  publish_options.threads = options.threads;
  std::vector<PublishReport> reports;
  Library const library = publish(trained, bodies, publish_options, &reports);
  write_model(a.output, library, a.force);
  double mean = 0, worst = 0;
  for (Shape const& shape : library.shape) {
    mean += shape.certificate.mae / static_cast<double>(library.shape.size());
    worst = std::max(worst, shape.certificate.mae);
  }
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!a.quiet) print_certificates(library, reports);
  fmt::print(
      "{}: {} shapes, mean MAE {:.2e} d, worst {:.2e} d; trained in {:.0f} s, {:.0f} s with sampling and certificates "
      "(best epoch {})\n",
      a.output.string(), library.shape.size(), mean, worst, trained.seconds, seconds, trained.best_epoch);
  return exit_ok;
}

int fit(Arguments const& a) {
  TrainOptions options = a.train;
  options.activation = activation_from_string(a.activation);
  options.parameter = parameter_of(a);
  check_output(a.output, a.force);
  std::string const name = a.name.empty() ? a.mesh.stem().string() : a.name;
  TriangleMesh mesh = read_closed_mesh(a.mesh);
  std::string const source = "mesh " + a.mesh.filename().string();
  return finish(a, {make_body(name, std::move(mesh), source, file_hash(a.mesh))}, options);
}

int coded(Arguments const& a) {
  TrainOptions options = a.train;
  options.activation = activation_from_string(a.activation);
  options.parameter = parameter_of(a);
  check_output(a.output, a.force);
  std::vector<Body> bodies;
  for (ProceduralGrain& grain : procedural_grains(a.set_seed))
    bodies.push_back(make_body(grain.name, std::move(grain.mesh), grain.formula));
  return finish(a, bodies, options);
}

void add_training_options(CLI::App& c, Arguments& a) {
  TrainOptions& t = a.train;
  c.add_option("-o,--output", a.output, "Model file to write (.h5)")->required();
  c.add_flag("--force", a.force, "Replace an existing output file");
  c.add_option("--layers", t.layers, "Hidden layers")->check(CLI::Range(1, 16))->capture_default_str();
  c.add_option("--width", t.width, "Neurons a hidden layer")->check(CLI::Range(8, 64))->capture_default_str();
  c.add_option("--activation", a.activation, "sine or leaky_relu")
      ->check(CLI::IsMember({"sine", "leaky_relu"}))
      ->capture_default_str();
  c.add_option("--parameter", a.parameter, "omega of sine (default 8), slope of leaky_relu (default 0.01)");
  CLI::Option* const steps = c.add_option("--steps", t.steps, "Optimiser steps")->capture_default_str();
  c.add_option("--seconds", a.seconds, "Choose the steps so that training takes about this long [s]")->excludes(steps);
  c.add_option("--rows", t.rows, "Samples of a work unit")->capture_default_str();
  c.add_option("--units", t.units, "Work units a step; changes the result, --threads does not")->capture_default_str();
  c.add_option("--samples", t.samples.count, "Training samples a shape")->capture_default_str();
  c.add_option("--rate", t.rate, "First learning rate")->capture_default_str();
  c.add_option("--slope-weight", t.slope_weight, "Weight of the directional derivative in the loss")
      ->capture_default_str();
  c.add_option("--seed", t.seed, "Seed of weights, samples and batches")->capture_default_str();
  c.add_option("--threads", t.threads, "CPU threads")->check(CLI::Range(1, 256))->capture_default_str();
  c.add_option("--log", a.log, "Write test errors of every epoch to this CSV file");
  c.add_flag("-q,--quiet", a.quiet, "Only the last line");
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Train signed distance networks of grains"};
  app.set_version_flag("--version",
                       "scree-train " SCREE_VERSION
                       "\nScree is Apache-2.0; this program contains CGAL and is distributed under GPL-3.");
  app.require_subcommand(1);
  std::function<int()> chosen;
  Arguments single, many;
  many.train.code_size = 10;
  many.train.width = 64;
  many.train.layers = 6;
  many.train.steps = 24000;
  many.train.rows = 1000;  // 50 a shape
  many.train.rate = 1.2e-2;

  CLI::App* const f = app.add_subcommand("fit", "One network for one closed mesh (SingleNetSDF)");
  f->add_option("mesh", single.mesh, "Closed mesh (.stl, .obj), any unit; scree-shape import repairs simple defects")
      ->required();
  f->add_option("--name", single.name, "Name of the shape (default: the file's)");
  add_training_options(*f, single);
  f->callback([&] { chosen = [&] { return fit(single); }; });

  CLI::App* const c = app.add_subcommand("coded", "One decoder and a latent code a shape (CodedNetSDF)");
  c->add_option("--set", many.set, "grains20: five each of ballast, cobble, ellipsoid, sand")
      ->check(CLI::IsMember({"grains20"}))
      ->capture_default_str();
  c->add_option("--set-seed", many.set_seed, "Seed of the procedural grains")->capture_default_str();
  c->add_option("--code-size", many.train.code_size, "Latent numbers a shape")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  c->add_option("--code-rate", many.train.code_rate, "First learning rate of the codes")->capture_default_str();
  add_training_options(*c, many);
  c->callback([&] { chosen = [&] { return coded(many); }; });

  try {
    app.parse(argc, argv);
  } catch (CLI::ParseError const& error) {
    return app.exit(error) == 0 ? exit_ok : exit_bad_input;
  }
  return guarded("scree-train", chosen);
}

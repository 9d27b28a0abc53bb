// train_encode.cpp: scree-train encode: the latent code of a mesh under a decoder that stays as it is.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "shapes/analytic_shapes.h"
#include "shapes/file_hash.h"
#include "shapes/model_file.h"
#include "tools/certificate_table.h"
#include "tools/guarded.h"
#include "tools/shape_input.h"
#include "tools/train_commands.h"
#include "training/encode.h"
#include "training/publish.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct EncodeArguments {
  fs::path model, mesh, output;
  std::string name;
  EncodeOptions options;
  bool keep = false, repair = false, force = false, quiet = false;
};

Body body_of(EncodeArguments const& a) {
  if (is_builtin_shape(a.mesh.string())) {
    std::string const formula = a.mesh.string();
    return make_body(a.name.empty() ? formula : a.name, builtin_shape(formula));
  }
  return make_body(a.name.empty() ? a.mesh.stem().string() : a.name, read_closed_mesh(a.mesh, a.repair),
                   "mesh " + a.mesh.filename().string(), file_hash(a.mesh));
}

std::string description(EncodeStart const& s) {
  char const* const turn[] = {"", ", turned about x", ", turned about y", ", turned about z"};
  return s.name + turn[s.turn];
}

int run_encode(EncodeArguments const& a) {
  check_output(a.output, a.force);
  Library library = read_input([&] { return read_model(a.model); });
  Body const body = body_of(a);
  auto const same = [&](Shape const& s) { return s.name == body.name; };
  if (a.keep && std::any_of(library.shape.begin(), library.shape.end(), same))
    throw std::invalid_argument(a.model.string() + " has a shape '" + body.name + "' already; choose another --name");
  auto const begin = std::chrono::steady_clock::now();
  Encoding made = encode(library, body, a.options);
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!a.quiet) {
    fmt::print("{} starts, mean error on the paper's shell [d]; * went on with all samples\n", made.start.size());
    for (EncodeStart const& s : made.start)
      fmt::print("  {:.2e} -> {:.2e} {} {}\n", s.before, s.after, s.finalist ? '*' : ' ', description(s));
  }
  EncodeStart const& best = made.start.front();
  Shape& shape = made.shape;
  shape.certificate.source += ", encoded by " + a.model.filename().string();
  shape.certificate.seed = static_cast<std::int64_t>(a.options.seed);
  for (Shape const& s : library.shape)
    if (s.is_net() && s.net == shape.net) shape.certificate.made_with = s.certificate.made_with;
  if (!a.keep) {
    library = {{library.net[shape.net]}, {}, {}, {}, {}};
    shape.net = 0;
  }
  library.shape.push_back(shape);
  try {
    PublishOptions publish;
    publish.seed = a.options.seed, publish.threads = a.options.threads;
    publish_shape(library, static_cast<int>(library.shape.size()) - 1, body, publish);
  } catch (std::runtime_error const& e) {
    throw std::invalid_argument(fmt::format("{}: the decoder of {} has no solid like it (best MAE {:.2e} d): {}",
                                            a.mesh.string(), a.model.string(), best.after, e.what()));
  }
  write_model(a.output, library, a.force);
  if (!a.quiet) fmt::print("{}\n{}", error_table({library.shape.back()}), phi_table({library.shape.back()}));
  fmt::print("{}: '{}', MAE {:.2e} d before, {:.2e} d after, from {}; {:.0f} s\n", a.output.string(), body.name,
             best.before, library.shape.back().certificate.mae, description(best), seconds);
  return exit_ok;
}

}  // namespace

void add_encode_command(CLI::App& app, std::function<int()>& chosen) {
  auto const a = std::make_shared<EncodeArguments>();
  EncodeOptions& o = a->options;
  CLI::App* const c = app.add_subcommand("encode", "The latent code of an unseen mesh under a decoder that stays");
  c->add_option("model", a->model, "Model file with a shared decoder and its codes (.h5)")->required();
  c->add_option("mesh", a->mesh, "Closed mesh (.stl, .obj, .ply), any unit, or a formula: ellipsoid:1:0.8:0.6")
      ->required();
  c->add_option("-o,--output", a->output, "Model file to write (.h5): the decoder and the new code")->required();
  c->add_option("--name", a->name, "Name of the shape (default: the file's)");
  c->add_flag("--keep", a->keep, "Keep the model's shapes beside the new one");
  c->add_flag("--repair", a->repair, "First repair a mesh that bounds no solid, as scree-shape import does");
  c->add_option("--samples", o.samples, "Samples of the distance")
      ->check(CLI::Range(100, 1000000))
      ->capture_default_str();
  c->add_option("--nearest", o.nearest, "Known codes to start from in every turn")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  c->add_option("--seed", o.seed, "Seed of the samples")->capture_default_str();
  c->add_option("--threads", o.threads, "CPU threads; do not change the result")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  c->add_flag("--quiet", a->quiet, "Only the last line");
  c->add_flag("--force", a->force, "Replace an existing output file");
  c->callback([a, &chosen] { chosen = [a] { return run_encode(*a); }; });
}

}  // namespace scree

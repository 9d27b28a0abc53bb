// network_import.cpp: see network_import.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/network_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "shapes/certify_phi.h"
#include "shapes/exchange/foreign_net.h"
#include "shapes/exchange/safetensors_model.h"
#include "shapes/file_hash.h"
#include "shapes/model_file.h"
#include "shapes/normalise.h"
#include "shapes/phi_batch.h"
#include "shapes/support_points.h"
#include "shapes/text_lines.h"
#include "tools/certificate_table.h"
#include "tools/guarded.h"
#include "tools/shape_input.h"

namespace scree {
namespace {

double constexpr default_radius = 1.5;

Library our_library(NetworkImport const& a, TensorFile const& content) {
  if (a.any_convention())
    throw std::invalid_argument(a.file.string() +
                                " is a Scree export and says its activation, names and sign itself: leave out "
                                "--activation, --parameter, --name, --radius and --negative-inside");
  Library library = library_of(content);
  std::vector<std::string> const lies = false_figures(library);
  if (!lies.empty()) throw std::runtime_error(lies.front() + "; was it changed by hand?");
  return library;
}

// Far from the grain phi must be negative; the wrong sign would give a grain-shaped hole in a ball.
void check_sign(Library const& library, Shape const& shape, double radius) {
  std::vector<Vec3> point = quasi_uniform_directions(200);
  for (Vec3& x : point) x *= radius;
  std::vector<double> phi(point.size());
  fast_phi(library, shape)(point, phi, {});
  if (std::count_if(phi.begin(), phi.end(), [](double v) { return v > 0; }) > 100)
    throw std::runtime_error(
        "phi is positive at most points of that radius; add or leave out --negative-inside, or "
        "change --radius");
}

// Normalised and measured: nothing is known of them but phi.
Library foreign_library(NetworkImport const& a, TensorFile const& content) {
  if (a.activation.empty() || a.parameter < 0)
    throw std::invalid_argument(
        a.file.string() +
        " is no Scree export: say --activation leaky_relu|sine|softplus and --parameter (slope, "
        "omega or beta)");
  Library library;
  library.net.push_back(net_of(content, {activation_from_string(a.activation), a.parameter, a.negative_inside}));
  std::string const name = a.name.empty() ? a.file.stem().string() : a.name;
  std::vector<std::vector<float>> const codes = codes_of(content, library.net[0]);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    Shape shape;
    shape.name = codes.size() == 1 ? name : name + "/" + std::to_string(i);
    shape.kind = ShapeKind::net;
    shape.net = 0;
    shape.code = codes[i];
    shape.certificate.source = "network " + a.file.filename().string();
    shape.certificate.source_hash = file_hash(a.file);
    library.shape.push_back(shape);
  }
  double const radius = a.radius > 0 ? a.radius : default_radius;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    try {
      check_sign(library, library.shape[i], radius);
      RawShape const raw = normalise_net(library, static_cast<int>(i), radius);
      Shape& shape = library.shape[i];
      fmt::print("{}: equal-volume diameter {:.6g} of the network's unit\n", shape.name, raw.diameter);
      certify_phi(library, shape, {}, shape.certificate);
    } catch (std::runtime_error const& error) {
      throw std::runtime_error(
          fmt::format("shape {}: {} (--radius {:g})", library.shape[i].name, error.what(), radius));
    }
  }
  return library;
}

}  // namespace

bool is_network_file(std::filesystem::path const& file) { return lower_extension(file) == ".safetensors"; }

int import_networks(NetworkImport const& a) {
  check_output(a.output, a.force);
  if (lower_extension(a.output) != ".h5")
    throw std::invalid_argument(a.output.string() + ": networks become a model file: write a .h5 file");
  TensorFile const content = read_input([&] { return read_safetensors(a.file); });
  Library library;
  try {
    library = is_model_tensors(content) ? our_library(a, content) : foreign_library(a, content);
  } catch (std::runtime_error const& error) {
    throw std::invalid_argument(a.file.string() + ": " + error.what());
  }
  write_model(a.output, library, a.force);
  fmt::print("{}\n{}: {} networks, {} shapes\n", phi_table(library.shape), a.output.string(), library.net.size(),
             library.shape.size());
  return exit_ok;
}

}  // namespace scree

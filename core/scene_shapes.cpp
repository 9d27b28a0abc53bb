// scene_shapes.cpp: see scene_shapes.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/scene_shapes.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <utility>

#include "core/nearest_name.h"
#include "shapes/analytic_shapes.h"
#include "shapes/model_file.h"

namespace scree {

namespace {

// The gate: a network whose gradient strays has the wrong contact stiffness.
void check_gradient(Shape const& shape, LimitsCase const& limits, std::vector<std::string>& found) {
  if (!shape.is_net) return;
  double const low = shape.certificate.gradient_p1, high = shape.certificate.gradient_p99;
  if (low < 0 || high < 0)
    found.push_back("shape '" + shape.name +
                    "' has no certificate: its gradient was never measured. Train it again with "
                    "scree-train, which measures it");
  else if (low < limits.gradient_low || high > limits.gradient_high)
    found.push_back(
        fmt::format("shape '{}': |grad phi| of its certificate runs from {:.3g} to {:.3g} (1st and 99th "
                    "percentile), limits.gradient allows [{:.3g}, {:.3g}]",
                    shape.name, low, high, limits.gradient_low, limits.gradient_high));
}

}  // namespace

ShapeCatalogue::ShapeCatalogue(Case const& c, std::vector<std::string>& found) : names_(c.library), limits_(c.limits) {
  for (LibraryCase const& entry : names_) {
    try {
      libraries_.push_back(read_model(entry.file));
    } catch (std::exception const& e) {
      found.push_back("library '" + entry.name + "': " + e.what());
      libraries_.push_back({});
    }
  }
}

int ShapeCatalogue::add(Key const& key, Shape const& shape, Scene& scene) {
  for (std::size_t i = 0; i < keys_.size(); ++i)
    if (keys_[i].library == key.library && keys_[i].shape == key.shape && keys_[i].nodes == key.nodes &&
        keys_[i].name == key.name)
      return static_cast<int>(i);
  keys_.push_back(key);
  scene.library.shape.push_back(shape);
  scene.nodes_wanted.push_back(key.nodes);
  return static_cast<int>(keys_.size()) - 1;
}

std::vector<int> ShapeCatalogue::templates_for(GrainsCase const& grains, Scene& scene,
                                               std::vector<std::string>& found) {
  std::vector<int> chosen;
  for (std::string const& word : grains.shapes) {
    if (is_builtin_shape(word)) {
      try {
        chosen.push_back(add({-1, 0, grains.nodes, word}, builtin_shape(word), scene));
      } catch (std::invalid_argument const& e) {
        found.push_back("grains '" + grains.name + "': " + e.what());
      }
      continue;
    }
    std::size_t const colon = word.find(':');
    std::string const library = word.substr(0, colon),
                      pattern = colon == std::string::npos ? "" : word.substr(colon + 1);
    auto const entry = std::find_if(names_.begin(), names_.end(), [&](auto const& n) { return n.name == library; });
    if (entry == names_.end()) {
      found.push_back("grains '" + grains.name + "': shape '" + word + "': no [[library]] is called '" + library + "'");
      continue;
    }
    int const index = static_cast<int>(entry - names_.begin());
    Library const& from = libraries_[index];
    if (grains.evaluator == Evaluator::analytic)
      found.push_back("grains '" + grains.name + "': evaluator = \"analytic\" needs built-in shapes; '" + word +
                      "' is a network. Use evaluator = \"net\".");
    std::size_t const before = chosen.size();
    std::vector<std::string> known;
    for (std::size_t s = 0; s < from.shape.size(); ++s) {
      known.push_back(from.shape[s].name);
      if (fnmatch(pattern.c_str(), from.shape[s].name.c_str(), 0) != 0) continue;
      check_gradient(from.shape[s], limits_, found);
      chosen.push_back(add({index, static_cast<int>(s), grains.nodes, ""}, from.shape[s], scene));
    }
    if (chosen.size() == before && !from.shape.empty())
      found.push_back("grains '" + grains.name + "': shape '" + word + "' matches nothing in " +
                      entry->file.filename().string() + did_you_mean(pattern, known));
  }
  return chosen;
}

namespace {

ShapeRecord record_of(Shape const& shape, int net, int bias_row) {
  ShapeRecord r;
  r.closed_form_sphere = !shape.is_net && shape.analytic.kind == AnalyticKind::sphere;
  r.net = net;
  r.bias_row = bias_row;
  r.analytic = shape.analytic;
  r.query_rotation = shape.query.rotation;
  r.query_shift = shape.query.shift;
  r.query_scale = shape.query.scale;
  r.bounding_radius = shape.bounding_radius;
  r.box = shape.box;
  // The box is that of a triangulated zero set, whose vertices lie on it to 1e-6 d and whose chords lie inside.
  double constexpr slack = 2e-3;
  if (shape.is_net)
    for (int k = 0; k < 3; ++k) r.box.min[k] -= slack, r.box.max[k] += slack;
  r.lipschitz = std::max(1.0, shape.lipschitz);
  return r;
}

void append_nodes(SurfaceNodes const& nodes, ShapeRecord& record, Scene& scene) {
  record.first_node = static_cast<int>(scene.node_position.size());
  record.nodes = static_cast<int>(nodes.position.size());
  record.first_block = static_cast<int>(scene.block_centre.size());
  record.blocks = static_cast<int>(nodes.block_centre.size());
  record.node_spacing = nodes.spacing;
  scene.node_position.insert(scene.node_position.end(), nodes.position.begin(), nodes.position.end());
  scene.node_area.insert(scene.node_area.end(), nodes.area.begin(), nodes.area.end());
  scene.block_centre.insert(scene.block_centre.end(), nodes.block_centre.begin(), nodes.block_centre.end());
  scene.block_radius.insert(scene.block_radius.end(), nodes.block_radius.begin(), nodes.block_radius.end());
  scene.block_first.insert(scene.block_first.end(), nodes.block_first.begin(), nodes.block_first.end());
}

}  // namespace

void ShapeCatalogue::finish(Scene& scene, int threads, std::vector<std::string>& found) {
  std::map<std::pair<int, int>, int> net_index;  // (library, net) -> scene network
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    Shape& shape = scene.library.shape[i];
    if (!shape.is_net) {
      scene.shape.push_back(record_of(shape, -1, 0));
      continue;
    }
    auto const [at, fresh] =
        net_index.emplace(std::pair{keys_[i].library, shape.net}, static_cast<int>(scene.networks.net.size()));
    if (fresh) {
      Mlp const& net = libraries_[keys_[i].library].net[shape.net];
      scene.library.net.push_back(net);
      scene.networks.net.emplace_back(net);
      scene.networks.bias_rows.emplace_back();
    }
    shape.net = at->second;
    PackedMlp const& packed = scene.networks.net[shape.net];
    int const row = packed.append_bias(fold_code(packed.net(), shape.code), scene.networks.bias_rows[shape.net]);
    scene.shape.push_back(record_of(shape, shape.net, row));
  }
  bool const only_spheres =
      std::all_of(scene.shape.begin(), scene.shape.end(), [](ShapeRecord const& r) { return r.closed_form_sphere; });
  // Node sets are independent of each other and of the thread that makes them.
  std::vector<SurfaceNodes> nodes(keys_.size());
  std::vector<std::string> errors(keys_.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (only_spheres) continue;  // they meet in closed form
    try {
      Shape const& shape = scene.library.shape[i];
      nodes[i] = make_surface_nodes(scene.library, shape, keys_[i].nodes, {.measure_gap = false});
    } catch (std::exception const& e) {
      errors[i] = "shape '" + scene.library.shape[i].name + "': no surface nodes: " + e.what();
    }
  }
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (!errors[i].empty()) found.push_back(errors[i]);
    append_nodes(nodes[i], scene.shape[i], scene);
  }
}

}  // namespace scree

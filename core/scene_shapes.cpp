// scene_shapes.cpp: see scene_shapes.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/scene_shapes.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <map>
#include <utility>

#include "core/certificate_gate.h"
#include "core/made_shapes_cache.h"
#include "core/nearest_name.h"
#include "core/sampled_grains.h"
#include "core/scene_evaluators.h"
#include "core/unique_grains.h"
#include "shapes/analytic_shapes.h"
#include "shapes/half_thickness.h"
#include "shapes/mesh_files.h"
#include "shapes/mesh_shape.h"
#include "shapes/model_file.h"

namespace scree {

ShapeCatalogue::ShapeCatalogue(Case const& c, std::vector<std::string>& found) : names_(c.library), limits_(c.limits) {
  for (LibraryCase const& entry : names_) {
    try {
      libraries_.push_back(read_model(entry.file));
    } catch (std::exception const& e) {
      found.push_back("library '" + entry.name + "': " + e.what());
      libraries_.push_back({});
    }
  }
  libraries_.push_back({});  // built-in shapes and mesh files
}

int ShapeCatalogue::add(Key const& key, Scene& scene) {
  auto const at = std::find(keys_.begin(), keys_.end(), key);
  if (at != keys_.end()) return static_cast<int>(at - keys_.begin());
  keys_.push_back(key);
  Shape shape = libraries_[key.library].shape[key.shape];
  // Names stay unique: a shape may come with two node counts or two evaluators.
  auto const taken = [&](std::string const& name) {
    return std::any_of(scene.library.shape.begin(), scene.library.shape.end(),
                       [&](Shape const& s) { return s.name == name; });
  };
  std::string const name = shape.name;
  for (int n = 2; taken(shape.name); ++n) shape.name = fmt::format("{} #{}", name, n);
  scene.library.shape.push_back(shape);
  scene.nodes_wanted.push_back(key.nodes);
  return static_cast<int>(keys_.size()) - 1;
}

// A built-in shape or a mesh file, made or read once.
int ShapeCatalogue::loose_shape(std::string const& word) {
  auto const [at, fresh] = loose_.try_emplace(word, 0);
  if (!fresh) return at->second;
  Library& own = libraries_[names_.size()];
  try {
    if (std::filesystem::path const file = mesh_file_of(word); !file.empty()) {
      try {
        at->second = add_mesh_shape(own, "mesh:" + file.filename().string(), read_mesh(file));
      } catch (std::invalid_argument const& e) {
        throw std::invalid_argument(file.string() + ": " + e.what());
      }
    } else {
      own.shape.push_back(builtin_shape(word));
      at->second = static_cast<int>(own.shape.size()) - 1;
    }
  } catch (...) {
    loose_.erase(at);
    throw;
  }
  return at->second;
}

// What a template is evaluated as, or a sentence in `found`.
void ShapeCatalogue::choose_evaluator(GrainsCase const& grains, std::string const& word, Key& key,
                                      std::vector<std::string>& found) const {
  ShapeKind const stored = libraries_[key.library].shape[key.shape].kind;
  bool const formula = stored == ShapeKind::analytic || stored == ShapeKind::harmonics;
  if (grains.evaluator == Evaluator::analytic && !formula)
    found.push_back(
        fmt::format("grains '{}': evaluator = \"analytic\" needs formulas (built-in shapes, harmonics); '{}' is "
                    "stored as a {}. Use evaluator = \"net\", \"grid\" or \"mesh\".",
                    grains.name, word, to_string(stored)));
  key.evaluated = stored;
  if (grains.evaluator == Evaluator::grid) key.evaluated = ShapeKind::grid, key.cells = grains.grid_cells;
  if (grains.evaluator == Evaluator::mesh) key.evaluated = ShapeKind::mesh, key.cells = grains.mesh_cells;
  if (key.evaluated == stored) key.cells = 0;  // nothing to bake
  key.compact = grains.storage == NodeStorage::compact;
  if (key.compact && key.evaluated != ShapeKind::net)
    found.push_back(
        fmt::format("grains '{}': storage = \"compact\" is for shapes run as networks; '{}' runs as {}. Use storage = "
                    "\"explicit\".",
                    grains.name, word, to_string(key.evaluated)));
}

std::vector<int> ShapeCatalogue::templates_for(GrainsCase const& grains, Scene& scene,
                                               std::vector<std::string>& found) {
  std::vector<int> chosen;
  int const loose = static_cast<int>(names_.size());
  for (std::string const& word : grains.shapes) {
    if (is_builtin_shape(word) || !mesh_file_of(word).empty()) {
      try {
        Key key{loose, loose_shape(word), grains.nodes};
        choose_evaluator(grains, word, key, found);
        chosen.push_back(add(key, scene));
      } catch (std::exception const& e) {
        found.push_back("grains '" + grains.name + "': " + e.what());
      }
      continue;
    }
    std::size_t const colon = word.find(':');
    std::string const library = word.substr(0, colon),
                      pattern = colon == std::string::npos ? "" : word.substr(colon + 1);
    int const index = library_called(library);
    if (index < 0) {
      found.push_back("grains '" + grains.name + "': shape '" + word + "': no [[library]] is called '" + library + "'");
      continue;
    }
    Library const& from = libraries_[index];
    std::size_t const before = chosen.size();
    std::vector<std::string> known;
    for (std::size_t s = 0; s < from.shape.size(); ++s) {
      known.push_back(from.shape[s].name);
      if (fnmatch(pattern.c_str(), from.shape[s].name.c_str(), 0) != 0) continue;
      for (std::string& problem : gate_problems(from.shape[s], names_[index].file, limits_)) found.push_back(problem);
      Key key{index, static_cast<int>(s), grains.nodes};
      choose_evaluator(grains, from.shape[s].name, key, found);
      chosen.push_back(add(key, scene));
    }
    if (chosen.size() == before && !from.shape.empty())
      found.push_back("grains '" + grains.name + "': shape '" + word + "' matches nothing in " +
                      names_[index].file.filename().string() + did_you_mean(pattern, known));
  }
  return chosen;
}

int ShapeCatalogue::library_called(std::string const& name) const {
  auto const entry = std::find_if(names_.begin(), names_.end(), [&](auto const& n) { return n.name == name; });
  return entry == names_.end() ? -1 : static_cast<int>(entry - names_.begin());
}

bool ShapeCatalogue::taken(std::string const& prefix, Scene const& scene) const {
  return std::any_of(scene.library.shape.begin(), scene.library.shape.end(),
                     [&](Shape const& s) { return s.name.starts_with(prefix); }) ||
         std::any_of(unique_.begin(), unique_.end(), [&](Unique const& u) { return u.prefix == prefix; });
}

// Which shapes rays from the centre describe. The grains are made again in finish(): 3 ms beside the 500 of a draw.
std::vector<char> ShapeCatalogue::star_shaped(CompactGrainMaker const& maker, std::vector<Shape> const& shape,
                                              int threads) const {
  std::vector<char> yes(shape.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (std::size_t i = 0; i < shape.size(); ++i) {
    CompactGrain grain;
    yes[i] = maker.make(shape[i].code, grain) == GrainFault::none;
  }
  return yes;
}

std::vector<int> ShapeCatalogue::make_templates(GrainsCase const& grains, int group, std::uint64_t seed, Scene& scene,
                                                int threads, std::vector<std::string>& found) {
  int const from = library_called(grains.sample ? grains.sample->library : grains.interpolate->library);
  MadeShapes made;
  try {
    made = cached_make_shapes(libraries_[from], grains, limits_, seed, group, threads, scene.notes);
  } catch (std::invalid_argument const& e) {
    found.push_back(fmt::format("grains '{}': {}: {}", grains.name, names_[from].file.filename().string(), e.what()));
  }
  if (made.shape.empty()) return {};
  if (auto problem = gate_problems(made.shape[0], names_[from].file, limits_); !problem.empty())
    found.insert(found.end(), problem.begin(), problem.end());
  scene.notes.push_back(made.note);
  std::string prefix = made_category(grains) + "/";
  for (int n = 2; taken(prefix, scene); ++n) prefix = fmt::format("{} #{}/", made_category(grains), n);

  std::vector<char> compact(made.shape.size(), 0);
  if (grains.storage == NodeStorage::compact) {
    int const net = made.shape[0].net;
    if (!makers_) makers_.emplace(libraries_, scene);
    unique_.push_back({prefix, from, net, grains.nodes, {}});
    compact = star_shaped(*makers_->get(from, net, grains.nodes).maker, made.shape, threads);
    prefix += "array/";  // of those that keep arrays: unique grains count for themselves
  }
  std::vector<int> chosen;
  int const own = static_cast<int>(libraries_.size());
  libraries_.push_back({libraries_[from].net, {}, {}, {}, {}});
  for (std::size_t i = 0; i < made.shape.size(); ++i) {
    Shape& shape = made.shape[i];
    if (compact[i]) {
      unique_.back().code.insert(unique_.back().code.end(), shape.code.begin(), shape.code.end());
      chosen.push_back(-1 - unique_count_++);
      continue;
    }
    shape.name = prefix + std::to_string(libraries_[own].shape.size());
    libraries_[own].shape.push_back(std::move(shape));
    Key key{own, static_cast<int>(libraries_[own].shape.size()) - 1, grains.nodes};
    choose_evaluator(grains, libraries_[own].shape.back().name, key, found);
    key.compact = false;
    chosen.push_back(add(key, scene));
  }
  if (std::size_t const arrays = libraries_[own].shape.size(); grains.storage == NodeStorage::compact && arrays > 0)
    scene.notes.push_back(fmt::format("grains '{}': {} of {} are kept as arrays of nodes, not compact: {}", grains.name,
                                      arrays, made.shape.size(), to_string(GrainFault::not_star_shaped)));
  return chosen;
}

namespace {

// Along which thin parts are looked for [d]: a needle 50:1 is 0.22 d thick, a plate 1:20 0.11 d.
double constexpr thickness_step = 0.01;

void append_nodes(SurfaceNodes const& nodes, ShapeRecord& record, Scene& scene) {
  record.first_node = static_cast<int>(scene.node_position.size());
  record.nodes = static_cast<int>(nodes.position.size());
  record.first_block = static_cast<int>(scene.block_centre.size());
  record.first_bound = static_cast<int>(scene.block_first.size());
  record.blocks = static_cast<int>(nodes.block_centre.size());
  record.node_spacing = nodes.spacing;
  scene.node_position.insert(scene.node_position.end(), nodes.position.begin(), nodes.position.end());
  scene.node_area.insert(scene.node_area.end(), nodes.area.begin(), nodes.area.end());
  scene.block_centre.insert(scene.block_centre.end(), nodes.block_centre.begin(), nodes.block_centre.end());
  scene.block_radius.insert(scene.block_radius.end(), nodes.block_radius.begin(), nodes.block_radius.end());
  scene.block_first.insert(scene.block_first.end(), nodes.block_first.begin(), nodes.block_first.end());
}

}  // namespace

void ShapeCatalogue::finish(Scene& scene, std::vector<std::vector<int>>& templates, bool sphere_nodes, int threads,
                            std::vector<std::string>& found) {
  SceneEvaluators evaluators(libraries_, scene, threads);
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    Shape& shape = scene.library.shape[i];
    try {
      Key const& key = keys_[i];
      scene.shape.push_back(evaluators.add(key.library, key.shape, key.evaluated, key.cells, shape));
    } catch (std::exception const& e) {
      found.push_back("shape '" + shape.name + "': as a " + to_string(keys_[i].evaluated) + ": " + e.what());
      scene.shape.push_back({});
    }
  }
  // 16-bit radii along shared directions, and the frame that belongs to them; bodies that rays cannot describe keep
  // arrays.
  if (!makers_) makers_.emplace(libraries_, scene);
  std::vector<CompactMakers::Entry const*> maker(keys_.size(), nullptr);
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    Key const& key = keys_[i];
    if (key.compact && key.evaluated == ShapeKind::net)
      maker[i] = &makers_->get(key.library, libraries_[key.library].shape[key.shape].net, key.nodes);
  }
  std::vector<CompactGrain> compact(keys_.size());
  std::vector<GrainFault> fault(keys_.size(), GrainFault::no_surface);
  bool const only_spheres =
      !sphere_nodes && unique_.empty() &&
      std::all_of(scene.shape.begin(), scene.shape.end(), [](ShapeRecord const& r) { return r.closed_form_sphere; });
  // Node sets are independent of each other and of the thread that makes them.
  std::vector<SurfaceNodes> nodes(keys_.size());
  std::vector<double> thickness(keys_.size(), 1e300);  // spheres in closed form have no far side
  std::vector<std::string> errors(keys_.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (only_spheres) continue;  // they meet in closed form
    try {
      Shape const& shape = scene.library.shape[i];
      if (maker[i]) fault[i] = maker[i]->maker->make(shape.code, compact[i]);
      if (maker[i] && fault[i] == GrainFault::none) continue;
      nodes[i] = make_surface_nodes(scene.library, shape, keys_[i].nodes, {.measure_gap = false});
      std::vector<Vec3> surface(nodes[i].position.begin(), nodes[i].position.begin() + nodes[i].n_surface);
      thickness[i] = half_thickness(fast_phi(scene.library, shape), surface, nodes[i].normal, thickness_step, 0.3);
    } catch (std::exception const& e) {
      errors[i] = "shape '" + scene.library.shape[i].name + "': no surface nodes: " + e.what();
    }
  }
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    if (!errors[i].empty()) found.push_back(errors[i]);
    if (!maker[i] || fault[i] != GrainFault::none) {
      if (maker[i])
        scene.notes.push_back(fmt::format("shape '{}' is kept as arrays of nodes, not compact: {}",
                                          scene.library.shape[i].name, to_string(fault[i])));
      append_nodes(nodes[i], scene.shape[i], scene);
      scene.shape[i].half_thickness = thickness[i];
      continue;
    }
    Shape& shape = scene.library.shape[i];
    ShapeRecord& record = scene.shape[i];
    adopt(compact[i], shape);
    ShapeRecord const framed = record_of(shape);
    record.query_rotation = framed.query_rotation, record.query_shift = framed.query_shift;
    record.query_scale = framed.query_scale;
    record.bounding_radius = framed.bounding_radius, record.box = framed.box, record.lipschitz = framed.lipschitz;
    scene.compact.append(compact[i], maker[i]->set, record);
  }
  for (Unique const& u : unique_)
    add_unique_grains(scene, *makers_->get(u.library, u.net, u.nodes).maker,
                      scene_network(scene, libraries_[u.library].net[u.net]), u.code, u.prefix, threads);
  for (std::vector<int>& entry : templates)
    for (int& t : entry)
      if (t < 0) t = static_cast<int>(keys_.size()) - 1 - t;
}

}  // namespace scree

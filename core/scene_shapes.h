// scene_shapes.h: from the shapes an entry names, or has made, to templates with nodes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/scene.h"
#include "core/unique_grains.h"

namespace scree {

// Index of the template of each shape an entry names (patterns expanded in file order), added to `scene` where new.
// Problems are appended to `found`, a line each.
class ShapeCatalogue {
 public:
  ShapeCatalogue(Case const& c, std::vector<std::string>& found);
  std::vector<int> templates_for(GrainsCase const& grains, Scene& scene, std::vector<std::string>& found);
  // The same for an entry whose shapes are made for the case, `group` its place among the entries and `seed` that of
  // its replica: one template a grain, in the order they were made. After all entries that name shapes. Templates that
  // become unique grains stand behind all others: negative until finish() has placed them.
  std::vector<int> make_templates(GrainsCase const& grains, int group, std::uint64_t seed, Scene& scene, int threads,
                                  std::vector<std::string>& found);
  // Fill in records, nodes and networks of all templates, and the places that make_templates left open.
  // Nodes are left out where only closed-form spheres are and `sphere_nodes` is false.
  void finish(Scene& scene, std::vector<std::vector<int>>& templates, bool sphere_nodes, int threads,
              std::vector<std::string>& found);

 private:
  struct Key {
    int library, shape;  // of libraries_
    int nodes;
    ShapeKind evaluated = ShapeKind::analytic;
    int cells = 0;  // of the grid or mesh to bake; 0: evaluated as it is stored
    bool compact = false;
    bool operator==(Key const&) const = default;
  };
  // Codes of one entry that become unique grains.
  struct Unique {
    std::string prefix;  // of their names
    int library, net, nodes;
    std::vector<float> code;
  };
  int add(Key const& key, Scene& scene);
  int library_called(std::string const& name) const;  // -1: none
  bool taken(std::string const& prefix, Scene const& scene) const;
  std::vector<char> star_shaped(CompactGrainMaker const& maker, std::vector<Shape> const& shape, int threads) const;
  int loose_shape(std::string const& word);
  void choose_evaluator(GrainsCase const& grains, std::string const& word, Key& key,
                        std::vector<std::string>& found) const;

  std::vector<LibraryCase> names_;
  LimitsCase limits_;
  std::vector<Library> libraries_;    // of the case, one of loose shapes, one of each entry's made shapes
  std::map<std::string, int> loose_;  // word -> shape of the last library
  std::vector<Key> keys_;
  std::optional<CompactMakers> makers_;
  std::vector<Unique> unique_;
  int unique_count_ = 0;  // their codes
};

}  // namespace scree

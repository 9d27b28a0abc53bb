// scene_shapes.h: from the words in `shapes = [...]` to templates with nodes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/scene.h"

namespace scree {

// Index of the template of each shape an entry names (patterns expanded in file order), added to `scene` where new.
// Problems are appended to `found`, a line each.
class ShapeCatalogue {
 public:
  ShapeCatalogue(Case const& c, std::vector<std::string>& found);
  std::vector<int> templates_for(GrainsCase const& grains, Scene& scene, std::vector<std::string>& found);
  // Fill in records, nodes and networks of all templates.
  void finish(Scene& scene, int threads, std::vector<std::string>& found);

 private:
  struct Key {
    int library, shape;  // the last library holds built-in shapes and mesh files
    int nodes;
    ShapeKind evaluated = ShapeKind::analytic;
    int cells = 0;  // of the grid or mesh to bake; 0: evaluated as it is stored
    bool compact = false;
    bool operator==(Key const&) const = default;
  };
  int add(Key const& key, Scene& scene);
  int loose_shape(std::string const& word);
  void choose_evaluator(GrainsCase const& grains, std::string const& word, Key& key,
                        std::vector<std::string>& found) const;

  std::vector<LibraryCase> names_;
  LimitsCase limits_;
  std::vector<Library> libraries_;    // of the case, then one of loose shapes
  std::map<std::string, int> loose_;  // word -> shape of the last library
  std::vector<Key> keys_;
};

}  // namespace scree

// scene_shapes.h: from the words in `shapes = [...]` to templates with nodes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

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
    int library, shape, nodes;  // library -1: built-in, then `name`
    std::string name;
  };
  int add(Key const& key, Shape const& shape, Scene& scene);

  std::vector<LibraryCase> names_;
  LimitsCase limits_;
  std::vector<Library> libraries_;
  std::vector<Key> keys_;
};

}  // namespace scree

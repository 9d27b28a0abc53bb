// shape_strip.cpp: see shape_strip.h.
// SPDX-License-Identifier: Apache-2.0
#include "tools/shape_strip.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "shapes/mesh_files.h"
#include "shapes/model_file.h"
#include "shapes/zero_set.h"
#include "tools/shape_input.h"

namespace scree {

namespace fs = std::filesystem;

void write_strip(Library const& library, std::vector<Candidate> const& made, fs::path const& output,
                 fs::path const& stl, bool force) {
  Library strip;
  strip.net = library.net;
  for (Candidate const& c : made)
    if (c.verdict == Verdict::accepted) strip.shape.push_back(c.shape);
  if (strip.shape.empty()) throw std::invalid_argument("no shape passed the gate: nothing is written");
  if (!stl.empty()) {
    fs::create_directories(stl);
    for (Shape const& shape : strip.shape) {
      std::string name = shape.name + ".stl";
      std::replace(name.begin(), name.end(), '/', '_');
      check_output(stl / name, force);
      write_mesh(stl / name,
                 find_zero_set(fast_phi(strip, shape), {1.05 * shape.bounding_radius, 64, shape.lipschitz}).mesh);
    }
    fmt::print("{}: {} meshes\n", stl.string(), strip.shape.size());
  }
  write_model(output, strip, force);
  fmt::print("{}: {} shapes\n", output.string(), strip.shape.size());
}

}  // namespace scree

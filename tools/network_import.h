// network_import.h: what `scree-shape import` makes of a safetensors file: a model file.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace scree {

struct NetworkImport {
  std::filesystem::path file, output;
  bool force = false;
  // Of networks that another program wrote; not given for our own files, which say it themselves.
  std::string activation;  // empty: not given
  double parameter = -1;   // slope, omega or beta; negative: not given
  std::string name;        // of the shape; empty: the file's
  double radius = 0;       // ball about the origin that holds the surface [own unit]; 0: not given
  bool negative_inside = false;

  bool any_convention() const {
    return !activation.empty() || parameter >= 0 || !name.empty() || radius > 0 || negative_inside;
  }
};

bool is_network_file(std::filesystem::path const& file);  // .safetensors, any case

// Reads, checks, writes the model and prints what came out. Returns the exit code. Throws std::invalid_argument for
// anything wrong with the file, or between it and the options.
int import_networks(NetworkImport const& a);

}  // namespace scree

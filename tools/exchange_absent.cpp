// exchange_absent.cpp: model_export.h and network_import.h in a build without SCREE_EXCHANGE.
// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "shapes/text_lines.h"
#include "tools/model_export.h"
#include "tools/network_import.h"

namespace scree {

// There is no command to add.
void add_model_export(CLI::App&, std::function<int()>&) {}

bool is_network_file(std::filesystem::path const& file) { return lower_extension(file) == ".safetensors"; }

int import_networks(NetworkImport const& a) {
  throw std::invalid_argument(a.file.string() +
                              ": this program was built without exchange: install "
                              "nlohmann-json3-dev, configure with SCREE_EXCHANGE=ON");
}

}  // namespace scree

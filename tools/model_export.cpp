// model_export.cpp: `scree-train export` and `scree-shape export`: a model file's networks for other programs. It needs
// no LibTorch, so that scree-shape has it too, where scree-train was not built.
// SPDX-License-Identifier: Apache-2.0
#include "tools/model_export.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "shapes/exchange/onnx_file.h"
#include "shapes/exchange/safetensors_model.h"
#include "shapes/model_file.h"
#include "shapes/whole_file.h"
#include "tools/guarded.h"
#include "tools/shape_input.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct ExportArguments {
  fs::path model, output;
  std::string format, shape;
  bool code_input = false, force = false;
};

int export_tensors(ExportArguments const& a, Library const& library) {
  if (!a.shape.empty() || a.code_input)
    throw std::invalid_argument("--shape and --code-input are for --format onnx; safetensors hold the whole model");
  TensorFile content;
  try {
    content = tensors_of(library);
  } catch (std::invalid_argument const& error) {
    throw std::invalid_argument(a.model.string() + ": " + error.what());
  }
  write_safetensors(a.output, content, a.force);
  fmt::print("{}: {} networks, {} tensors\n", a.output.string(), library.net.size(), content.tensor.size());
  std::vector<std::string> left_out;
  for (Shape const& s : library.shape)
    if (!s.is_net()) left_out.push_back(s.name);
  if (!left_out.empty()) fmt::print("left out, no networks: {}\n", fmt::join(left_out, ", "));
  return exit_ok;
}

Shape const& network_shape(ExportArguments const& a, Library const& library) {
  std::vector<std::string> names;
  for (Shape const& s : library.shape) {
    if (!s.is_net()) continue;
    if (s.name == a.shape) return s;
    names.push_back(s.name);
  }
  if (names.empty())
    throw std::invalid_argument(a.model.string() + ": has no shape that is a network: there is nothing to export");
  for (Shape const& s : library.shape)
    if (s.is_net() && a.shape.empty() && (names.size() == 1 || (a.code_input && library.net.size() == 1))) return s;
  throw std::invalid_argument(fmt::format(
      "{}{}; choose with --shape one of: {}", a.model.string(),
      a.shape.empty() ? " has several networks" : " has no network '" + a.shape + "'", fmt::join(names, ", ")));
}

int export_onnx(ExportArguments const& a, Library const& library) {
  if (!onnx_available())
    throw std::invalid_argument(
        "--format onnx: this program was built without ONNX; install libonnx-dev and configure with SCREE_ONNX=ON");
  Shape const& shape = network_shape(a, library);
  write_whole_file(a.output, a.code_input ? onnx_decoder(library, shape.net) : onnx_model(library, shape), a.force);
  fmt::print("{}: {}\n", a.output.string(),
             a.code_input ? "phi(x, code) of network " + std::to_string(shape.net) + ", in its own frame and unit"
                          : "phi(x) of " + shape.name + ", x and phi in d, positive inside");
  return exit_ok;
}

int export_model(ExportArguments const& a) {
  check_output(a.output, a.force);
  Library const library = read_input([&] { return read_model(a.model); });
  return a.format == "onnx" ? export_onnx(a, library) : export_tensors(a, library);
}

}  // namespace

void add_model_export(CLI::App& app, std::function<int()>& chosen) {
  auto const a = std::make_shared<ExportArguments>();
  CLI::App* const c = app.add_subcommand("export", "Write a model's networks for other programs");
  c->add_option("model", a->model, "Model file (.h5)")->required();
  c->add_option("--format", a->format, "safetensors: all networks, codes and shapes; onnx: phi of one shape")
      ->required()
      ->check(CLI::IsMember({"safetensors", "onnx"}));
  c->add_option("-o,--output", a->output, "File to write")->required();
  c->add_option("--shape", a->shape, "onnx: this shape");
  c->add_flag("--code-input", a->code_input, "onnx: the shared decoder, with the code as second input");
  c->add_flag("--force", a->force, "Replace an existing output file");
  c->callback([a, &chosen] { chosen = [a] { return export_model(*a); }; });
}

}  // namespace scree

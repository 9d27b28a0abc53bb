// shape_inspect.cpp: `scree-shape inspect`: print certificates, and measure them from phi.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "shapes/certify_phi.h"
#include "shapes/model_file.h"
#include "tools/certificate_table.h"
#include "tools/guarded.h"
#include "tools/shape_commands.h"
#include "tools/shape_input.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct InspectArguments {
  fs::path file;
  std::string shape;  // only this one; empty: all
  bool write = false;
  CertifyPhiOptions options{.threads = 2};
};

void print_networks(Library const& library) {
  for (std::size_t k = 0; k < library.net.size(); ++k) {
    std::string width;
    for (int w : library.net[k].width) width += (width.empty() ? "" : "-") + std::to_string(w);
    fmt::print("network {}: {} {} ({:g})\n", k, width, to_string(library.net[k].activation), library.net[k].parameter);
  }
}

std::vector<Shape*> chosen_shapes(Library& library, InspectArguments const& a) {
  std::vector<Shape*> chosen;
  for (Shape& shape : library.shape)
    if (a.shape.empty() || shape.name == a.shape) chosen.push_back(&shape);
  if (chosen.empty()) throw std::invalid_argument(a.file.string() + " has no shape '" + a.shape + "'");
  return chosen;
}

std::vector<Shape> copies(std::vector<Shape*> const& shapes) {
  std::vector<Shape> out;
  for (Shape const* s : shapes) out.push_back(*s);
  return out;
}

int inspect(InspectArguments const& a) {
  Library library = read_input([&] { return read_model(a.file); });
  std::vector<Shape*> const chosen = chosen_shapes(library, a);
  print_networks(library);
  fmt::print("\ncertificate (-: not measured; normals in degrees)\n{}\n{}", error_table(copies(chosen)),
             phi_table(copies(chosen)));
  std::set<std::string> makers;
  for (Shape const* s : chosen)
    if (!s->certificate.made_with.empty()) makers.insert(s->certificate.made_with);
  for (std::string const& maker : makers) fmt::print("made with {}\n", maker);

  for (Shape* s : chosen) certify_phi(library, *s, a.options, s->certificate);
  fmt::print("\nmeasured now from phi\n{}", phi_table(copies(chosen)));
  if (!a.write) return exit_ok;
  write_model(a.file, library, true);
  fmt::print("{}: certificates of {} shapes written\n", a.file.string(), chosen.size());
  return exit_ok;
}

}  // namespace

void add_inspect(CLI::App& app, std::function<int()>& chosen) {
  auto const a = std::make_shared<InspectArguments>();
  CLI::App* const c = app.add_subcommand("inspect", "Print certificates; measure gradients, interior, parts and nodes");
  c->add_option("file", a->file, "Model file (.h5)")->required();
  c->add_option("--shape", a->shape, "Only this shape");
  c->add_flag("--write", a->write, "Write what was measured into the file, for the gate of `scree run`");
  c->add_option("--nodes", a->options.nodes, "Surface nodes to measure")
      ->check(CLI::Range(4, 1000000))
      ->capture_default_str();
  c->add_option("--threads", a->options.threads, "CPU threads")->check(CLI::Range(1, 256))->capture_default_str();
  c->callback([a, &chosen] { chosen = [a] { return inspect(*a); }; });
}

}  // namespace scree

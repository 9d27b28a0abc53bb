// model_content.cpp: the layout of a model file, written and read side by side.
//   /            format version sign unit shapes
//   /net/<k>     activation parameter; w0..wL f4 [in, out], b0..bL f4 [out]
//   /codes       f4 [coded shapes, longest code]; a row's tail beyond its network's code size is zero
//   /harmonics /mesh /grid     model_parts.h; a file with none of them is of version 1
//   /shape/<name>              index (order in the library), kind, what the kind needs, mass and bounds
//   /shape/<name>/certificate  one attribute a figure
// SPDX-License-Identifier: Apache-2.0
#include "shapes/model_content.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "shapes/model_parts.h"

namespace scree {
namespace {

char constexpr certificate_group[] = "certificate";

void write_value(hid_t at, char const* name, double value) { hdf5::write_attribute(at, name, &value, 1); }
void write_value(hid_t at, char const* name, int value) { hdf5::write_attribute(at, name, std::int64_t{value}); }
void write_value(hid_t at, char const* name, std::int64_t value) { hdf5::write_attribute(at, name, value); }
void write_value(hid_t at, char const* name, std::string const& value) { hdf5::write_attribute(at, name, value); }
void write_value(hid_t at, char const* name, Vec3 value) { hdf5::write_attribute(at, name, &value.x, 3); }

void read_value(hid_t at, char const* name, double& value) { value = hdf5::read_doubles(at, name, 1)[0]; }
void read_value(hid_t at, char const* name, std::int64_t& value) { value = hdf5::read_integer(at, name); }
void read_value(hid_t at, char const* name, std::string& value) { value = hdf5::read_string(at, name); }
void read_value(hid_t at, char const* name, int& value) {
  std::int64_t const wide = hdf5::read_integer(at, name);
  if (wide < -(1 << 24) || wide > 1 << 24)
    throw std::runtime_error("attribute '" + std::string(name) + "' is out of range");
  value = static_cast<int>(wide);
}
void read_value(hid_t at, char const* name, Vec3& value) {
  std::vector<double> const v = hdf5::read_doubles(at, name, 3);
  value = {v[0], v[1], v[2]};
}

// "w0", "b3": datasets of a network.
std::string layer_name(char letter, int layer) { return std::string(1, letter).append(std::to_string(layer)); }

void write_net(hid_t file, int k, Mlp const& net) {
  hdf5::Handle const group = hdf5::create_group(file, "/net/" + std::to_string(k));
  write_value(group, "activation", std::string(to_string(net.activation)));
  write_value(group, "parameter", net.parameter);
  for (int l = 0; l < net.layers(); ++l) {
    hdf5::write_floats(group, layer_name('w', l).c_str(), {net.weight[l], net.width[l], net.width[l + 1]});
    hdf5::write_floats(group, layer_name('b', l).c_str(), {net.bias[l], net.width[l + 1], -1});
  }
}

Mlp read_net(hid_t file, int k) {
  std::string const path = "/net/" + std::to_string(k);
  try {
    hdf5::Handle const group = hdf5::open_group(file, path);
    Mlp net;
    net.activation = activation_from_string(hdf5::read_string(group, "activation"));
    read_value(group, "parameter", net.parameter);
    for (int l = 0; hdf5::has_dataset(group, layer_name('w', l).c_str()); ++l) {
      hdf5::FloatArray weight = hdf5::read_floats(group, layer_name('w', l).c_str(), 2);
      hdf5::FloatArray bias = hdf5::read_floats(group, layer_name('b', l).c_str(), 1);
      if (l == 0) net.width.push_back(weight.rows);
      if (weight.rows != net.width.back())
        throw std::runtime_error("layer " + std::to_string(l) + " takes " + std::to_string(weight.rows) +
                                 " inputs, the layer before gives " + std::to_string(net.width.back()));
      net.width.push_back(weight.columns);
      net.weight.push_back(std::move(weight.value));
      net.bias.push_back(std::move(bias.value));
    }
    return net;
  } catch (std::exception const& e) {
    throw std::runtime_error(path + ": " + e.what());
  }
}

bool has_query(ShapeKind kind) { return kind == ShapeKind::net || kind == ShapeKind::harmonics; }

void write_shape(hid_t file, int index, int code_row, Shape const& s) {
  hdf5::Handle const group = hdf5::create_group(file, "/shape/" + s.name);
  write_value(group, "index", index);
  bool const analytic = s.kind == ShapeKind::analytic;
  write_value(group, "kind", std::string(analytic ? to_string(s.analytic.kind) : to_string(s.kind)));
  if (analytic) {
    write_value(group, "half_size", s.analytic.half_size);
    write_value(group, "exponent_ns", s.analytic.exponent_ns);
    write_value(group, "exponent_ew", s.analytic.exponent_ew);
  } else if (s.is_net()) {
    write_value(group, "net", s.net);
    write_value(group, "code", code_row);
  } else {
    write_value(group, "data", s.data);
  }
  if (has_query(s.kind)) {
    hdf5::write_attribute(group, "query_rotation", &s.query.rotation.row[0].x, 9);
    write_value(group, "query_shift", s.query.shift);
    write_value(group, "query_scale", s.query.scale);
  }
  write_value(group, "volume", s.volume);
  write_value(group, "area", s.area);
  write_value(group, "inertia", s.inertia);
  write_value(group, "bounding_radius", s.bounding_radius);
  write_value(group, "box_min", s.box.min);
  write_value(group, "box_max", s.box.max);
  write_value(group, "lipschitz", s.lipschitz);
  hdf5::Handle const certificate = hdf5::create_group(file, "/shape/" + s.name + "/" + certificate_group);
  for_each_figure(s.certificate, [&](char const* name, auto const& value) { write_value(certificate, name, value); });
}
static_assert(sizeof(Mat3) == 9 * sizeof(double), "query_rotation is written as nine numbers");

std::vector<float> read_code(hdf5::FloatArray const& codes, int row, int size) {
  if (size <= 0) return {};
  if (row < 0 || row >= codes.rows)
    throw std::runtime_error("attribute 'code' = " + std::to_string(row) + ", but /codes has " +
                             std::to_string(codes.rows) + " rows");
  if (size > codes.columns)
    throw std::runtime_error("its network takes a code of " + std::to_string(size) + " numbers, /codes has " +
                             std::to_string(codes.columns));
  auto const first = codes.value.begin() + std::size_t(row) * codes.columns;
  return {first, first + size};
}

Shape read_shape(hid_t group, std::string const& name, hdf5::FloatArray const& codes, std::vector<Mlp> const& nets) {
  Shape s;
  s.name = name;
  std::string const kind = hdf5::read_string(group, "kind");
  for (ShapeKind k : {ShapeKind::net, ShapeKind::harmonics, ShapeKind::mesh, ShapeKind::grid})
    if (kind == to_string(k)) s.kind = k;
  if (s.is_net()) {
    read_value(group, "net", s.net);
    if (s.net < 0 || s.net >= static_cast<int>(nets.size()))
      throw std::runtime_error("attribute 'net' = " + std::to_string(s.net) + ", but the file has " +
                               std::to_string(nets.size()) + " networks");
    int row = -1;
    read_value(group, "code", row);
    s.code = read_code(codes, row, nets[s.net].code_size());
  } else if (s.kind != ShapeKind::analytic) {
    read_value(group, "data", s.data);
  } else {
    s.analytic.kind = analytic_kind_from_string(kind);
    read_value(group, "half_size", s.analytic.half_size);
    read_value(group, "exponent_ns", s.analytic.exponent_ns);
    read_value(group, "exponent_ew", s.analytic.exponent_ew);
  }
  if (has_query(s.kind)) {
    std::vector<double> const r = hdf5::read_doubles(group, "query_rotation", 9);
    s.query.rotation = {{{r[0], r[1], r[2]}, {r[3], r[4], r[5]}, {r[6], r[7], r[8]}}};
    read_value(group, "query_shift", s.query.shift);
    read_value(group, "query_scale", s.query.scale);
  }
  read_value(group, "volume", s.volume);
  read_value(group, "area", s.area);
  read_value(group, "inertia", s.inertia);
  read_value(group, "bounding_radius", s.bounding_radius);
  read_value(group, "box_min", s.box.min);
  read_value(group, "box_max", s.box.max);
  read_value(group, "lipschitz", s.lipschitz);
  hdf5::Handle const certificate = hdf5::open_group(group, certificate_group);
  // Files written before an entry existed stay readable: it was not measured.
  for_each_figure(s.certificate, [&](char const* entry, auto& value) {
    if (hdf5::has_attribute(certificate, entry)) read_value(certificate, entry, value);
  });
  return s;
}

// Every group below /shape that has an "index" is a shape; the others are parts of names with slashes.
// Links can make circles: `seen` holds the addresses of the groups that were visited.
void read_shapes(hid_t parent, std::string const& prefix, hdf5::FloatArray const& codes, std::set<haddr_t>& seen,
                 Library& library) {
  for (std::string const& child : hdf5::group_names(parent)) {
    std::string const name = prefix + child;
    hdf5::Handle const group = hdf5::open_group(parent, child);
    if (!seen.insert(hdf5::address(group)).second) throw std::runtime_error("/shape/" + name + ": is linked twice");
    if (hdf5::has_attribute(group, "index")) {
      try {
        int index = -1;
        read_value(group, "index", index);
        if (index < 0 || index >= static_cast<int>(library.shape.size()) || !library.shape[index].name.empty())
          throw std::runtime_error("attribute 'index' = " + std::to_string(index) + " is out of range or taken");
        library.shape[index] = read_shape(group, name, codes, library.net);
      } catch (std::exception const& e) {
        throw std::runtime_error("/shape/" + name + ": " + e.what());
      }
    }
    if (child != certificate_group) read_shapes(group, name + "/", codes, seen, library);
  }
}

}  // namespace

int model_version(Library const& library) { return has_model_parts(library) ? 2 : 1; }

void write_model_content(hid_t file, Library const& library) {
  write_value(file, "format", std::string(model_format));
  write_value(file, "version", model_version(library));
  write_value(file, "sign", std::string("positive_inside"));
  write_value(file, "unit", std::string("d"));
  write_value(file, "nets", static_cast<int>(library.net.size()));
  write_value(file, "shapes", static_cast<int>(library.shape.size()));
  for (std::size_t k = 0; k < library.net.size(); ++k) write_net(file, static_cast<int>(k), library.net[k]);
  write_model_parts(file, library);
  hdf5::FloatArray codes;
  codes.columns = 0;
  for (Shape const& s : library.shape) codes.columns = std::max(codes.columns, static_cast<int>(s.code.size()));
  for (std::size_t i = 0; i < library.shape.size(); ++i) {
    Shape const& s = library.shape[i];
    write_shape(file, static_cast<int>(i), s.code.empty() ? -1 : codes.rows, s);
    if (s.code.empty()) continue;
    codes.value.insert(codes.value.end(), s.code.begin(), s.code.end());
    codes.value.resize(std::size_t(++codes.rows) * codes.columns);
  }
  if (codes.rows > 0) hdf5::write_floats(file, "codes", codes);
}

Library read_model_content(hid_t file) {
  if (hdf5::read_string(file, "sign") != "positive_inside" || hdf5::read_string(file, "unit") != "d")
    throw std::runtime_error("its sign convention or unit is not ours (positive_inside, d)");
  int nets = 0, shapes = 0;
  read_value(file, "nets", nets);
  read_value(file, "shapes", shapes);
  if (nets < 0 || shapes < 0 || nets > 1 << 20 || shapes > 1 << 20)
    throw std::runtime_error("its counts are out of range");
  Library library;
  for (int k = 0; k < nets; ++k) library.net.push_back(read_net(file, k));
  read_model_parts(file, library);
  hdf5::FloatArray codes;
  if (hdf5::has_dataset(file, "codes")) codes = hdf5::read_floats(file, "codes", 2);
  library.shape.resize(static_cast<std::size_t>(shapes));
  std::set<haddr_t> seen;
  if (shapes > 0) read_shapes(hdf5::open_group(file, "/shape"), "", codes, seen, library);
  return library;
}

}  // namespace scree

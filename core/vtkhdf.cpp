// vtkhdf.cpp: see vtkhdf.h. Format: VTK's documentation, "VTKHDF file format", sections on PolyData and temporal data.
// SPDX-License-Identifier: Apache-2.0
#include "core/vtkhdf.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <stdexcept>

#include "core/paraview.h"
#include "core/results_hdf5.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using results_hdf5::Series;
using results_hdf5::write_array;

// In the order of the columns of CellOffsets; ours are all vertices.
std::array<char const*, 4> constexpr topologies{"Vertices", "Lines", "Polygons", "Strips"};

// value of each of `body`.
template <class T>
std::vector<T> picked(std::vector<T> const& value, std::vector<std::int32_t> const& body) {
  std::vector<T> out;
  for (std::int32_t const b : body) out.push_back(value[static_cast<std::size_t>(b)]);
  return out;
}

// Of Vec3 and Quat, which lie in memory as they are written.
template <class V>
double const* numbers(std::vector<V> const& value) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Quat) == 4 * sizeof(double));
  return reinterpret_cast<double const*>(value.data());
}

// The reader accepts no UTF-8 here and no number where the format has two.
void write_format(hid_t root) {
  std::string const type = "PolyData";
  hdf5::Handle const text(H5Tcopy(H5T_C_S1), H5Tclose, "cannot make a string type");
  if (H5Tset_size(text, type.size()) < 0 || H5Tset_strpad(text, H5T_STR_NULLPAD) < 0)
    throw hdf5::Error("cannot make a string type");
  hdf5::Handle const scalar(H5Screate(H5S_SCALAR), H5Sclose, "cannot make a data space");
  hdf5::Handle const named(H5Acreate2(root, "Type", text, scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                           "cannot create attribute Type");
  std::array<std::int64_t, 2> const version{2, 0};
  hsize_t const two = version.size();
  hdf5::Handle const pair(H5Screate_simple(1, &two, nullptr), H5Sclose, "cannot make a data space");
  hdf5::Handle const numbered(H5Acreate2(root, "Version", H5T_STD_I64LE, pair, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                              "cannot create attribute Version");
  if (H5Awrite(named, text, type.data()) < 0 || H5Awrite(numbered, H5T_NATIVE_INT64, version.data()) < 0)
    throw hdf5::Error("cannot write the attributes of the format");
}

}  // namespace

struct VtkhdfWriter::Data {
  // A set of bodies that are there in one frame or in several that follow one another.
  struct Part {
    std::int64_t first = 0;  // row of what does not move, number of cells before
    std::int64_t count = 0;
  };
  struct Step {
    double time = 0;         // [s]
    int part = 0;            // -1: of frames without a grain
    std::int64_t first = 0;  // row of what moves
  };
  fs::path final_name, temporary;
  ResultsHeader header;
  std::vector<std::int32_t> kind;
  hdf5::Handle file, root, vertices, point_data;
  Series<double> position, orientation, velocity, spin, diameter;
  Series<std::int32_t> body, shape, kind_series, material, group, replica;
  Series<std::int64_t> connectivity, offsets;
  std::vector<std::int32_t> present;  // bodies of the last part
  std::vector<Part> part;
  std::vector<Step> step;

  Data(fs::path const& name, ResultsHeader const& h);
  ~Data();
  void write_part();
  void write_frame(Frame const& frame);
  void write_parts();
  void write_steps();

  // HDF5's complaints with the file's name, as one type.
  template <class Work>
  void guarded(Work const& work) const {
    hdf5::write_guarded(final_name.string(), work);
  }
};

VtkhdfWriter::Data::Data(fs::path const& name, ResultsHeader const& h)
    : final_name(name), temporary(name.string() + ".partial"), header(h), kind(kind_of_bodies(h)) {
  // No user block: the file is not one of ours, and begins as HDF5 files do.
  file = {H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose,
          "cannot be created; is the folder writable?"};
  root = hdf5::create_group(file, "/VTKHDF");
  vertices = hdf5::create_group(root, "Vertices");
  point_data = hdf5::create_group(root, "PointData");
  write_format(root);
  // A chunk a frame of all bodies, within what keeps small files small and chunks of many frames apart.
  hsize_t const chunk = std::clamp<hsize_t>(h.shape.size(), 64, 65536);
  position = {root, "Points", {3}, chunk};
  if (H5Lcreate_hard(root, "Points", point_data, "position", H5P_DEFAULT, H5P_DEFAULT) < 0)
    throw hdf5::Error("cannot name the points 'position'");
  orientation = {point_data, "orientation", {4}, chunk};
  velocity = {point_data, "velocity", {3}, chunk};
  spin = {point_data, "spin", {3}, chunk};
  diameter = {point_data, "diameter", {}, chunk};
  body = {point_data, "body", {}, chunk};
  shape = {point_data, "shape", {}, chunk};
  kind_series = {point_data, "kind", {}, chunk};
  material = {point_data, "material", {}, chunk};
  group = {point_data, "group", {}, chunk};
  replica = {point_data, "replica", {}, chunk};
  connectivity = {vertices, "Connectivity", {}, chunk};
  offsets = {vertices, "Offsets", {}, chunk};
}

VtkhdfWriter::Data::~Data() {
  std::error_code ignored;
  fs::remove(temporary, ignored);  // there only if something went wrong
}

// What does not move of the bodies that are present: a row each; and a cell each, which is its point.
void VtkhdfWriter::Data::write_part() {
  hsize_t const n = present.size();
  part.push_back({static_cast<std::int64_t>(body.rows()), static_cast<std::int64_t>(n)});
  body.append(present.data(), n);
  shape.append(picked(header.shape, present).data(), n);
  kind_series.append(picked(kind, present).data(), n);
  material.append(picked(header.material, present).data(), n);
  group.append(picked(header.group, present).data(), n);
  replica.append(picked(header.replica, present).data(), n);
  diameter.append(picked(header.diameter, present).data(), n);
  std::vector<std::int64_t> count(n + 1);
  std::iota(count.begin(), count.end(), 0);
  connectivity.append(count.data(), n);
  offsets.append(count.data(), n + 1);
}

void VtkhdfWriter::Data::write_frame(Frame const& frame) {
  std::vector<std::int32_t> active;
  for (std::size_t i = 0; i < header.shape.size(); ++i)
    if (frame.is_active(i)) active.push_back(static_cast<std::int32_t>(i));
  if (!active.empty() && active != present) {
    present = active;
    write_part();
  }
  step.push_back({frame.time, active.empty() ? -1 : static_cast<int>(part.size()) - 1,
                  static_cast<std::int64_t>(position.rows())});
  hsize_t const n = active.size();
  position.append(numbers(picked(frame.position, active)), n);
  orientation.append(numbers(picked(frame.orientation, active)), n);
  velocity.append(numbers(picked(frame.velocity, active)), n);
  spin.append(numbers(picked(frame.spin, active)), n);
}

void VtkhdfWriter::Data::write_parts() {
  // One part for all empty frames, behind all others: VTK 9.7 finds the offsets of a part by counting cells of those
  // before, and is wrong by one behind a part that has none.
  if (std::any_of(step.begin(), step.end(), [](Step const& s) { return s.part < 0; })) {
    for (Step& s : step)
      if (s.part < 0) s.part = static_cast<int>(part.size());
    present.clear();
    write_part();
  }
  std::vector<std::int64_t> count;
  for (Part const& p : part) count.push_back(p.count);
  std::vector<std::int64_t> const none(part.size(), 0);
  results_hdf5::Extent const parts{part.size()};
  write_array(root, "NumberOfPoints", count.data(), parts);
  for (char const* name : topologies) {
    bool const ours = name == topologies[0];
    hdf5::Handle const at = hdf5::create_group(root, name);
    write_array(at, "NumberOfCells", (ours ? count : none).data(), parts);
    write_array(at, "NumberOfConnectivityIds", (ours ? count : none).data(), parts);
    if (ours) continue;
    write_array(at, "Offsets", none.data(), parts);  // a part of n cells has n + 1
    write_array(at, "Connectivity", none.data(), {0});
  }
}

void VtkhdfWriter::Data::write_steps() {
  std::vector<double> time;
  std::vector<std::int64_t> first_part, one, moving, constant, cells;
  for (Step const& s : step) {
    time.push_back(s.time);
    first_part.push_back(s.part);
    one.push_back(1);
    moving.push_back(s.first);
    constant.push_back(part[static_cast<std::size_t>(s.part)].first);
    cells.insert(cells.end(), {constant.back(), 0, 0, 0});
  }
  results_hdf5::Extent const steps{step.size()}, by_topology{step.size(), topologies.size()};
  hdf5::Handle const at = hdf5::create_group(root, "Steps");
  hdf5::write_attribute(at, "NSteps", static_cast<std::int64_t>(step.size()));
  write_array(at, "Values", time.data(), steps);
  write_array(at, "PartOffsets", first_part.data(), steps);
  write_array(at, "NumberOfParts", one.data(), steps);
  write_array(at, "PointOffsets", moving.data(), steps);
  write_array(at, "CellOffsets", cells.data(), by_topology);
  write_array(at, "ConnectivityIdOffsets", cells.data(), by_topology);  // a vertex has one
  hdf5::Handle const fields = hdf5::create_group(at, "PointDataOffsets");
  for (char const* name : {"position", "orientation", "velocity", "spin"})
    write_array(fields, name, moving.data(), steps);
  for (char const* name : {"diameter", "body", "shape", "kind", "material", "group", "replica"})
    write_array(fields, name, constant.data(), steps);
}

VtkhdfWriter::VtkhdfWriter(fs::path const& file, ResultsHeader const& header) {
  hdf5::write_guarded(file.string(), [&] { data_ = std::make_unique<Data>(file, header); });
}

VtkhdfWriter::~VtkhdfWriter() = default;

void VtkhdfWriter::write_frame(Frame const& frame) {
  data_->guarded([&] { data_->write_frame(frame); });
}

void VtkhdfWriter::finish() {
  Data& d = *data_;
  d.guarded([&] {
    d.write_parts();
    d.write_steps();
    // HDF5 writes a file when its last object is closed.
    for (Series<double>* s : {&d.position, &d.orientation, &d.velocity, &d.spin, &d.diameter}) *s = {};
    for (Series<std::int32_t>* s : {&d.body, &d.shape, &d.kind_series, &d.material, &d.group, &d.replica}) *s = {};
    for (Series<std::int64_t>* s : {&d.connectivity, &d.offsets}) *s = {};
    for (hdf5::Handle* handle : {&d.vertices, &d.point_data, &d.root}) *handle = {};
    d.file.close("cannot be written");
    fs::rename(d.temporary, d.final_name);
  });
}

}  // namespace scree

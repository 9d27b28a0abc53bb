// results_writer.cpp: the results file as a run writes it; the layout is listed in core/README.md.
// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "core/results.h"
#include "core/results_hdf5.h"
#include "core/results_layout.h"
#include "core/results_walls.h"
#include "shapes/file_container.h"
#include "shapes/model_file.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using results_hdf5::Series;
using results_hdf5::write_array;
using results_hdf5::write_text;
using results_hdf5::write_texts;

// The shapes used, as a whole model file inside the results file: one format, one reader, one set of checks.
std::vector<std::uint8_t> model_bytes(Library const& library, fs::path const& beside) {
  fs::path const temporary = beside.string() + ".model";
  write_model(temporary, library, true);
  std::ifstream stream(temporary, std::ios::binary);
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(stream), {}};
  stream.close();
  fs::remove(temporary);
  return bytes;
}

void write_header(hid_t file, ResultsHeader const& h, fs::path const& temporary) {
  hdf5::write_attribute(file, "format", std::string(results_layout::kind));
  hdf5::write_attribute(file, "version", std::int64_t{results_layout::version});
  write_text(file, "case", h.case_text);
  write_texts(file, "shape_name", h.shape_name);
  if (!h.library.shape.empty()) {
    std::vector<std::uint8_t> const bytes = model_bytes(h.library, temporary);
    write_array(file, "model", bytes.data(), {bytes.size()});
  }
  hdf5::Handle const bodies = hdf5::create_group(file, "/bodies");
  results_hdf5::Extent const n{h.shape.size()};
  write_array(bodies, "shape", h.shape.data(), n);
  write_array(bodies, "diameter", h.diameter.data(), n);
  write_array(bodies, "material", h.material.data(), n);
  write_array(bodies, "group", h.group.data(), n);
  write_array(bodies, "replica", h.replica.data(), n);
  if (!h.world.empty()) write_array(bodies, "world", h.world.data(), n);
  write_walls(file, h.wall);
  write_wall_bodies(file, h.wall_body);
  write_array(file, "domain", &h.domain.min.x, {2, 3});
  std::vector<std::string> column;
  for (results_layout::LedgerColumn const& c : results_layout::columns_with(h.ledger)) column.push_back(c.name);
  write_texts(file, "ledger_columns", column);
}

void check_header(ResultsHeader const& h) {
  std::size_t const n = h.shape.size();
  if (h.diameter.size() != n || h.material.size() != n || h.group.size() != n || h.replica.size() != n ||
      (!h.world.empty() && h.world.size() != n))
    throw std::invalid_argument("ResultsWriter: arrays of the header differ in length");
  if (h.shape_name.size() != h.library.shape.size())
    throw std::invalid_argument("ResultsWriter: shape_name and library.shape differ in length");
}

}  // namespace

struct ResultsWriter::Data {
  fs::path final_name, temporary;
  std::size_t bodies = 0;
  std::vector<results_layout::LedgerColumn> column;  // of the ledger
  hdf5::Handle file;
  hdf5::Handle frames;
  Series<double> time, position, orientation, velocity, spin, ledger;
  Series<std::int64_t> step;
  std::optional<Series<std::uint8_t>> activity;
  std::size_t moving = 0;  // wall bodies
  std::optional<Series<double>> wall_position, wall_orientation;

  Data(fs::path const& name, ResultsHeader const& header)
      : final_name(name),
        temporary(name.string() + ".partial"),
        bodies(header.shape.size()),
        column(results_layout::columns_with(header.ledger)) {
    hsize_t const n = bodies;
    fs::remove(temporary);
    file = hdf5::create_file(temporary.string());
    write_header(file, header, temporary);
    frames = hdf5::create_group(file, "/frames");
    time = {frames, "time", {}};
    step = {frames, "step", {}};
    position = {frames, "position", {n, 3}};
    orientation = {frames, "orientation", {n, 4}};
    velocity = {frames, "velocity", {n, 3}};
    spin = {frames, "spin", {n, 3}};
    if (header.activity) activity.emplace(frames, "activity", results_hdf5::Extent{n});
    moving = moving_walls(header);
    if (moving > 0) {
      wall_position.emplace(frames, "wall_position", results_hdf5::Extent{moving, 3});
      wall_orientation.emplace(frames, "wall_orientation", results_hdf5::Extent{moving, 4});
    }
    ledger = {file, "ledger", {column.size()}};
    flush();
  }

  // After this a killed run loses nothing that was written before.
  void flush() {
    if (H5Fflush(file, H5F_SCOPE_GLOBAL) < 0) throw hdf5::Error("cannot be written");
  }

  // HDF5's and the container's complaints with the file's name, as one type.
  template <class Work>
  void guarded(Work const& work) const {
    hdf5::write_guarded(final_name.string(), work);
  }
};

ResultsWriter::ResultsWriter(fs::path const& file, ResultsHeader const& header) {
  check_header(header);
  hdf5::write_guarded(file.string(), [&] { data_ = std::make_unique<Data>(file, header); });
}

ResultsWriter::~ResultsWriter() = default;

void ResultsWriter::write_frame(Frame const& frame) {
  Data& d = *data_;
  if (frame.position.size() != d.bodies || frame.orientation.size() != d.bodies || frame.velocity.size() != d.bodies ||
      frame.spin.size() != d.bodies || (d.activity && frame.activity.size() != d.bodies))
    throw std::invalid_argument("write_frame: the frame does not have the header's number of bodies");
  if (frame.wall_position.size() != d.moving || frame.wall_orientation.size() != d.moving)
    throw std::invalid_argument("write_frame: the frame does not have the header's number of moving walls");
  d.guarded([&] {
    d.position.append(reinterpret_cast<double const*>(frame.position.data()));
    d.orientation.append(reinterpret_cast<double const*>(frame.orientation.data()));
    d.velocity.append(reinterpret_cast<double const*>(frame.velocity.data()));
    d.spin.append(reinterpret_cast<double const*>(frame.spin.data()));
    if (d.activity) d.activity->append(reinterpret_cast<std::uint8_t const*>(frame.activity.data()));
    if (d.moving > 0) {
      d.wall_position->append(reinterpret_cast<double const*>(frame.wall_position.data()));
      d.wall_orientation->append(reinterpret_cast<double const*>(frame.wall_orientation.data()));
    }
    d.step.append(&frame.step);
    d.time.append(&frame.time);
    d.flush();
  });
}

void ResultsWriter::write_ledger(LedgerRow const& row) {
  data_->guarded([&] {
    std::vector<double> value;
    for (results_layout::LedgerColumn const& c : data_->column) value.push_back(row.*c.value);
    data_->ledger.append(value.data());
  });
}

void ResultsWriter::write_measures(std::vector<MeasureSummary> const& measures) {
  if (measures.empty()) return;
  data_->guarded([&] {
    std::vector<std::string> name, unit;
    std::vector<std::int64_t> windowed, samples;
    std::vector<double> value;
    for (MeasureSummary const& m : measures) {
      name.push_back(m.name);
      unit.push_back(m.unit);
      windowed.push_back(m.windowed);
      samples.push_back(m.samples);
      value.insert(value.end(), {m.mean, m.spread, m.last});
    }
    hdf5::Handle const group = hdf5::create_group(data_->file, "/measures");
    write_texts(group, "name", name);
    write_texts(group, "unit", unit);
    write_array(group, "windowed", windowed.data(), {measures.size()});
    write_array(group, "samples", samples.data(), {measures.size()});
    write_array(group, "value", value.data(), {measures.size(), 3});  // mean, spread, last
  });
}

void ResultsWriter::finish(std::vector<StageRow> const& stages) {
  Data& d = *data_;
  d.guarded([&] {
    std::vector<std::string> name;
    std::vector<double> seconds;
    std::vector<std::int64_t> calls, items;
    for (StageRow const& s : stages) {
      name.push_back(s.name);
      seconds.push_back(s.seconds);
      calls.push_back(s.calls);
      items.push_back(s.items);
    }
    {
      hdf5::Handle const group = hdf5::create_group(d.file, "/stages");
      write_texts(group, "name", name);
      write_array(group, "seconds", seconds.data(), {stages.size()});
      write_array(group, "calls", calls.data(), {stages.size()});
      write_array(group, "items", items.data(), {stages.size()});
    }
    for (Series<double>* series : {&d.time, &d.position, &d.orientation, &d.velocity, &d.spin, &d.ledger}) *series = {};
    d.step = {};
    d.activity.reset();
    d.wall_position.reset();
    d.wall_orientation.reset();
    d.frames = {};
    d.file.close("cannot be written");
    seal_container(d.temporary, d.final_name, results_layout::kind, results_layout::version);
  });
}

}  // namespace scree

// results_reader.cpp: the results file as render, export and tests read it.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/case.h"
#include "core/results.h"
#include "core/results_hdf5.h"
#include "core/results_layout.h"
#include "core/results_walls.h"
#include "shapes/file_container.h"
#include "shapes/model_file.h"

namespace scree {
namespace {

namespace fs = std::filesystem;
using results_hdf5::read_array;

Library read_library(hid_t file) {
  if (!hdf5::has_dataset(file, "model")) return {};
  return read_model("/model", read_array<std::uint8_t>(file, "model"));
}

ResultsHeader read_header(hid_t file) {
  ResultsHeader h;
  h.case_text = results_hdf5::read_text(file, "case");
  h.shape_name = results_hdf5::read_texts(file, "shape_name");
  h.library = read_library(file);
  hdf5::Handle const bodies = hdf5::open_group(file, "/bodies");
  h.shape = read_array<int>(bodies, "shape");
  h.diameter = read_array<double>(bodies, "diameter");
  h.material = read_array<int>(bodies, "material");
  h.group = read_array<int>(bodies, "group");
  h.replica = read_array<int>(bodies, "replica");
  if (hdf5::has_dataset(bodies, "world")) h.world = read_array<int>(bodies, "world");
  std::size_t const n = h.shape.size();
  bool const same = h.diameter.size() == n && h.material.size() == n && h.group.size() == n && h.replica.size() == n &&
                    (h.world.empty() || h.world.size() == n);
  int const shapes = static_cast<int>(h.library.shape.size());
  bool const known = std::all_of(h.shape.begin(), h.shape.end(), [&](int s) { return s >= 0 && s < shapes; });
  if (!same || !known || h.shape_name.size() != h.library.shape.size())
    throw std::runtime_error("/bodies contradicts itself");
  h.wall = read_walls(file);
  h.wall_body = read_wall_bodies(file);
  auto const domain = results_hdf5::as_vectors<Vec3>(read_array<double>(file, "domain", {3}));
  if (domain.size() != 2) throw std::runtime_error("dataset 'domain' must hold two corners");
  h.domain = {domain[0], domain[1]};
  if (hdf5::has_dataset(file, "ledger_columns"))
    h.ledger = results_hdf5::read_texts(file, "ledger_columns");
  else
    h.ledger.assign(results_layout::unnamed_columns.begin(), results_layout::unnamed_columns.end());
  return h;
}

}  // namespace

struct ResultsReader::Data {
  fs::path name;  // as the user gave it, for messages
  hdf5::Handle file;
  ResultsHeader header;
  int frames = 0;

  void open(fs::path const& path) {
    file = hdf5::open_file(path.string());
    header = read_header(file);
    hdf5::Handle const group = hdf5::open_group(file, "/frames");
    header.activity = hdf5::has_dataset(group, "activity");
    hsize_t const n = header.shape.size();
    auto const rows = [&](char const* dataset, results_hdf5::Extent const& inner) {
      return results_hdf5::checked_rows(results_hdf5::open_dataset(group, dataset), dataset, inner);
    };
    // A run killed between two arrays of one frame leaves some of them longer: that frame does not count.
    frames = static_cast<int>(std::min({rows("time", {}), rows("step", {}), rows("position", {n, 3}),
                                        rows("orientation", {n, 4}), rows("velocity", {n, 3}), rows("spin", {n, 3})}));
    if (header.activity) frames = std::min(frames, static_cast<int>(rows("activity", {n})));
    if (hsize_t const m = moving_walls(header))
      frames = std::min({frames, static_cast<int>(rows("wall_position", {m, 3})),
                         static_cast<int>(rows("wall_orientation", {m, 4}))});
  }

  template <class Work>
  auto guarded(Work const& work) const {
    hdf5::QuietErrors const quiet;
    try {
      return work();
    } catch (InputError const&) {
      throw;
    } catch (std::exception const& e) {
      std::string const what = e.what();
      throw InputError({what.starts_with(name.string()) ? what : name.string() + ": " + what});
    }
  }
};

ResultsReader::ResultsReader(fs::path const& file, bool recover) : data_(std::make_unique<Data>()) {
  data_->name = file;
  data_->guarded([&] {
    fs::path const partial = file.string() + ".partial";
    std::error_code error;
    if (recover && !fs::exists(file, error) && fs::exists(partial, error)) return data_->open(partial);
    bool const unsealed = recover && file.extension() == ".partial";
    if (!unsealed && !fs::exists(file, error) && fs::exists(partial, error))
      throw std::runtime_error("the run did not finish; its frames are in " + partial.string() +
                               " (--recover reads them)");
    if (!unsealed) check_container(file, results_layout::kind, results_layout::version);
    data_->open(file);
  });
}

ResultsReader::~ResultsReader() = default;

ResultsHeader const& ResultsReader::header() const { return data_->header; }

int ResultsReader::frames() const { return data_->frames; }

Frame ResultsReader::frame(int index) const {
  Data const& d = *data_;
  int const row = index < 0 ? d.frames + index : index;
  if (row < 0 || row >= d.frames)
    throw InputError({d.name.string() + ": has no frame " + std::to_string(index) + "; it has " +
                      std::to_string(d.frames) + " (0 is the first, -1 the last)"});
  return d.guarded([&] {
    hdf5::Handle const group = hdf5::open_group(d.file, "/frames");
    std::size_t const n = d.header.shape.size();
    Frame f;
    f.position.resize(n);
    f.orientation.resize(n);
    f.velocity.resize(n);
    f.spin.resize(n);
    auto const read = [&](char const* name, results_hdf5::Extent const& inner, hid_t type, void* to) {
      results_hdf5::read_row(results_hdf5::open_dataset(group, name), name, inner, static_cast<hsize_t>(row), type, to);
    };
    read("time", {}, H5T_NATIVE_DOUBLE, &f.time);
    read("step", {}, H5T_NATIVE_INT64, &f.step);
    read("position", {n, 3}, H5T_NATIVE_DOUBLE, f.position.data());
    read("orientation", {n, 4}, H5T_NATIVE_DOUBLE, f.orientation.data());
    read("velocity", {n, 3}, H5T_NATIVE_DOUBLE, f.velocity.data());
    read("spin", {n, 3}, H5T_NATIVE_DOUBLE, f.spin.data());
    if (d.header.activity) {
      f.activity.resize(n);
      read("activity", {n}, H5T_NATIVE_UINT8, f.activity.data());
      bool const known =
          std::all_of(f.activity.begin(), f.activity.end(), [](Activity a) { return a <= Activity::deleted; });
      if (!known) throw std::runtime_error("dataset 'activity' holds a number that is none of 0, 1, 2");
    }
    if (std::size_t const m = moving_walls(d.header)) {
      f.wall_position.resize(m);
      f.wall_orientation.resize(m);
      read("wall_position", {m, 3}, H5T_NATIVE_DOUBLE, f.wall_position.data());
      read("wall_orientation", {m, 4}, H5T_NATIVE_DOUBLE, f.wall_orientation.data());
    }
    return f;
  });
}

std::vector<LedgerRow> ResultsReader::ledger() const {
  return data_->guarded([&] {
    std::vector<results_layout::LedgerColumn> const column = results_layout::columns_with(data_->header.ledger);
    std::vector<double> const flat = read_array<double>(data_->file, "ledger", {column.size()});
    std::vector<LedgerRow> rows(flat.size() / column.size());
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t k = 0; k < column.size(); ++k) rows[r].*column[k].value = flat[r * column.size() + k];
    return rows;
  });
}

std::vector<MeasureSummary> ResultsReader::measures() const {
  return data_->guarded([&] {
    std::vector<MeasureSummary> out;
    if (!hdf5::has_group(data_->file, "/measures")) return out;
    hdf5::Handle const group = hdf5::open_group(data_->file, "/measures");
    std::vector<std::string> const name = results_hdf5::read_texts(group, "name");
    std::vector<std::string> const unit = results_hdf5::read_texts(group, "unit");
    auto const windowed = read_array<std::int64_t>(group, "windowed");
    auto const samples = read_array<std::int64_t>(group, "samples");
    auto const value = read_array<double>(group, "value", {3});
    if (unit.size() != name.size() || windowed.size() != name.size() || samples.size() != name.size() ||
        value.size() != 3 * name.size())
      throw std::runtime_error("/measures: lengths differ");
    for (std::size_t i = 0; i < name.size(); ++i)
      out.push_back({name[i], unit[i], windowed[i] != 0, samples[i], value[3 * i], value[3 * i + 1], value[3 * i + 2]});
    return out;
  });
}

std::vector<StageRow> ResultsReader::stages() const {
  return data_->guarded([&] {
    std::vector<StageRow> rows;
    if (!hdf5::has_group(data_->file, "/stages")) return rows;  // a run that did not finish
    hdf5::Handle const group = hdf5::open_group(data_->file, "/stages");
    std::vector<std::string> const name = results_hdf5::read_texts(group, "name");
    auto const seconds = read_array<double>(group, "seconds");
    auto const calls = read_array<std::int64_t>(group, "calls");
    auto const items = read_array<std::int64_t>(group, "items");
    if (seconds.size() != name.size() || calls.size() != name.size() || items.size() != name.size())
      throw std::runtime_error("/stages: lengths differ");
    for (std::size_t i = 0; i < name.size(); ++i) rows.push_back({name[i], seconds[i], calls[i], items[i]});
    return rows;
  });
}

}  // namespace scree

// results.h: the results file of a run: written frame by frame, read back by render, export and tests.
// HDF5 behind the 512-byte user block of shapes/file_container.h; layout in the design's formats.md.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "kernels/base/vec.h"
#include "kernels/sdf/analytic.h"
#include "kernels/views.h"
#include "shapes/shape.h"
#include "shapes/triangle_mesh.h"

namespace scree {

struct ResultsWall {  // a plane at rest: the solid is behind it
  std::string name;
  Vec3 point, normal;  // world [m]; the normal points into the free space
  double radius = 0;   // > 0: the face of a cylinder, of which this much about the point is there to be seen [m]
};

enum class WallSolidKind { plane, bore, cylinder, box, capsule, funnel, mesh, sheet, terrain };

// A wall as a body: all walls but planes at rest. Enough to draw and to measure it without the files of the case.
struct ResultsWallBody {
  std::string name;  // of the wall in the case: a drum has a bore and two planes of its name
  WallSolidKind kind = WallSolidKind::plane;
  bool inside = false;   // grains are within it
  bool moving = false;   // frames have its pose
  AnalyticSdf formula;   // of the kinds up to funnel, body frame [m]; bore: half_size.z is what is to be seen of it
  double half_wall = 0;  // sheet: solid this far on both sides of its triangles [m]
  TriangleMesh mesh;  // body frame [m]. mesh, sheet, terrain: the surface; plane: what is to be seen of it, none: all
  Vec3 position;      // at time 0 [m]
  Quat orientation;   // body -> world at time 0
};

struct ResultsHeader {
  std::string case_text;                      // effective case, TOML
  std::vector<std::string> shape_name;        // distinct shapes used
  Library library;                            // only the shapes used, so that results render without the model file
  std::vector<int> shape;                     // of body (n): index into shape_name and library.shape
  std::vector<double> diameter;               // [m] (n)
  std::vector<int> material, group, replica;  // (n)
  std::vector<int> world;                     // bodies of different worlds never meet (n); empty: all meet
  std::vector<ResultsWall> wall;
  std::vector<ResultsWallBody> wall_body;
  Box domain;                       // of walls and initial grains, for cameras [m]
  bool activity = false;            // frames say which bodies are active
  std::vector<std::string> ledger;  // columns beyond those of every run, see results_layout.h
};

struct Frame {
  double time = 0;  // [s]
  std::int64_t step = 0;
  std::vector<Vec3> position;      // [m] (n)
  std::vector<Quat> orientation;   // body -> world (n)
  std::vector<Vec3> velocity;      // [m/s] (n)
  std::vector<Vec3> spin;          // world [rad/s] (n)
  std::vector<Activity> activity;  // (n); empty: all are active
  // Of the wall bodies that move, in the header's order: world [m], body -> world (n_moving).
  std::vector<Vec3> wall_position;
  std::vector<Quat> wall_orientation;

  bool is_active(std::size_t body) const { return activity.empty() || activity[body] == Activity::active; }
};

struct LedgerRow {  // [J]; see core/energy.h
  double time = 0, kinetic = 0, potential = 0, elastic_normal = 0, elastic_tangential = 0;
  double inserted = 0, wall_work = 0, damping = 0, friction = 0, global_damping = 0, removed = 0;
  double residual = 0, moved = 0;
  // Only where the case has the effect.
  double applied = 0;                       // work of applied forces and torques
  double drag = 0;                          // lost to drag
  double elastic_rolling = 0, rolling = 0;  // stored in and lost to rolling resistance
  double deleted = 0;                       // of bodies that were deleted
};

// A [[measure]] quantity over the run, see core/measurements.h. NaN: no value.
struct MeasureSummary {
  std::string name, unit;    // "measure.quantity"
  bool windowed = false;     // the case gives a window: the mean is what counts, else the last value
  std::int64_t samples = 0;  // in the window
  double mean = std::numeric_limits<double>::quiet_NaN();
  double spread = std::numeric_limits<double>::quiet_NaN();  // standard deviation of the samples
  double last = std::numeric_limits<double>::quiet_NaN();

  double value() const { return windowed ? mean : last; }
};

struct StageRow {
  std::string name;
  double seconds = 0;
  std::int64_t calls = 0, items = 0;
};

class ResultsWriter {
 public:
  // Creates `file` under a temporary name; finish() seals the container (CRC) and renames. A run that dies leaves the
  // temporary file, readable up to its last flushed frame with recover = true.
  // Throws std::system_error naming the path when it cannot be written.
  ResultsWriter(std::filesystem::path const& file, ResultsHeader const& header);
  ~ResultsWriter();
  void write_frame(Frame const& frame);
  void write_ledger(LedgerRow const& row);
  void write_measures(std::vector<MeasureSummary> const& measures);  // before finish(); none: nothing is written
  void finish(std::vector<StageRow> const& stages);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

class ResultsReader {
 public:
  explicit ResultsReader(std::filesystem::path const& file, bool recover = false);  // throws InputError
  ~ResultsReader();
  ResultsHeader const& header() const;
  int frames() const;
  Frame frame(int index) const;  // negative: from the end
  std::vector<LedgerRow> ledger() const;
  std::vector<StageRow> stages() const;
  std::vector<MeasureSummary> measures() const;  // empty without any, or when the run did not finish

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace scree

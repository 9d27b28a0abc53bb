// case.h: the user's words, validated: plain structs with defaults and SI units. Never changed after loading.
// Every optional key is a std::optional: an absent key is an absent effect.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/case_effects.h"
#include "core/case_measure.h"
#include "kernels/base/vec.h"
#include "kernels/contact_laws.h"
#include "kernels/network_device.h"
#include "shapes/bake.h"
#include "shapes/generate.h"

namespace scree {

// "mesh:path" in `shapes`: the path; empty for every other word.
std::filesystem::path mesh_file_of(std::string const& shape_word);

// All problems of one input at once, a line each: "file:line: key: value ... allowed ... way out".
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<std::string> found);
  std::vector<std::string> problems;
};

enum class Evaluator { net, grid, mesh, analytic };  // net: as the shape is stored
// How surface nodes are kept: positions and areas, or 16-bit radii along directions that all grains share.
enum class NodeStorage { explicit_, compact };
enum class WallKind { plane, box, cylinder, cone, capsule, mesh, terrain };
enum class MotionKind { rotation, translation };
enum class Orientation { random, aligned };

struct SettleCase {
  double damping = 5.0;             // global damping while it is on [1/s]
  double after = 0;                 // switched on at [s]
  double kinetic_per_grain = 1e-8;  // at rest when the largest kinetic energy of a grain is below this [m g d]
  double hold = 0.2;                // ... over this long with the damping released [s]
};

struct TimeCase {
  double end = 1.0;            // [s]
  std::optional<double> step;  // absent: automatic [s]
  double safety = 0.3;         // of the critical step
  std::optional<SettleCase> settle;
  bool safety_given = false;  // said by the user: [accuracy] leaves it alone
};

// Named budgets of [accuracy], see core/accuracy.h.
enum class AccuracyPreset { none, fast, balanced, reference };
double budget_of(AccuracyPreset preset);  // of a name that is one

// What is asked of forces instead of node counts and steps; core/accuracy.h turns it into them.
struct AccuracyCase {
  std::optional<double> budget;                  // relative error of the force of a contact; exactly one of this ...
  AccuracyPreset preset = AccuracyPreset::none;  // ... and a name
  std::optional<double> overlap;  // of the contacts that it holds for [d]; absent: the case's typical one

  double wanted() const { return budget ? *budget : budget_of(preset); }
};

struct LibraryCase {
  std::string name;
  std::filesystem::path file;  // resolved
};

struct MaterialCase {
  std::string name;
  double density = 2650;  // [kg/m3]
};

// Rolling resistance, elastic-plastic spring-dashpot (kernels/rolling.h).
struct RollingCase {
  double friction = 0;            // mu_r
  double stiffness_ratio = 2.25;  // k_r / (K (mu_r R_r)^2); 2.25: Ai et al. 2011 for spheres
  double damping = 0.3;           // eta_r, share of critical
};

// Adhesive traction within a range outside the surface (kernels/contact_laws.h).
struct CohesionCase {
  double traction = 0;  // [Pa]
  double range = 0;     // [m]
};

struct ContactCase {
  std::pair<std::string, std::string> pair;
  ContactLaw law = ContactLaw::winkler;
  // Normal stiffness. winkler: kappa [N/m3], or stiffness [N/m] as a secant at overlap at_overlap * d (physics.md
  // section 1), in which case kappa follows from the largest grain diameter d of the case, R* = d/4. linear: stiffness.
  std::optional<double> kappa;
  double stiffness = 2e6;
  double at_overlap = 0.01;             // linear, hertz: of the secant that scales the friction stiffness
  double tangential_ratio = 0.5;        // k_t / k_n
  std::optional<double> friction;       // absent: frictionless, no history exists
  std::optional<double> damping_ratio;  // zeta; or ...
  std::optional<double> restitution;    // ... e, mapped through the law's table
  double onset = 1e-3;                  // linear: overlap at which the pressure is reached [d of the largest grain]
  double youngs_modulus = 0;            // hertz [Pa]
  double poisson_ratio = 0;             // hertz
  std::optional<RollingCase> rolling;   // absent: none, no history exists
  std::optional<CohesionCase> cohesion;
};

struct InsertCase {
  // lattice: cell centres of a cubic lattice filling `box` from the bottom, cell = the largest bounding diameter
  // of the entry; list: explicit positions (and orientations); random: all at the start, at random places of `box`
  // where bounding spheres meet nothing; rate: the same, one after the other; file: poses from a table.
  enum class Kind { lattice, list, random, rate, file } kind = Kind::lattice;
  Box box;  // [m]
  Orientation orientation = Orientation::random;
  Vec3 velocity;                 // [m/s]
  Vec3 spin;                     // [rad/s]
  std::vector<Vec3> position;    // list: [m]
  std::vector<Quat> quaternion;  // list: as many as positions, or empty
  double rate = 0;               // rate: grains a second ...
  double start = 0;              // ... from this time on [s]
  std::filesystem::path file;    // file: comma-separated values (core/insert_file.h), which fill position, quaternion
  std::vector<Vec3> velocities, spins;  // file: as many as positions, or empty: `velocity`, `spin`
  std::vector<int> shape;               // file: index into the entry's shapes, patterns written out; or empty: shares
  Vec3 scatter;                         // list, file: each grain starts anywhere within +- this of its position [m]
};

// Grains that never existed, each with a code of its own drawn from those of a category (shapes/generate.h).
struct SampleCase {
  std::string library, category;
  double truncate = 2;                                              // of the Gaussian [standard deviations]
  Interval sphericity, convexity, elongation, flatness, roundness;  // what a grain has to be; unbounded: anything
  bool operator==(SampleCase const&) const = default;
};

// Grains on the line between the codes of two shapes of a library.
struct InterpolateCase {
  std::string library, from, to;  // shapes at t = 0 and t = 1
  double low = 0, high = 1;       // of t: evenly over the grains, equal: all grains alike
  bool random = false;            // t drawn uniformly from [low, high] instead
  bool operator==(InterpolateCase const&) const = default;
};

struct GrainsCase {
  std::string name, material;
  std::vector<std::string>
      shapes;  // "library:pattern/*", "mesh:file.stl" (file resolved), or built-in "sphere", "ellipsoid:1:0.8:0.6",
               // "superellipsoid:1:0.8:0.6:0.5" (semi-axis ratios, exponent), "box:1:1:1"; equal shares
  Evaluator evaluator = Evaluator::net;
  int nodes = 4000;  // surface nodes a grain; "fast" = 1000
  int count = 0;
  double diameter = 0.1;                 // of the equal-volume sphere, the largest of the entry [m]
  std::optional<double> least_diameter;  // sizes drawn uniformly from here to `diameter` [m]; absent: all alike
  InsertCase insert;
  int grid_cells = default_grid_cells;  // evaluator grid: cells across the bounding diameter
  int mesh_cells = default_mesh_cells;  // evaluator mesh, unless the shape is stored as one: the same
  NodeStorage storage = NodeStorage::explicit_;
  std::optional<SampleCase> sample{};            // exactly one of shapes, ...
  std::optional<InterpolateCase> interpolate{};  // ... sample and interpolate
  bool apart = false;                            // grains meet those of their own entry only
  bool nodes_given = false;                      // said by the user: [accuracy] leaves them alone
};

// Prescribed motion of a wall. Constant between start and end, or a table: linear between its times, constant beyond.
struct MotionCase {
  MotionKind kind = MotionKind::rotation;
  Vec3 axis{0, 0, 1}, through;    // rotation: right-handed about this line [m]
  double rate = 0;                // rotation [rad/s]
  Vec3 velocity;                  // translation [m/s]
  double start = 0, end = 1e300;  // [s]
  std::vector<double> time;       // table: ascending [s]; empty: constant
  std::vector<double> rates;      // ... of a rotation [rad/s]
  std::vector<Vec3> velocities;   // ... of a translation [m/s]
};

struct WallCase {
  std::string name, material;
  WallKind kind = WallKind::plane;
  Vec3 point, normal{0, 0, 1};            // plane: a point on it [m], normal into the free space
  bool inside = true;                     // box, cylinder, mesh: where the grains are
  Vec3 min, max;                          // box [m]
  std::vector<std::string> open;          // faces left out: box "-x" "+x" "-y" "+y" "-z" "+z"; cylinder "from" "to"
  Vec3 from, to{0, 0, 1};                 // cylinder, cone, capsule: ends of the axis [m]
  double radius = 0;                      // cylinder, capsule [m]
  double radius_from = 0, radius_to = 0;  // cone: of the middle of its wall at both ends [m]
  double thickness = 0;                   // cone; mesh: a sheet this thick, 0: a closed mesh [m]
  std::filesystem::path file;             // mesh, terrain; resolved
  double scale = 1;                       // mesh, terrain: [m] a unit of the file
  Vec3 shift;                             // ... then moved by [m]
  std::optional<MotionCase> motion;
};

// Starting overlaps are pushed apart before the run (core/relax.h).
struct RelaxCase {
  double overlap = 1e-3;  // until no contact is deeper [d]
  double travel = 0.02;   // furthest way of a point in one pass [d]
  int passes = 5000;      // more: refused
};

// Networks on a GPU; the CPU evaluates them in fp32 whatever is said here.
struct DeviceCase {
  Precision precision = Precision::fp32;
};

struct OutputCase {
  double every = 0.02;  // [s]
  bool paraview = false;
};

struct CheckpointCase {
  double every = 0.5;  // [s]
  int keep = 2;
};

struct LimitsCase {
  double overlap = 0.05;  // the watch stops the run above this [d]
  double gradient_low = 0.5, gradient_high = 2.0;
  double ledger = 1e-3;  // of the energy moved
  // Of a network's certificate (core/certificate_gate.h), the largest allowed:
  double components = 1;    // pieces of the surface
  double handles = 0;       // holes through the body
  double falling = 0.05;    // share of the interior in which phi falls inwards
  double gap = 0.005;       // blind gap of its surface nodes [d]
  double mae = 0.01;        // mean error of phi [d]
  double hausdorff = 0.05;  // [d]
  double volume = 0.01;     // relative error
  double inertia = 0.03;    // relative error
};

struct Case {
  std::filesystem::path file;  // where it came from; empty when built in code
  std::string name = "case";
  std::uint64_t seed = 1;
  int replicas = 1;  // independent copies of all grains, which never meet
  TimeCase time;
  std::optional<AccuracyCase> accuracy;  // absent: node counts and steps are what the case says
  std::optional<Vec3> gravity;           // [m/s2]; absent: none
  std::optional<DragCase> drag;
  std::optional<DampingCase> damping;
  std::vector<ForceCase> force;
  std::vector<DeleteCase> deletion;  // [[delete]]
  std::vector<LibraryCase> library;
  std::vector<MaterialCase> material;
  std::vector<ContactCase> contact;
  std::vector<GrainsCase> grains;
  std::vector<WallCase> wall;
  std::vector<MeasureCase> measure;
  std::optional<DeviceCase> device;  // absent: fp32
  OutputCase output;
  std::optional<CheckpointCase> checkpoint;
  std::optional<RelaxCase> relax;  // absent: grains start where they are put
  LimitsCase limits;
};

// Read and validate. `overrides` are "key=value" from --set ("grains.0.count=50", "grains.mix.count=50" by name,
// "time.end=2"). Relative paths: the case file's folder, then $SCREE_LIBRARY, then `share`.
// Throws InputError with all problems (a TOML syntax error comes alone).
Case load_case(std::filesystem::path const& file, std::vector<std::string> const& overrides,
               std::filesystem::path const& share = {});

// The effective case as TOML text, every default written out; load_case of it gives the same Case.
std::string to_toml(Case const& c);

// Everything wrong that can be seen without opening other files; empty = valid. Used by load_case and by API users.
std::vector<std::string> problems(Case const& c);

}  // namespace scree

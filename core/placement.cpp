// placement.cpp: see placement.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/placement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/free_spots.h"
#include "shapes/phi_batch.h"

namespace scree {
namespace {

// Uniform rotation (Shoemake 1992).
Quat random_orientation(std::mt19937_64& random) {
  double const tau = 6.283185307179586;
  double const u = uniform(random), v = tau * uniform(random), w = tau * uniform(random);
  double const a = std::sqrt(1 - u), b = std::sqrt(u);
  return {b * std::cos(w), a * std::sin(v), a * std::cos(v), b * std::sin(w)};
}

bool same_box(Box const& a, Box const& b) { return a.min == b.min && a.max == b.max; }

struct Lattice {
  Vec3 origin;
  double cell = 0;
  int n[3] = {};
  long used = 0;

  long capacity() const { return static_cast<long>(n[0]) * n[1] * n[2]; }
  Vec3 site(long i) const {
    return origin + Vec3{(i % n[0] + 0.5) * cell, (i / n[0] % n[1] + 0.5) * cell, (i / n[0] / n[1] + 0.5) * cell};
  }
};

// Lattice of all entries of one world that share `box`.
Lattice lattice_for(Case const& c, Scene const& scene, Box const& box, int world) {
  Lattice lattice;
  for (int i = 0; i < scene.bodies(); ++i) {
    InsertCase const& insert = c.grains[scene.group_of[i]].insert;
    if (insert.kind == InsertCase::Kind::lattice && same_box(insert.box, box) && scene.world(i) == world)
      lattice.cell = std::max(lattice.cell, 2 * scene.shape[scene.shape_of[i]].bounding_radius * scene.diameter[i]);
  }
  lattice.cell *= 1 + 1e-6;  // bounding spheres of neighbours do not touch, rounded either way
  Vec3 const size = box.max - box.min;
  for (int k = 0; k < 3; ++k) {
    lattice.n[k] = static_cast<int>(std::min(1e6, std::floor(size[k] / lattice.cell)));
    // Centred across, from the bottom up.
    lattice.origin[k] = box.min[k] + (k < 2 ? 0.5 * (size[k] - lattice.n[k] * lattice.cell) : 0);
  }
  return lattice;
}

}  // namespace

std::mt19937_64 random_stream(std::uint64_t seed, int group, Draw purpose) {
  std::seed_seq sequence{seed, seed >> 32, static_cast<std::uint64_t>(group), static_cast<std::uint64_t>(purpose)};
  return std::mt19937_64(sequence);
}

std::vector<int> assign_shapes(Case const& c, GrainEntry const& entry, std::vector<int> const& templates) {
  int const n = entry.count;
  std::vector<int> shape(n);
  if (std::vector<int> const& chosen = c.grains[entry.group].insert.shape; !chosen.empty()) {
    for (int i = 0; i < n; ++i) shape[i] = templates[chosen[i]];
    return shape;
  }
  for (int i = 0; i < n; ++i) shape[i] = templates[i % templates.size()];
  std::mt19937_64 random = random_stream(entry.seed, entry.group, Draw::shapes);
  for (int i = n - 1; i > 0; --i) std::swap(shape[i], shape[static_cast<int>(uniform(random) * (i + 1))]);
  return shape;
}

namespace {

// Lattices by their worlds and boxes, made as they are asked for; null: the entry does not fit and was reported.
class Lattices {
 public:
  Lattices(Case const& c, Scene const& scene, std::vector<std::string>& found) : c_(c), scene_(scene), found_(found) {}

  Lattice* of(GrainEntry const& entry) {
    GrainsCase const& grains = c_.grains[entry.group];
    Box const& box = grains.insert.box;
    int const world = scene_.world(entry.first);
    auto at = std::find_if(made_.begin(), made_.end(),
                           [&](Made const& m) { return m.world == world && same_box(m.box, box); });
    if (at == made_.end()) at = made_.insert(made_.end(), {world, box, lattice_for(c_, scene_, box, world)});
    Lattice& lattice = at->lattice;
    if (lattice.used + grains.count <= lattice.capacity()) return &lattice;
    found_.push_back(name_of(c_, entry) + ": insert.box holds " + std::to_string(lattice.capacity()) +
                     " grains (cell " + std::to_string(lattice.cell) + " m), but " +
                     std::to_string(lattice.used + grains.count) +
                     " are to start in it. Make the box larger or count smaller.");
    return nullptr;
  }

 private:
  Case const& c_;
  Scene const& scene_;
  std::vector<std::string>& found_;
  struct Made {
    int world;
    Box box;
    Lattice lattice;
  };
  std::vector<Made> made_;
};

// Where grains wait that are inserted later: the corner of their box that gravity leaves highest, so that the fall
// from it bounds the speed they will have.
Vec3 waiting_place(Case const& c, Box const& box) {
  Vec3 const g = c.gravity.value_or(Vec3{});
  Vec3 place;
  for (int k = 0; k < 3; ++k) place[k] = g[k] > 0 ? box.min[k] : box.max[k];
  return place;
}

double bounding_radius(Scene const& scene, int body) {
  return scene.shape[scene.shape_of[body]].bounding_radius * scene.diameter[body];
}

// A place within +- `reach` of `centre`; without a reach nothing is added, not even zero.
Vec3 scattered(Vec3 centre, Vec3 reach, std::mt19937_64& random) {
  for (int k = 0; k < 3; ++k)
    if (reach[k] > 0) centre[k] += reach[k] * (2 * uniform(random) - 1);
  return centre;
}

// Draws for a grain before it is refused: random placement of spheres slows down without bound near 38 % by volume.
int constexpr random_tries = 20000;

// Entries with insert.kind = "random", once all others that are there at the start have their places.
void place_at_random(Case const& c, Scene const& scene, Placement& out, std::vector<std::string>& found) {
  std::vector<GrainEntry> const entries = entries_of(c);
  auto const kind_of = [&](GrainEntry const& e) { return c.grains[e.group].insert.kind; };
  using Kind = InsertCase::Kind;
  if (std::none_of(entries.begin(), entries.end(), [&](auto const& e) { return kind_of(e) == Kind::random; })) return;
  double largest = 0;
  for (int i = 0; i < scene.bodies(); ++i) largest = std::max(largest, bounding_radius(scene, i));
  if (largest == 0) return;
  std::vector<SphereGrid> grid(scene.worlds(), SphereGrid(largest));
  for (GrainEntry const& e : entries)
    for (int i = e.first; i < e.first + e.count; ++i)
      if (kind_of(e) != Kind::random && kind_of(e) != Kind::rate)
        grid[scene.world(i)].add(out.position[i], bounding_radius(scene, i));
  for (GrainEntry const& e : entries) {
    if (kind_of(e) != Kind::random) continue;
    std::uint64_t random = random_stream(e.seed, e.group, Draw::places)();
    for (int i = e.first; i < e.first + e.count; ++i) {
      // A little larger, so that rounding leaves no overlap, and out of the reach of cohesion.
      double const radius = bounding_radius(scene, i) * (1 + 1e-9) + scene.cohesion_margin;
      std::optional<Vec3> const spot = find_free_spot(c.grains[e.group].insert.box, radius, grid[scene.world(i)],
                                                      WallClearance(scene), random_tries, random);
      if (!spot) {
        found.push_back(name_of(c, e) + ": grain " + std::to_string(i - e.first + 1) + " of " +
                        std::to_string(e.count) + ", bounding diameter " + std::to_string(2 * radius) +
                        " m, found no free place in insert.box in " + std::to_string(random_tries) +
                        " random tries (inside the box, in front of the walls, clear of other grains). Make the box "
                        "larger or count smaller; kind = \"lattice\" packs closer.");
        return;
      }
      out.position[i] = *spot;
      grid[scene.world(i)].add(*spot, bounding_radius(scene, i) * (1 + 1e-9));
    }
  }
}

// Whether a grain's own centre is solid: that of a ring or a hook is not, and may well be in a wall.
bool centre_is_solid(Scene const& scene, int body) {
  std::size_t const shape = scene.shape_of[body];
  if (shape >= scene.library.shape.size()) return true;  // compact grains are star-shaped
  std::vector<Vec3> const centre(1);
  std::vector<double> phi(1);
  reference_phi(scene.library, scene.library.shape[shape])(centre, phi, {});
  return phi[0] > 0;
}

// Lattices and lists know nothing of walls. A grain whose centre is inside one would stop the run at its first step.
void check_starts(Case const& c, Scene const& scene, Placement const& placement, std::vector<std::string>& found) {
  using Kind = InsertCase::Kind;
  WallClearance const walls(scene);
  for (GrainEntry const& e : entries_of(c)) {
    Kind const kind = c.grains[e.group].insert.kind;
    if (kind == Kind::rate || kind == Kind::random) continue;  // these look for their places
    int inside = 0, first = -1, wall = -1;
    for (int i = e.first; i < e.first + e.count; ++i)
      if (int const w = walls.wall_around(placement.position[i]); w >= 0 && centre_is_solid(scene, i) && ++inside == 1)
        first = i, wall = w;
    if (inside == 0) continue;
    Vec3 const x = placement.position[first];
    found.push_back(fmt::format(
        "{}: {} of {} grains start inside a wall, the first of them grain {} at [{:.4g}, {:.4g}, {:.4g}] m inside wall "
        "'{}'. Move them, or the wall: the solid of a plane is behind its normal, `side` says where grains of a closed "
        "wall are",
        name_of(c, e), inside, e.count, first - e.first + 1, x.x, x.y, x.z, c.wall[wall].name));
  }
}

// Entries inserted over time need a place at least while nothing else is there.
void check_later_places(Case const& c, Scene const& scene, std::vector<std::string>& found) {
  std::vector<double> largest(c.grains.size(), 0);
  for (int i = 0; i < scene.bodies(); ++i)
    largest[scene.group_of[i]] = std::max(largest[scene.group_of[i]], bounding_radius(scene, i));
  for (std::size_t g = 0; g < c.grains.size(); ++g) {
    GrainsCase const& grains = c.grains[g];
    if (grains.insert.kind != InsertCase::Kind::rate || grains.count == 0) continue;
    std::uint64_t random = 1;
    SphereGrid const empty(largest[g]);
    if (find_free_spot(grains.insert.box, largest[g] + scene.cohesion_margin, empty, WallClearance(scene), random_tries,
                       random))
      continue;
    found.push_back("grains '" + grains.name + "': a grain of bounding diameter " + std::to_string(2 * largest[g]) +
                    " m has no place in insert.box, inside it and in front of the walls, even while it is empty. Make "
                    "the box larger.");
  }
}

}  // namespace

Placement place_grains(Case const& c, Scene const& scene, std::vector<std::string>& found) {
  using Kind = InsertCase::Kind;
  Placement out;
  Lattices lattices(c, scene, found);
  for (GrainEntry const& entry : entries_of(c)) {
    InsertCase const& insert = c.grains[entry.group].insert;
    std::mt19937_64 random = random_stream(entry.seed, entry.group, Draw::poses);
    std::mt19937_64 scatter = random_stream(entry.seed, entry.group, Draw::scatter);
    Lattice* lattice = nullptr;
    if (insert.kind == Kind::lattice && entry.count > 0 && !(lattice = lattices.of(entry))) return out;
    bool const listed = insert.kind == Kind::list || insert.kind == Kind::file;
    for (int i = 0; i < entry.count; ++i) {
      out.position.push_back(lattice  ? lattice->site(lattice->used++)
                             : listed ? scattered(insert.position[i], insert.scatter, scatter)
                                      : waiting_place(c, insert.box));
      Quat orientation;
      if (!insert.quaternion.empty())
        orientation = normalized(insert.quaternion[i]);
      else if (insert.orientation == Orientation::random)
        orientation = random_orientation(random);
      out.orientation.push_back(orientation);
      out.velocity.push_back(insert.velocities.empty() ? insert.velocity : insert.velocities[i]);
      out.spin.push_back(insert.spins.empty() ? insert.spin : insert.spins[i]);
    }
  }
  place_at_random(c, scene, out, found);
  check_starts(c, scene, out, found);
  check_later_places(c, scene, found);
  return out;
}

}  // namespace scree

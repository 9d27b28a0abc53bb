// contact_errors.h: how far the force of a contact is off when it is summed over so many surface nodes.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "kernels/contact_laws.h"
#include "shapes/phi_batch.h"
#include "shapes/point_blocks.h"

namespace scree {

// Points of a shape's surface and the area that each stands for: nodes, or many more. Body frame [d], [d^2].
struct SurfaceCover {
  std::vector<Vec3> position;
  std::vector<double> area;
  PointBlocks blocks;
};

// The surface nodes that the engine would make; core nodes never act in ordinary contact.
SurfaceCover node_cover(Library const& library, Shape const& shape, int nodes);
// At least `points` points that know nothing of the nodes.
SurfaceCover dense_cover(Library const& library, Shape const& shape, int points);

// Grain b beside grain a of the same shape: x_a = turn x_b + shift [d].
struct ContactPose {
  Quat turn;
  Vec3 shift;
};

// `count` contacts, orientations and directions uniform, the deepest point of b's cover (that of dense_cover) `overlap`
// inside a [d], 5 % of that beside it at most; b comes from outside, so the first place that is as deep. Drawn with
// `seed`.
std::vector<ContactPose> draw_contacts(PhiBatch const& phi, Shape const& shape, SurfaceCover const& dense, int count,
                                       double overlap, std::uint64_t seed);

// phi twice: to find what is inside, and to say how deep it is.
struct ContactPhi {
  PhiBatch fast, exact;  // within 1e-5 d of each other; may be the same
};

// Elastic force on b in a's frame, half from each side's points, in units of d^2 times the law's pressure; `diameter`:
// that of the grains [m], which the law's overlaps are measured in.
Vec3 contact_force(ContactPhi const& phi, Shape const& shape, SurfaceCover const& cover, ContactPose const& pose,
                   PressureLaw const& law, double diameter);

// Drawn contacts for an error: the largest of 90 lies above 95 % of all contacts with 99 % confidence (Wilks, Ann.
// Math. Stat. 12 (1941) 91-96: 1 - 0.95^90 = 0.99), whatever their distribution.
int constexpr wilks_contacts = 90;

// Errors of one shape's contacts at one overlap. Lengths are in d, forces relative: neither size nor stiffness matter.
class ContactErrors {
 public:
  // Holds references: library and shape must outlive it. `overlap` [d]. Works when asked.
  ContactErrors(Library const& library, Shape const& shape, PressureLaw const& law, double diameter, double overlap,
                int points);

  // |force - that of the dense cover| over the latter, the largest of the drawn contacts.
  double at(int nodes);

 private:
  void prepare();

  Library const& library_;
  Shape const& shape_;
  PressureLaw law_;
  double diameter_, overlap_;
  int points_;
  PhiBatch phi_;
  std::vector<ContactPose> contact_;
  std::vector<Vec3> exact_;
};

}  // namespace scree

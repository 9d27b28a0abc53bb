// grain_rays.h: rays and distances against the grains of one frame, through the phi that was simulated.
// Sphere tracing (Hart 1996): along a ray, steps of |phi| / L cannot jump over the surface. Rays go in batches, so that
// networks are evaluated in batches; phi is evaluated inside bounding balls only.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "core/grain_phi.h"
#include "core/results.h"

namespace scree {

struct Ray {
  Vec3 origin, direction;  // world [m], unit
  double limit = 1e300;    // nothing beyond it counts [m]
};

struct RayHit {
  int body = -1;        // -1: none
  double distance = 0;  // [m]
};

class GrainRays {
 public:
  // Inactive bodies and those at positions that are not finite are left out. Throws what GrainPhi throws, which
  // `device` is for.
  GrainRays(ResultsHeader const& header, Frame const& frame, std::shared_ptr<NetworkDevice> device = nullptr);

  // First grain along each ray, to walk_tolerance of its diameter. `any`: the first one found will do (shadows).
  // Thread-safe, as are the others; a ray's result does not depend on the batch.
  void trace(std::vector<Ray> const& rays, std::vector<RayHit>& hits, bool any = false) const;

  // Outward unit normals at surface points.
  void normals(std::vector<Vec3> const& points, std::vector<int> const& bodies, std::vector<Vec3>& normals) const;

  // Distance to the nearest grain, at most `reach`; outside the bounding balls by way of their nearest point.
  void clearance(std::vector<Vec3> const& points, double reach, std::vector<double>& distance) const;

  bool on_device() const { return phi_.on_device(); }  // networks are: batches should be large
  bool empty() const { return balls_.empty(); }
  Box bounds() const { return bounds_; }  // of all bounding balls [m]; nothing when empty
  double mean_diameter() const { return mean_diameter_; }
  Vec3 in_body_frame(int body, Vec3 world) const { return phi_.in_body_frame(body, world); }  // [d]

 private:
  struct Ball {
    Vec3 centre;
    double radius;
    int body;
  };
  struct Node {  // children of inner nodes follow: left at once, right at `right`; leaves: right = -1
    Box box;
    int first, count, right;
  };
  struct Visit {
    double enter, leave;
    int ball;
  };

  int build(int first, int count);
  void collect(Ray const& ray, std::vector<Visit>& visits) const;
  void near(Vec3 point, double reach, std::vector<int>& balls) const;

  ResultsHeader const& header_;
  GrainPhi phi_;
  std::vector<Ball> balls_;  // in the order of the tree
  std::vector<Node> nodes_;
  Box bounds_;
  double mean_diameter_ = 1;
};

}  // namespace scree

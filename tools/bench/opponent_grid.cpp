// opponent_grid.cpp: trilinear interpolation in a level-set grid, what engines without networks do.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "kernels/sdf/sdf_batch.h"
#include "tools/bench/opponents.h"

namespace scree::bench {

namespace {

int constexpr nodes = 43;  // an edge; the reference paper's level set of 0.05 d needs about as many

class Grid final : public Opponent {
 public:
  Grid(Mlp const& net, double half)
      : origin_(static_cast<float>(-half)), scale_(static_cast<float>((nodes - 1) / (2 * half))) {
    std::vector<Vec3f> point;
    for (int z = 0; z < nodes; ++z)
      for (int y = 0; y < nodes; ++y)
        for (int x = 0; x < nodes; ++x)
          point.push_back({origin_ + x / scale_, origin_ + y / scale_, origin_ + z / scale_});
    value_.resize(point.size());
    PackedMlp const packed(net);
    std::vector<float> rows;
    packed.append_bias(net.bias[0], rows);
    sdf_forward({}, packed, rows, point, {}, value_);
  }

  void forward(Span<const Vec3f> point, int, Span<float> phi) override {
    for (int i = 0; i < point.size(); ++i) phi[i] = interpolate(point[i], nullptr);
  }
  void gradient(Span<const Vec3f> point, int, Span<float> phi, Span<Vec3f> gradient) override {
    for (int i = 0; i < point.size(); ++i) phi[i] = interpolate(point[i], &gradient[i]);
  }

 private:
  float interpolate(Vec3f p, Vec3f* gradient) const {
    float const gx = (p.x - origin_) * scale_, gy = (p.y - origin_) * scale_, gz = (p.z - origin_) * scale_;
    int const x = std::clamp(static_cast<int>(gx), 0, nodes - 2);
    int const y = std::clamp(static_cast<int>(gy), 0, nodes - 2);
    int const z = std::clamp(static_cast<int>(gz), 0, nodes - 2);
    float const u = gx - x, v = gy - y, w = gz - z;
    float const* c = value_.data() + (z * nodes + y) * nodes + x;
    int constexpr dy = nodes, dz = nodes * nodes;
    float const c00 = c[0] + u * (c[1] - c[0]), c10 = c[dy] + u * (c[dy + 1] - c[dy]);
    float const c01 = c[dz] + u * (c[dz + 1] - c[dz]), c11 = c[dz + dy] + u * (c[dz + dy + 1] - c[dz + dy]);
    float const c0 = c00 + v * (c10 - c00), c1 = c01 + v * (c11 - c01);
    if (gradient) {
      float const x0 = (c[1] - c[0]) + v * ((c[dy + 1] - c[dy]) - (c[1] - c[0]));
      float const x1 = (c[dz + 1] - c[dz]) + v * ((c[dz + dy + 1] - c[dz + dy]) - (c[dz + 1] - c[dz]));
      *gradient = {scale_ * (x0 + w * (x1 - x0)), scale_ * ((c10 - c00) + w * ((c11 - c01) - (c10 - c00))),
                   scale_ * (c1 - c0)};
    }
    return c0 + w * (c1 - c0);
  }

  float origin_, scale_;
  std::vector<float> value_;
};

}  // namespace

std::unique_ptr<Opponent> make_grid(Mlp const& net, double half) { return std::make_unique<Grid>(net, half); }

}  // namespace scree::bench

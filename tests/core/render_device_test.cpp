// render_device_test.cpp: pictures of grains of every kind, networks on a device, are those of the host bit for bit.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "core/grain_phi.h"
#include "core/render.h"
#include "kernels/base/device.h"
#include "tests/support/network_devices.h"
#include "tests/support/shape_kinds.h"

namespace scree {
namespace {

using namespace testing;

// Adds the shapes of `from` and what they consist of.
void append(Library& to, Library const& from) {
  for (Shape s : from.shape) {
    if (s.is_net()) s.net += static_cast<int>(to.net.size());
    if (s.kind == ShapeKind::harmonics) s.data += static_cast<int>(to.harmonics.size());
    if (s.kind == ShapeKind::mesh) s.data += static_cast<int>(to.mesh.size());
    if (s.kind == ShapeKind::grid) s.data += static_cast<int>(to.grid.size());
    to.shape.push_back(s);
  }
  to.net.insert(to.net.end(), from.net.begin(), from.net.end());
  to.harmonics.insert(to.harmonics.end(), from.harmonics.begin(), from.harmonics.end());
  to.mesh.insert(to.mesh.end(), from.mesh.begin(), from.mesh.end());
  to.grid.insert(to.grid.end(), from.grid.begin(), from.grid.end());
}

// Grains with a code of their own each, all of one decoder.
Library unique_grains(int count) {
  Library library = library_of_kind("coded_net");
  for (int k = 1; k < count; ++k) {
    library.shape.push_back(library.shape[0]);
    library.shape[k].name = "unique/" + std::to_string(k);
    library.shape[k].code = {0.1f - 0.08f * static_cast<float>(k), 0.06f * static_cast<float>(k)};
    normalise_net(library, k, 1.5, {.cells = 24});
  }
  return library;
}

// Rows of bodies with a floor at z = 0, their diameters and orientations all different.
struct Bodies {
  ResultsHeader header;
  Frame frame;
  RenderOptions options;

  explicit Bodies(Library const& library) {
    header.library = library;
    header.wall = {{"floor", {0, 0, 0}, {0, 0, 1}}};
    header.domain = {{-1, -1, 0}, {4, 4, 2}};
    int const n = static_cast<int>(library.shape.size());
    for (int i = 0; i < n; ++i) {
      header.shape_name.push_back(library.shape[i].name);
      header.shape.push_back((5 * i) % n);  // n is no multiple of 5: neighbours are of different kinds
      header.diameter.push_back(0.9 + 0.01 * i);
      for (auto* of : {&header.material, &header.group, &header.replica}) of->push_back(0);
      frame.position.push_back({1.1 * (i % 4), 1.1 * (i / 4), 0.6});
      frame.orientation.push_back(quat_from_rotation_vector({0.4 * i, 0.3, -0.2 * i}));
      frame.velocity.push_back({});
      frame.spin.push_back({});
    }
    options.width = 64;
    options.height = 48;
    options.elevation = 0.9;
  }
  int count() const { return static_cast<int>(header.shape.size()); }
};

Bodies bodies_of_all_kinds() {
  static Library const library = [] {
    Library all;
    for (char const* kind : all_kinds)
      if (std::string(kind) != "coded_net") append(all, library_of_kind(kind));
    append(all, unique_grains(3));
    return all;
  }();
  return Bodies(library);
}

// phi of a body and its gradient do not depend on what else is asked with it.
TEST(GrainPhi, IsThatOfEachShapeAlone) {
  Bodies const b = bodies_of_all_kinds();
  ASSERT_NE(b.count() % 5, 0);
  GrainPhi const grains(b.header, b.frame, nullptr);
  EXPECT_FALSE(grains.on_device());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<BodyPoint> queries;
  while (queries.size() < 500) {
    int const body = static_cast<int>(random() % static_cast<unsigned>(b.count()));
    Vec3 const x{uniform(random), uniform(random), uniform(random)};
    double const radius = b.header.library.shape[b.header.shape[body]].bounding_radius * b.header.diameter[body];
    if (norm(x) < 1) queries.push_back({body, b.frame.position[body] + x * (1.05 * radius)});  // some beyond the ball
  }
  std::vector<PhiBatch> alone;
  for (Shape const& s : b.header.library.shape) alone.push_back(surface_phi(b.header.library, s));
  std::vector<double> phi, phi_only;
  std::vector<Vec3> gradient;
  grains.evaluate(queries, phi, &gradient);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    int const body = queries[i].body;
    int const shape = b.header.shape[body];
    Vec3 const x = grains.in_body_frame(body, queries[i].point);
    double value = 0;
    Vec3 slope;
    alone[shape]({&x, 1}, {&value, 1}, {&slope, 1});
    EXPECT_EQ(phi[i], value * b.header.diameter[body]) << b.header.shape_name[shape];
    EXPECT_TRUE(gradient[i] == to_matrix(normalized(b.frame.orientation[body])) * slope) << b.header.shape_name[shape];
  }
  grains.evaluate(queries, phi_only, nullptr);
  EXPECT_EQ(phi, phi_only);
  grains.evaluate({}, phi, &gradient);
  EXPECT_TRUE(phi.empty() && gradient.empty());
}

class RenderDevice : public SameBitsOnNetworkDevices {
 protected:
  // Seconds of one picture.
  static double draw(Bodies const& b, Rendering& picture) {
    auto const start = std::chrono::steady_clock::now();
    picture = render(b.header, b.frame, b.options);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
};

TEST_P(RenderDevice, DrawsTheHostsPictureOfEveryKind) {
  Bodies b = bodies_of_all_kinds();
  Vec3 const middle = b.frame.position[5];
  for (bool const cut : {false, true}) {
    if (cut) b.options.cut = CutPlane{middle, normalized(Vec3{0.1, -0.2, 1})};
    b.options.network_device = nullptr;
    Rendering host, device;
    double const host_seconds = draw(b, host);
    b.options.network_device = device_;
    double const device_seconds = draw(b, device);
    int differ = 0;
    int const pixels = b.options.width * b.options.height;
    for (int i = 0; i < pixels; ++i)
      differ += !std::equal(host.image.rgb.begin() + 3 * i, host.image.rgb.begin() + 3 * i + 3,
                            device.image.rgb.begin() + 3 * i);
    printf("picture%s: %d of %d pixels differ; %.3f s with networks on the host, %.3f s on the %s device\n",
           cut ? ", cut" : "", differ, pixels, host_seconds, device_seconds, GetParam());
    EXPECT_EQ(differ, 0);
    EXPECT_EQ(host.id, device.id);
    EXPECT_EQ(host.depth, device.depth);
    // Some of them lie behind the cut; without one every grain, and so every kind, shows.
    EXPECT_GE(visible_share(host, b.count(), 20), cut ? 0.5 : 1.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Devices, RenderDevice, network_devices, network_device_name);

// Stands for a device: counts what it is asked, and answers nothing.
struct LostDevice : NetworkDevice {
  int loads = 0, batches = 0;
  std::string describe() const override { return "lost"; }
  void load(SceneView const&, NetworkSet const&, Precision) override { ++loads; }
  void evaluate(Queue const&, QueryBatch&, double) override {
    ++batches;
    throw DeviceError("lost");
  }
  void walk(Queue const&, WalkBatch&, int) override {
    ++batches;
    throw DeviceError("lost");
  }
  double kernel_seconds() const override { return 0; }
};

TEST(RenderDevice, ErrorsOfTheDeviceComeOutOfThreads) {
  Bodies b(unique_grains(1));
  auto const device = std::make_shared<LostDevice>();
  b.options.network_device = device;
  b.options.width = 600;  // three tiles
  for (int threads : {1, 2}) {
    b.options.threads = threads;
    EXPECT_THROW(render(b.header, b.frame, b.options), DeviceError);
  }
  EXPECT_EQ(device->loads, 2);
  EXPECT_GE(device->batches, 2);
}

TEST(RenderDevice, GrainsWithoutNetworksAskNoDevice) {
  Bodies b(library_of_kind("ellipsoid"));
  auto const device = std::make_shared<LostDevice>();
  b.options.network_device = device;
  EXPECT_EQ(visible_share(render(b.header, b.frame, b.options), 1), 1.0);
  EXPECT_EQ(device->loads, 0);
}

}  // namespace
}  // namespace scree

// render_test.cpp: pictures against formulas: what a sphere above a floor covers, how far it is, where shadow falls.
// SPDX-License-Identifier: Apache-2.0
#include "core/render.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <system_error>

#include "shapes/analytic_shapes.h"

namespace scree {
namespace {

int constexpr width = 320, height = 240;

// Bodies of one shape, diameter 1 m, with a floor at z = 0.
struct Picture {
  ResultsHeader header;
  Frame frame;
  RenderOptions options;

  explicit Picture(Shape const& shape) {
    header.library.shape = {shape};
    header.shape_name = {shape.name};
    header.wall = {{"floor", {0, 0, 0}, {0, 0, 1}}};
    header.domain = {{-2, -2, 0}, {2, 2, 2}};
    options.width = width;
    options.height = height;
    options.smooth_edges = false;
  }
  void add(Vec3 position, Quat orientation = {}) {
    header.shape.push_back(0);
    header.diameter.push_back(1);
    header.material.push_back(0);
    header.group.push_back(0);
    header.replica.push_back(0);
    frame.position.push_back(position);
    frame.orientation.push_back(orientation);
    frame.velocity.push_back({});
    frame.spin.push_back({});
  }
  Rendering draw() const { return render(header, frame, options); }
};

int count(Rendering const& r, int id) { return static_cast<int>(std::count(r.id.begin(), r.id.end(), id)); }
std::size_t at(int x, int y) { return std::size_t(y) * width + x; }
int grey(Rendering const& r, int x, int y) {
  return r.image.rgb[3 * at(x, y)] + r.image.rgb[3 * at(x, y) + 1] + r.image.rgb[3 * at(x, y) + 2];
}

// Pixels to a unit of tan(angle).
double focal_length(Camera const& c) { return 0.5 * height / std::tan(c.field_of_view / 2); }

TEST(Render, SphereInTheMiddleCoversItsDisc) {
  Picture p(make_sphere());
  p.add({0, 0, 1});
  double const distance = 4, radius = 0.5;
  p.options.camera = Camera{{distance, 0, 1}, {0, 0, 1}, 0.6};
  Rendering const r = p.draw();
  // Seen from its axis a sphere covers a disc of angular radius asin(r / D). Counting pixel centres errs by about the
  // square root of the circumference; the hit tolerance of 1e-4 d adds 0.04 %.
  double const disc = focal_length(*p.options.camera) * std::tan(std::asin(radius / distance));
  double const area = std::numbers::pi * disc * disc;
  EXPECT_NEAR(count(r, 0), area, 3 * std::sqrt(2 * std::numbers::pi * disc) + 1e-3 * area);
  // The four pixels round the centre look at the nearest point, half a pixel off.
  EXPECT_NEAR(r.depth[at(width / 2, height / 2)], distance - radius,
              2e-4 + 0.5 / focal_length(*p.options.camera) * radius);
}

TEST(Render, FloorAndSkyAreWhereTheyMustBe) {
  Picture p(make_sphere());
  p.add({0, 0, 1});
  p.options.camera = Camera{{4, 0, 1}, {0, 0, 1}, 0.6};
  Rendering const r = p.draw();
  double const f = focal_length(*p.options.camera);
  for (int y = 0; y < height; ++y) {
    int const x = 3;                                                                         // beside the sphere
    double const below = (y + 0.5 - 0.5 * height) / f, aside = (x + 0.5 - 0.5 * width) / f;  // tangents
    if (below < 0) {
      EXPECT_EQ(r.id[at(x, y)], render_sky) << y;
      EXPECT_TRUE(std::isinf(r.depth[at(x, y)]));
    } else {
      EXPECT_EQ(r.id[at(x, y)], render_floor) << y;
      double const depth = 1 / below * std::sqrt(1 + below * below + aside * aside);  // the eye is 1 m above the floor
      EXPECT_NEAR(r.depth[at(x, y)], depth, 1e-5 * depth) << y;
    }
  }
  EXPECT_EQ(count(r, 0) + count(r, render_floor) + count(r, render_sky), width * height);
}

TEST(Render, NearerBodyHidesTheFarther) {
  Picture p(make_sphere());
  p.add({-1.2, 0, 1});
  p.add({0, 0, 1});
  p.options.camera = Camera{{4, 0, 1}, {0, 0, 1}, 0.6};
  Rendering const r = p.draw();
  EXPECT_EQ(r.id[at(width / 2, height / 2)], 1);
  EXPECT_EQ(count(r, 0), 0) << "exactly behind and smaller";
  EXPECT_EQ(visible_share(r, 2), 0.5);
}

TEST(Render, OrientationTurnsTheShape) {
  // A box seen along x from far away: its y-z face. Turned a quarter about x, height and width change places.
  Picture upright(make_box({1, 1, 2})), turned(make_box({1, 1, 2}));
  upright.add({0, 0, 2});
  turned.add({0, 0, 2}, quat_from_rotation_vector({std::numbers::pi / 2, 0, 0}));
  for (Picture* p : {&upright, &turned}) p->options.camera = Camera{{40, 0, 2}, {0, 0, 2}, 0.06};
  Rendering const a = upright.draw(), b = turned.draw();
  auto const extent = [](Rendering const& r, bool vertical) {
    int low = 1000, high = -1;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (r.id[at(x, y)] == 0) low = std::min(low, vertical ? y : x), high = std::max(high, vertical ? y : x);
    return high - low + 1;
  };
  double const edge = std::cbrt(std::numbers::pi / 6 / 2);  // volume edge * edge * 2 edge
  double const pixels = focal_length(*upright.options.camera) / (40 - edge / 2);
  EXPECT_NEAR(extent(a, true), 2 * edge * pixels, 2);
  EXPECT_NEAR(extent(a, false), edge * pixels, 2);
  EXPECT_NEAR(extent(b, false), 2 * edge * 40 / (40 - 0.5) / 40 * focal_length(*upright.options.camera), 4);
  EXPECT_NEAR(extent(b, true), edge * pixels, 4);
}

// |x| + |y| + |z| = size as a network, exactly: relu(x) + relu(-x) = |x|.
Shape octahedron(Library& library, double size) {
  Mlp net;
  net.activation = Activation::leaky_relu;
  net.parameter = 0;
  net.width = {3, 6, 1};
  net.weight = {{1, -1, 0, 0, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0, 0, 1, -1}, std::vector<float>(6, -1 / std::sqrt(3.0f))};
  net.bias = {std::vector<float>(6, 0), {static_cast<float>(size / std::sqrt(3.0))}};
  library.net = {net};
  Shape s;
  s.name = "octahedron/0";
  s.kind = ShapeKind::net;
  s.net = 0;
  s.bounding_radius = size;
  s.box = {{-size, -size, -size}, {size, size, size}};
  s.lipschitz = 1;
  return s;
}

TEST(Render, NetworkIsDrawnByItsOwnZeroSet) {
  double const size = 0.795;  // 79.5 pixels: no pixel centre on the boundary
  Library library;
  Shape const shape = octahedron(library, size);
  Picture p(shape);
  p.header.library.net = library.net;
  p.add({0, 0, 2});
  double const distance = 100;
  p.options.camera = Camera{{distance, 0, 2}, {0, 0, 2}, 0.024};
  Rendering const r = p.draw();
  // Along x the silhouette is |y| + |z| <= size in the plane x = 0, area 2 size^2.
  double const pixels = focal_length(*p.options.camera) / distance;
  double const area = 2 * size * size * pixels * pixels;
  // Boundary pixels: square root of the perimeter; tolerance of the hit along 45 degree edges 1e-4.
  EXPECT_NEAR(count(r, 0), area, 3 * std::sqrt(4 * std::numbers::sqrt2 * size * pixels) + 2e-3 * area);
  EXPECT_NEAR(r.depth[at(width / 2, height / 2)], distance - size, 0.01);  // the tip, half a pixel off
}

TEST(Render, ShadowDarkensTheFloorAndContactDarkensIt) {
  Picture without(make_sphere()), with(make_sphere());
  without.add({0, 0, 0.5});
  with.add({0, 0, 0.5});
  without.frame.position[0] = {500, 0, 0.5};  // out of sight
  for (Picture* p : {&without, &with}) p->options.camera = Camera{{4, 0, 3}, {0, 0, 0.3}, 0.8};
  Rendering const a = without.draw(), b = with.draw();
  int darker = 0, brighter = 0, same = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (b.id[at(x, y)] != render_floor) continue;
      int const change = grey(b, x, y) - grey(a, x, y);
      ++(change < -60 ? darker : change > 2 ? brighter : same);
    }
  EXPECT_GT(darker, 500);  // the shadow is about as large as the sphere's disc
  EXPECT_EQ(brighter, 0);
  EXPECT_GT(same, 10 * darker);
}

TEST(Render, ChosenCameraShowsEverything) {
  Picture p(make_ellipsoid({2, 1, 1}));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) p.add({1.5 * i, 1.5 * j, 0.5});
  p.header.wall.push_back({"west", {-1, 0, 0}, {1, 0, 0}});
  p.header.wall.push_back({"east", {4, 0, 0}, {-1, 0, 0}});
  Rendering const r = p.draw();
  EXPECT_EQ(visible_share(r, 9), 1.0);
  EXPECT_GT(count(r, render_floor), width * height / 10);
  for (int x = 0; x < width; ++x) {  // no grain touches the border
    EXPECT_LT(r.id[at(x, 0)], 0);
    EXPECT_LT(r.id[at(x, height - 1)], 0);
  }
}

TEST(Render, SamePictureWithAnyNumberOfThreads) {
  Picture p(make_ellipsoid({2, 1.5, 1}));
  p.options.smooth_edges = true;
  for (int i = 0; i < 5; ++i)
    p.add({0.8 * i, 0.3 * i, 0.5 + 0.1 * i}, quat_from_rotation_vector({0.1 * i, 0.5, 0.3 * i}));
  Rendering const one = p.draw();
  p.options.threads = 3;
  Rendering const three = p.draw();
  EXPECT_EQ(one.image.rgb, three.image.rgb);
  EXPECT_EQ(one.id, three.id);
  EXPECT_EQ(one.depth, three.depth);
}

TEST(Render, EmptyFrameAndLostBodyAreDrawn) {
  Picture p(make_sphere());
  EXPECT_EQ(count(p.draw(), 0), 0);
  p.add({0, 0, 0.5});
  p.add({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  Rendering const r = p.draw();
  EXPECT_GT(count(r, 0), 100);
  EXPECT_EQ(count(r, 1), 0);
}

TEST(Render, RefusesBadInput) {
  Picture p(make_sphere());
  p.add({0, 0, 1});
  auto const refused = [&](auto const& change) {
    Picture bad = p;
    change(bad);
    EXPECT_THROW(bad.draw(), std::invalid_argument);
  };
  refused([](Picture& b) { b.options.width = 0; });
  refused([](Picture& b) { b.options.height = 100000; });
  refused([](Picture& b) { b.options.threads = 0; });
  refused([](Picture& b) { b.options.camera = Camera{{0, 0, 1}, {0, 0, 1}, 0.5}; });
  refused([](Picture& b) { b.options.camera = Camera{{4, 0, 1}, {0, 0, 1}, 4}; });
  refused([](Picture& b) { b.frame.orientation.clear(); });
  refused([](Picture& b) { b.header.diameter.push_back(1); });
}

TEST(PngFile, IsReadBackPixelByPixel) {
  Image image{3, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 1, 2, 3, 100, 101, 102, 255, 255, 255}};
  auto const file = std::filesystem::temp_directory_path() / "scree_png_test.png";
  write_png(file, image);
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&header, file.c_str()));
  header.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> read(PNG_IMAGE_SIZE(header));
  ASSERT_TRUE(png_image_finish_read(&header, nullptr, read.data(), 0, nullptr));
  EXPECT_EQ(header.width, 3u);
  EXPECT_EQ(header.height, 2u);
  EXPECT_EQ(read, image.rgb);
  std::filesystem::remove(file);
  EXPECT_THROW(write_png("/nonexistent/folder/picture.png", image), std::system_error);
  image.rgb.pop_back();
  EXPECT_THROW(write_png(file, image), std::invalid_argument);
}

// Two spheres side by side: the faster one has the brighter colour, and the scale ends at what was asked.
TEST(Render, SpeedsAreColoursOfAScale) {
  Picture p(make_sphere());
  p.add({-0.7, 0, 0.5});
  p.add({0.7, 0, 0.5});
  p.frame.velocity = {{0, 0, 0}, {3, 0, 4}};
  p.options.colour = ColourBy::speed;
  Rendering const r = p.draw();
  EXPECT_EQ(r.colour_limit, 5);  // 3-4-5
  auto const mean_grey = [&](Rendering const& of, int id) {
    double sum = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        if (of.id[at(x, y)] == id) sum += grey(of, x, y);
    return sum / count(of, id);
  };
  EXPECT_GT(mean_grey(r, 1), 2 * mean_grey(r, 0));
  p.options.colour_limit = 1e6;  // now both are at the dark end
  Rendering const slow = p.draw();
  EXPECT_EQ(slow.colour_limit, 1e6);
  EXPECT_NEAR(mean_grey(slow, 1) / mean_grey(slow, 0), 1, 0.1);
  EXPECT_THROW(colour_by("taste"), std::invalid_argument);
}

// Two of three spheres are 0.02 d in each other: the scale ends there, the third is at its dark end.
TEST(Render, OverlapsAreColoursOfAScale) {
  Picture p(make_sphere());
  p.add({-1, 0, 0.6});
  p.add({-0.02, 0, 0.6});
  p.add({1.2, 0, 0.6});
  p.options.colour = ColourBy::overlap;
  double limit = 0;
  std::vector<Vec3> const colour = body_colours(p.header, p.frame, p.options.colour, limit, 1);
  // Points stand at most 0.05 apart, so the meter misses s^2 / (4 R) = 0.0013 at most.
  EXPECT_GT(limit, 0.0187);
  EXPECT_LE(limit, 0.02 + 1e-12);
  EXPECT_GT(colour[0].x, 10 * colour[2].x);
  EXPECT_NEAR(colour[0].x, colour[1].x, 0.1);
  EXPECT_EQ(p.draw().colour_limit, limit);
  EXPECT_EQ(unit_of(ColourBy::overlap), std::string("d"));
}

// A sphere cut through its middle shows a disc of its own radius, flat and where the plane is.
TEST(Render, CutShowsTheInside) {
  Picture p(make_sphere());
  p.add({0, 0, 0.5});
  p.options.camera = Camera{{0, -6, 0.5}, {0, 0, 0.5}, 0.4};
  p.options.cut = CutPlane{{0, 0, 0.5}, {0, -1, 0}};  // the near half is gone
  Rendering const r = p.draw();
  double const focal = focal_length(r.camera), radius = focal * 0.5 / 6;  // the disc lies 6 m away
  EXPECT_NEAR(count(r, 0), std::numbers::pi * radius * radius, 0.02 * std::numbers::pi * radius * radius);
  for (int dx : {-20, 0, 20}) {  // depth along a ray to the plane y = 0
    double const tan = (width / 2 + dx + 0.5 - width / 2.0) / focal;
    ASSERT_EQ(r.id[at(width / 2 + dx, height / 2)], 0);
    EXPECT_NEAR(r.depth[at(width / 2 + dx, height / 2)], 6 * std::sqrt(1 + tan * tan), 1e-3);
  }
  p.options.cut = CutPlane{{0, 0, 0.5}, {0, 1, 0}};  // the far half is gone: the near one hides that
  EXPECT_NEAR(p.draw().depth[at(width / 2, height / 2)], 5.5, 1e-3);
  p.options.cut = CutPlane{{0, 2, 0.5}, {0, -1, 0}};  // all is gone
  EXPECT_EQ(count(p.draw(), 0), 0);
}

}  // namespace
}  // namespace scree

// render.cpp: see render.h. Rays go in tiles; every tile is independent, so threads do not change the picture.
// SPDX-License-Identifier: Apache-2.0
#include "core/render.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/grain_rays.h"
#include "core/render_noise.h"
#include "core/render_stage.h"
#include "core/render_walls.h"

namespace scree {

namespace {

double constexpr infinity = std::numeric_limits<double>::infinity();
int constexpr host_tile = 32;           // pixels an edge: 1,024 rays share the grains they meet
int constexpr device_tile = 256;        // ... a launch and its copies repay themselves over some 10,000 queries
double constexpr edge_contrast = 0.05;  // of display brightness: above it a pixel is sampled again

// Linear RGB.
Vec3 constexpr floor_colour{0.33, 0.33, 0.325};
Vec3 constexpr glass_colour{0.70, 0.80, 0.88};
Vec3 constexpr edge_colour{0.10, 0.13, 0.17};
Vec3 constexpr sun_light{2.45, 2.22, 1.92}, sky_light{0.56, 0.64, 0.78}, ground_light{0.26, 0.24, 0.22};

Vec3 sky(Vec3 direction) {
  double const up = std::pow(std::clamp(direction.z, 0.0, 1.0), 0.45);
  return Vec3{0.86, 0.90, 0.94} * (1 - up) + Vec3{0.30, 0.48, 0.74} * up;
}

// Film curve (Narkowicz 2015, fit to ACES), then sRGB.
double display(double linear) {
  double const x = 0.50 * linear;
  return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}
std::uint8_t srgb(double x) {
  double const s = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(s, 0.0, 1.0)));
}

struct Sample {
  Vec3 colour;  // display-linear, 0..1
  int id = render_sky;
  double depth = infinity;
  bool wall = false;  // an opaque wall with a surface of its own
};

class Painter {
 public:
  Painter(ResultsHeader const& header, Frame const& frame, RenderOptions const& options)
      : grains_(header, frame, options.network_device),
        walls_(header, frame),
        stage_(header, walls_, grains_.empty() ? header.domain : grains_.bounds()) {
    camera_ = options.camera ? *options.camera : fitted_camera(stage_.shown(), options);
    size_ = std::max(norm(stage_.shown().max - stage_.shown().min), 1e-9);
    pixel_ = camera_.field_of_view / options.height;
    Vec3 const view = camera_.eye - camera_.target;
    double const azimuth = std::atan2(view.y, view.x) + 0.95;
    double const rise = stage_.shown().max.z - stage_.shown().min.z;
    contour_step_ = std::pow(10.0, std::floor(std::log10(std::max(rise, 1e-9) / 2)));
    sun_ = normalized(Vec3{std::cos(azimuth), std::sin(azimuth), 1.35});
    cut_ = options.cut;
    colour_limit_ = options.colour_limit;
    colour_ = body_colours(header, frame, options.colour, colour_limit_, options.threads);
  }
  Camera const& camera() const { return camera_; }
  double colour_limit() const { return colour_limit_; }
  bool on_device() const { return grains_.on_device(); }

  void paint(std::vector<Ray> const& rays, std::vector<Sample>& samples) const {
    std::size_t const n = rays.size();
    samples.assign(n, {});
    std::vector<RayHit> hits;
    trace_grains(rays, hits);
    std::vector<int> lit;  // samples that show a surface
    std::vector<Vec3> point, normal;
    find_surfaces(rays, hits, samples, lit, point, normal);
    std::vector<double> shadow, open;
    light(point, normal, shadow, open);
    for (std::size_t i = 0; i < n; ++i) samples[i].colour = sky(rays[i].direction);
    for (std::size_t k = 0; k < lit.size(); ++k) {
      Sample& s = samples[lit[k]];
      s.colour = shade(rays[lit[k]], s, point[k], normal[k], shadow[k], open[k]);
    }
    for (std::size_t i = 0; i < n; ++i) finish(rays[i], samples[i]);
  }

 private:
  // The part of a ray that is not cut away: from `begin` on, up to its limit. Nothing may be left.
  Ray kept(Ray ray, double& begin) const {
    begin = 0;
    if (!cut_) return ray;
    double const out = dot(cut_->normal, ray.origin - cut_->point), towards = dot(cut_->normal, ray.direction);
    if (out > 0) {
      begin = towards < 0 ? -out / towards : infinity;
      if (begin < infinity) ray.origin += ray.direction * begin;
      ray.limit = begin < infinity ? ray.limit - begin : 0;
    } else if (towards > 0) {
      ray.limit = std::min(ray.limit, -out / towards);
    }
    return ray;
  }

  void trace_grains(std::vector<Ray> const& rays, std::vector<RayHit>& hits, bool any = false) const {
    if (!cut_) return grains_.trace(rays, hits, any);
    std::vector<Ray> part(rays.size());
    std::vector<double> begin(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) part[i] = kept(rays[i], begin[i]);
    grains_.trace(part, hits, any);
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (hits[i].body >= 0 && hits[i].distance > part[i].limit)
        hits[i] = {};
      else
        hits[i].distance += begin[i];
  }

  // On the cut itself, where a grain shows its inside.
  bool on_cut(Vec3 point) const {
    return cut_ && std::abs(dot(cut_->normal, point - cut_->point)) < 1e-3 * grains_.mean_diameter();
  }

  void find_surfaces(std::vector<Ray> const& rays, std::vector<RayHit> const& hits, std::vector<Sample>& samples,
                     std::vector<int>& lit, std::vector<Vec3>& point, std::vector<Vec3>& normal) const {
    std::vector<Vec3> grain_point, grain_normal;
    std::vector<int> body;
    for (std::size_t i = 0; i < rays.size(); ++i)
      if (hits[i].body >= 0) {
        grain_point.push_back(rays[i].origin + rays[i].direction * hits[i].distance);
        body.push_back(hits[i].body);
      }
    grains_.normals(grain_point, body, grain_normal);
    std::size_t next = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      bool const grain = hits[i].body >= 0;
      std::size_t const g = grain ? next++ : 0;
      double floor = stage_.floor_distance(rays[i]);
      auto const wall = walls_.first(rays[i], grain ? std::min(hits[i].distance, floor) : floor);
      if (wall) floor = wall->distance;
      if (grain && hits[i].distance <= floor) {
        samples[i] = {{}, hits[i].body, hits[i].distance};
        lit.push_back(static_cast<int>(i));
        point.push_back(grain_point[g]);
        normal.push_back(on_cut(grain_point[g]) ? cut_->normal : grain_normal[g]);
      } else if (floor < infinity) {
        samples[i] = {{}, render_floor, floor, wall.has_value()};
        lit.push_back(static_cast<int>(i));
        point.push_back(rays[i].origin + rays[i].direction * floor);
        normal.push_back(wall ? wall->normal : stage_.floor_normal(point.back()));
      }
    }
  }

  // Sun seen (0 or 1) and share of the sky that is open, from the clearance along the normal (Evans 2006).
  void light(std::vector<Vec3> const& point, std::vector<Vec3> const& normal, std::vector<double>& sun,
             std::vector<double>& open) const {
    double const d = grains_.mean_diameter();
    std::vector<Ray> rays;
    for (std::size_t k = 0; k < point.size(); ++k) rays.push_back({point[k] + normal[k] * (0.004 * d), sun_});
    std::vector<RayHit> hits;
    trace_grains(rays, hits, true);
    sun.resize(point.size());
    for (std::size_t k = 0; k < point.size(); ++k) {
      bool const seen = hits[k].body < 0 && dot(normal[k], sun_) > 0 && !walls_.first(rays[k], infinity);
      sun[k] = seen ? 1 : 0;
    }

    open.assign(point.size(), 1.0);
    if (cut_) return;  // what was cut away would still stand in the sky's way
    double weight = 0.80;
    std::vector<Vec3> probe(point.size());
    std::vector<double> clear;
    for (double const h : {0.08, 0.2, 0.42}) {
      for (std::size_t k = 0; k < point.size(); ++k) probe[k] = point[k] + normal[k] * (h * d);
      grains_.clearance(probe, h * d, clear);
      for (std::size_t k = 0; k < point.size(); ++k) {
        double const free = std::min(clear[k], stage_.height(probe[k]));
        open[k] *= 1 - weight * std::clamp(1 - free / (h * d), 0.0, 1.0);
      }
      weight *= 0.75;
    }
  }

  // Rock where it is steep, earth where it is level, and contour lines.
  Vec3 ground(Vec3 point, Vec3 normal, double depth) const {
    double const level = std::clamp((normal.z - 0.70) / 0.25, 0.0, 1.0), gentle = level * level * (3 - 2 * level);
    Vec3 const colour = Vec3{0.30, 0.285, 0.265} * (1 - gentle) + Vec3{0.27, 0.29, 0.20} * gentle;
    double const step = contour_step_, off = std::abs(point.z - step * std::round(point.z / step));
    // A pixel wide: what a pixel's width is in height on this slope.
    double const width = depth * pixel_ * std::max(0.05, std::sqrt(std::max(0.0, 1 - normal.z * normal.z)));
    return colour * (1 - 0.35 * std::clamp(1.5 - off / width, 0.0, 1.0));
  }

  Vec3 shade(Ray const& ray, Sample const& s, Vec3 point, Vec3 normal, double sun, double open) const {
    Vec3 albedo = s.wall ? ground(point, normal, s.depth) : floor_colour;
    if (s.id >= 0) {
      Vec3 const p = grains_.in_body_frame(s.id, point);
      auto const seed = static_cast<std::uint32_t>(s.id) * 2654435761u;
      albedo = colour_[s.id] * (0.80 + 0.26 * speckle(p * 7.0, seed) + 0.16 * speckle(p * 23.0, seed + 7));
    }
    double const up = 0.5 + 0.5 * normal.z;
    double const direct = sun * std::max(0.0, dot(normal, sun_));
    Vec3 const arriving = sun_light * direct + (sky_light * up + ground_light * (1 - up)) * open;
    Vec3 colour = multiply(albedo, arriving);
    if (s.id >= 0) {  // a faint gloss rounds the forms
      Vec3 const half = normalized(sun_ - ray.direction);
      colour += sun_light * (0.05 * sun * std::pow(std::max(0.0, dot(normal, half)), 24.0));
      return colour;
    }
    if (s.wall) return colour;
    double const far = std::min(1.0, norm(point - camera_.target) / (6 * size_));  // the floor fades into the horizon
    double const haze = 1 - std::exp(-4 * far * far * far);
    return colour * (1 - haze) + sky({1, 0, 0}) * haze;
  }

  void finish(Ray const& ray, Sample& s) const {
    double const glass = 1 - (1 - stage_.glass(ray, s.depth)) * (1 - walls_.glass(ray, s.depth)),
                 edge = 0.75 * stage_.edges(ray, s.depth, pixel_);
    Vec3 c = s.colour * (1 - glass) + glass_colour * glass;
    c = c * (1 - edge) + edge_colour * edge;
    s.colour = {display(c.x), display(c.y), display(c.z)};
  }

  GrainRays grains_;
  RenderWalls walls_;
  RenderStage stage_;
  Camera camera_;
  Vec3 sun_;
  double size_ = 1, pixel_ = 0;
  double contour_step_ = 1;  // [m]
  std::optional<CutPlane> cut_;
  double colour_limit_ = 0;
  std::vector<Vec3> colour_;  // of each body
};

// Rays through points of the picture in pixels, (0, 0) its upper left corner.
class Lens {
 public:
  Lens(Camera const& camera, int width, int height)
      : frame_(camera),
        eye_(camera.eye),
        width_(width),
        height_(height),
        scale_(2 * std::tan(camera.field_of_view / 2) / height) {}
  Ray ray(double x, double y) const {
    return {eye_, normalized(frame_.forward + frame_.right * ((x - 0.5 * width_) * scale_) -
                             frame_.up * ((y - 0.5 * height_) * scale_))};
  }

 private:
  CameraFrame frame_;
  Vec3 eye_;
  double width_, height_, scale_;
};

double brightness(Vec3 c) { return std::sqrt(0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z); }  // about as the eye has it

// Pixels that differ from a neighbour in what they show or in brightness.
std::vector<int> edge_pixels(std::vector<Sample> const& s, int width, int height) {
  static constexpr int neighbour[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  std::vector<int> found;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      Sample const& here = s[std::size_t(y) * width + x];
      bool edge = false;
      for (auto const& o : neighbour) {
        int const u = x + o[0], v = y + o[1];
        if (u < 0 || v < 0 || u >= width || v >= height) continue;
        Sample const& there = s[std::size_t(v) * width + u];
        edge =
            edge || here.id != there.id || std::abs(brightness(here.colour) - brightness(there.colour)) > edge_contrast;
      }
      if (edge) found.push_back(y * width + x);
    }
  return found;
}

// fn(first, last) over [0, n) in steps, on threads; every step writes only what is its own. What one throws (a device
// that is lost) is thrown again here.
template <class Function>
void in_steps(int threads, int n, int step, Function const& function) {
  int const steps = (n + step - 1) / step;
  std::exception_ptr thrown;
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (threads > 1)
  for (int i = 0; i < steps; ++i) {
    try {
      function(i * step, std::min(n, (i + 1) * step));
    } catch (...) {
#pragma omp critical(scree_render)
      thrown = std::current_exception();
    }
  }
  if (thrown) std::rethrow_exception(thrown);
}

int tile_of(Painter const& painter) { return painter.on_device() ? device_tile : host_tile; }

void first_pass(Painter const& painter, Lens const& lens, RenderOptions const& o, std::vector<Sample>& pixels) {
  int const tile = tile_of(painter), across = (o.width + tile - 1) / tile, down = (o.height + tile - 1) / tile;
  in_steps(o.threads, across * down, 1, [&](int t, int) {
    int const x0 = t % across * tile, y0 = t / across * tile;
    std::vector<Ray> rays;
    std::vector<int> pixel;
    std::vector<Sample> samples;
    for (int y = y0; y < std::min(y0 + tile, o.height); ++y)
      for (int x = x0; x < std::min(x0 + tile, o.width); ++x) {
        rays.push_back(lens.ray(x + 0.5, y + 0.5));
        pixel.push_back(y * o.width + x);
      }
    painter.paint(rays, samples);
    for (std::size_t i = 0; i < rays.size(); ++i) pixels[pixel[i]] = samples[i];
  });
}

// Four samples on a rotated grid; identity and depth stay those of the centre.
void smooth(Painter const& painter, Lens const& lens, RenderOptions const& o, std::vector<Sample>& pixels) {
  static constexpr double offset[4][2] = {{0.375, 0.125}, {0.875, 0.375}, {0.125, 0.625}, {0.625, 0.875}};
  std::vector<int> const edges = edge_pixels(pixels, o.width, o.height);
  int const tile = tile_of(painter);
  in_steps(o.threads, static_cast<int>(edges.size()), tile * tile / 4, [&](int first, int last) {
    std::vector<Ray> rays;
    std::vector<Sample> samples;
    for (int e = first; e < last; ++e)
      for (auto const& at : offset) rays.push_back(lens.ray(edges[e] % o.width + at[0], edges[e] / o.width + at[1]));
    painter.paint(rays, samples);
    for (int e = first; e < last; ++e) {
      Vec3 sum;
      for (int k = 0; k < 4; ++k) sum += samples[4 * std::size_t(e - first) + k].colour;
      pixels[edges[e]].colour = sum * 0.25;
    }
  });
}

void check(RenderOptions const& o) {
  auto const fail = [](std::string const& what) { throw std::invalid_argument("render: " + what); };
  if (o.width < 1 || o.height < 1 || o.width > 16384 || o.height > 16384)
    fail("the picture is " + std::to_string(o.width) + " x " + std::to_string(o.height) + " pixels; 1..16384 each");
  if (o.threads < 1) fail("threads must be 1 or more");
  if (o.cut && !(is_finite(o.cut->point) && std::abs(norm(o.cut->normal) - 1) < 1e-9))
    fail("the cut needs a finite point and a unit normal");
  if (!o.camera) return;
  if (!(o.camera->field_of_view > 0 && o.camera->field_of_view < 3)) fail("the field of view must be 0..3 rad");
  if (!is_finite(o.camera->eye) || !is_finite(o.camera->target) || o.camera->eye == o.camera->target)
    fail("eye and target of the camera must be finite and differ");
}

}  // namespace

Rendering render(ResultsHeader const& header, Frame const& frame, RenderOptions const& options) {
  check(options);
  Painter const painter(header, frame, options);
  Lens const lens(painter.camera(), options.width, options.height);
  std::vector<Sample> pixels(std::size_t(options.width) * options.height);
  first_pass(painter, lens, options, pixels);
  if (options.smooth_edges) smooth(painter, lens, options, pixels);

  Rendering r{{options.width, options.height, {}}, {}, {}, painter.camera(), painter.colour_limit()};
  for (Sample const& s : pixels) {
    for (double c : {s.colour.x, s.colour.y, s.colour.z}) r.image.rgb.push_back(srgb(c));
    r.id.push_back(s.id);
    r.depth.push_back(static_cast<float>(s.depth));
  }
  return r;
}

double visible_share(Rendering const& rendering, int bodies, int pixels) {
  std::vector<int> seen(static_cast<std::size_t>(std::max(bodies, 0)), 0);
  for (int id : rendering.id)
    if (id >= 0 && id < bodies) ++seen[id];
  auto const enough = std::count_if(seen.begin(), seen.end(), [&](int n) { return n >= pixels; });
  return bodies > 0 ? static_cast<double>(enough) / bodies : 0;
}

}  // namespace scree

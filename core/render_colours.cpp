// render_colours.cpp: see render_colours.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/render_colours.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "core/overlap_meter.h"
#include "core/render_noise.h"

namespace scree {
namespace {

int constexpr overlap_points = 5000;  // a grain: enough to tell grains apart, a quarter of what `info --overlap` takes

// Linear RGB. Names take colours in their order; after the last one they start again.
Vec3 constexpr palette[] = {{0.25, 0.30, 0.37}, {0.58, 0.45, 0.29}, {0.49, 0.22, 0.14}, {0.27, 0.35, 0.20},
                            {0.62, 0.60, 0.54}, {0.22, 0.38, 0.42}, {0.48, 0.33, 0.40}, {0.70, 0.62, 0.28}};

// Linear RGB at 0, 1/4 ... 1 of a scale whose brightness rises evenly, so that it also reads in grey: the colours of
// Matplotlib's viridis (Smith & van der Walt 2015) there.
Vec3 constexpr scale[] = {{0.0578, 0.0003, 0.0887},
                          {0.0429, 0.0844, 0.2582},
                          {0.0152, 0.2795, 0.2623},
                          {0.1119, 0.5841, 0.1248},
                          {0.9842, 0.7991, 0.0185}};

Vec3 on_scale(double share) {
  double const s = 4 * std::clamp(share, 0.0, 1.0);
  int const k = std::min(3, static_cast<int>(s));
  return scale[k] + (scale[k + 1] - scale[k]) * (s - k);
}

std::vector<std::string> names_of(ResultsHeader const& header, ColourBy by) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < header.shape.size(); ++i) {
    std::string const& shape = header.library.shape[header.shape[i]].name;
    if (by == ColourBy::kind)
      names.push_back(shape.substr(0, shape.find_first_of("/:")));
    else  // in numeric order as text
      names.push_back(std::to_string(1'000'000'000 + (by == ColourBy::entry ? header.group : header.replica)[i]));
  }
  return names;
}

std::vector<Vec3> by_name(ResultsHeader const& header, ColourBy by) {
  std::vector<std::string> const name = names_of(header, by);
  std::vector<std::string> all;
  if (by == ColourBy::kind)  // of the whole library: a kind keeps its colour when its grains leave
    for (Shape const& s : header.library.shape) all.push_back(s.name.substr(0, s.name.find_first_of("/:")));
  else
    all = name;
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<Vec3> colour;
  for (std::size_t i = 0; i < name.size(); ++i) {
    auto const place = std::lower_bound(all.begin(), all.end(), name[i]) - all.begin();
    Vec3 c = palette[static_cast<std::size_t>(place) % std::size(palette)];
    auto const seed = static_cast<std::uint32_t>(3 * i + 1);
    c *= 0.78 + 0.44 * unit_noise(seed);
    double const warm = 0.16 * (unit_noise(seed + 1) - 0.5);
    colour.push_back({c.x * (1 + warm), c.y, c.z * (1 - warm)});
  }
  return colour;
}

}  // namespace

ColourBy colour_by(std::string const& name) {
  if (name == "kind") return ColourBy::kind;
  if (name == "entry") return ColourBy::entry;
  if (name == "replica") return ColourBy::replica;
  if (name == "speed") return ColourBy::speed;
  if (name == "spin") return ColourBy::spin;
  if (name == "overlap") return ColourBy::overlap;
  throw std::invalid_argument("colour by '" + name + "': kind, entry, replica, speed, spin or overlap");
}

bool is_scale(ColourBy by) { return unit_of(by)[0] != 0; }

char const* unit_of(ColourBy by) {
  switch (by) {
    case ColourBy::speed:
      return "m/s";
    case ColourBy::spin:
      return "rad/s";
    case ColourBy::overlap:
      return "d";
    default:
      return "";
  }
}

std::vector<double> body_values(ResultsHeader const& header, Frame const& frame, ColourBy by, int threads) {
  if (!is_scale(by)) throw std::invalid_argument("names have no number");
  if (by == ColourBy::overlap) return measure_overlap(header, frame, overlap_points, threads).of_body;
  std::vector<double> value;
  for (Vec3 const& v : by == ColourBy::speed ? frame.velocity : frame.spin) value.push_back(norm(v));
  return value;
}

std::vector<Vec3> body_colours(ResultsHeader const& header, Frame const& frame, ColourBy by, double& limit,
                               int threads) {
  if (!is_scale(by)) return by_name(header, by);
  std::vector<double> const value = body_values(header, frame, by, threads);
  if (!(limit > 0)) {
    limit = 0;
    for (std::size_t i = 0; i < value.size(); ++i)
      if (frame.is_active(i)) limit = std::max(limit, value[i]);
  }
  std::vector<Vec3> colour;
  for (double const v : value) colour.push_back(on_scale(limit > 0 ? v / limit : 0));
  return colour;
}

}  // namespace scree

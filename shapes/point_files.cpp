// point_files.cpp: see point_files.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/point_files.h"

#include <cmath>
#include <string>

#include "shapes/ply_file.h"
#include "shapes/ply_header.h"
#include "shapes/text_lines.h"
#include "shapes/whole_file.h"

namespace scree {
namespace {

PointCloud parse_xyz(std::filesystem::path const& file, std::string const& text) {
  PointCloud cloud;
  std::size_t columns = 0;
  for_each_line(text, [&](int line, std::vector<std::string_view> const& w) {
    if (columns == 0) columns = w.size();
    if (w.size() != columns || (columns != 3 && columns != 6))
      fail_file(file, line,
                std::to_string(w.size()) + " words; a point has three numbers, or six with its normal, in every line");
    cloud.position.push_back(read_vector(file, line, w, 0));
    if (columns == 3) return;
    cloud.normal.push_back(read_vector(file, line, w, 3));
    if (std::abs(norm(cloud.normal.back()) - 1) > 0.01)  // colours, say
      fail_file(file, line, "columns 4 to 6 must be a unit normal; remove them if they are something else");
  });
  return cloud;
}

std::string xyz_text(PointCloud const& cloud) {
  std::string text;
  for (std::size_t i = 0; i < cloud.position.size(); ++i) {
    std::string line;
    append_vector(line, cloud.position[i]);
    if (!cloud.normal.empty()) append_vector(line, cloud.normal[i]);
    text.append(line, 1, std::string::npos).append(1, '\n');
  }
  return text;
}

}  // namespace

PointCloud read_points(std::filesystem::path const& file) {
  std::string const extension = lower_extension(file);
  if (extension != ".ply" && extension != ".xyz") fail_file(file, "unknown point format; .ply and .xyz are read");
  std::string const bytes = read_whole_file(file);
  PointCloud cloud;
  if (extension == ".xyz") {
    cloud = parse_xyz(file, bytes);
  } else {
    PlyContent ply = parse_ply(file, bytes);
    cloud = {std::move(ply.vertex), std::move(ply.normal)};
  }
  if (cloud.position.empty()) fail_file(file, "has no points");
  for (Vec3& n : cloud.normal) {
    double const length = norm(n);
    if (length > 0) n = n / length;
  }
  return cloud;
}

void write_points(std::filesystem::path const& file, PointCloud const& cloud) {
  std::string const extension = lower_extension(file);
  if (extension != ".ply" && extension != ".xyz") fail_file(file, "unknown point format; .ply and .xyz are written");
  replace_whole_file(file, extension == ".xyz" ? xyz_text(cloud) : ply_bytes(cloud.position, cloud.normal, {}));
}

bool holds_points(std::filesystem::path const& file) {
  std::string const extension = lower_extension(file);
  if (extension != ".ply") return extension == ".xyz";
  PlyHeader const header = parse_ply_header(file, read_whole_file(file));
  PlyElement const* const face = header.find("face");
  return !face || face->count == 0;
}

}  // namespace scree

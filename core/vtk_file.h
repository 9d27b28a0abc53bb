// vtk_file.h: one VTK PolyData file (.vtp): appended raw binary, zlib-compressed, 64-bit headers.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kernels/base/vec.h"

namespace scree {

// One named array, n tuples of `components` numbers, kept as bytes.
struct VtkArray {
  std::string name;
  char const* type = "Float32";  // VTK's name of the element type
  int components = 1;
  std::vector<char> bytes;
};
VtkArray vtk_array(std::string name, std::vector<float> const& value, int components = 1);
VtkArray vtk_array(std::string name, std::vector<double> const& value, int components = 1);
VtkArray vtk_array(std::string name, std::vector<std::int32_t> const& value, int components = 1);
VtkArray vtk_array(std::string name, std::vector<Vec3> const& value);   // Float64, 3 components
VtkArray vtk_array(std::string name, std::vector<Vec3f> const& value);  // Float32, 3 components

struct VtkPolyData {
  std::vector<Vec3f> point;                     // [m]
  std::vector<std::vector<std::int32_t>> ring;  // polygons as lists of points; for few
  std::vector<std::array<int, 3>> triangle;     // for many
  bool vertices = false;                        // every point is a cell of its own
  std::vector<VtkArray> point_data;             // a tuple a point
  std::vector<VtkArray> cell_data;              // a tuple a cell: vertices, then rings, then triangles
};

// Throws std::system_error naming the file.
void write_vtp(std::filesystem::path const& file, VtkPolyData const& data);

}  // namespace scree

// vtk_file.cpp: see vtk_file.h. Format: VTK user's guide, "XML file formats".
// SPDX-License-Identifier: Apache-2.0
#include "core/vtk_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <cstring>
#include <stdexcept>

#include "shapes/whole_file.h"

namespace scree {
namespace {

static_assert(std::endian::native == std::endian::little, "the files say LittleEndian");
std::size_t constexpr block_size = 1 << 20;
int constexpr compression_level = 3;  // 4x as fast as the default for 5 % more bytes on these arrays

template <class T>
VtkArray make(std::string name, char const* type, int components, std::vector<T> const& value) {
  VtkArray array{std::move(name), type, components, std::vector<char>(value.size() * sizeof(T))};
  if (!value.empty()) std::memcpy(array.bytes.data(), value.data(), array.bytes.size());
  return array;
}

void append(std::string& out, std::uint64_t value) { out.append(reinterpret_cast<char const*>(&value), sizeof(value)); }

// Number of blocks, their size, the size of a shorter last one (0: none), compressed sizes, blocks.
std::string compressed(std::vector<char> const& bytes) {
  std::size_t const blocks = (bytes.size() + block_size - 1) / block_size;
  std::string header, body;
  append(header, blocks);
  append(header, block_size);
  append(header, bytes.size() % block_size);
  std::vector<Bytef> buffer(::compressBound(block_size));
  for (std::size_t b = 0; b < blocks; ++b) {
    std::size_t const first = b * block_size, count = std::min(block_size, bytes.size() - first);
    uLongf size = buffer.size();
    if (::compress2(buffer.data(), &size, reinterpret_cast<Bytef const*>(bytes.data() + first), count,
                    compression_level) != Z_OK)
      throw std::runtime_error("zlib could not compress a block");
    append(header, size);
    body.append(reinterpret_cast<char const*>(buffer.data()), size);
  }
  return header + body;
}

// The XML part with offsets into the appended part, both built in step.
class Document {
 public:
  void array(VtkArray const& a) {
    xml_ += fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        a.type, a.name, a.components, appended_.size());
    appended_ += compressed(a.bytes);
  }
  void section(char const* name, std::vector<VtkArray> const& arrays) {
    xml_ += fmt::format("      <{}>\n", name);
    for (VtkArray const& a : arrays) array(a);
    xml_ += fmt::format("      </{}>\n", name);
  }
  void text(std::string const& line) { xml_ += line; }
  std::string finish() const {
    return xml_ + "  <AppendedData encoding=\"raw\">\n_" + appended_ + "\n  </AppendedData>\n</VTKFile>\n";
  }

 private:
  std::string xml_, appended_;
};

std::vector<VtkArray> vertex_cells(std::size_t n) {
  std::vector<std::int32_t> connectivity(n), offset(n);
  for (std::size_t i = 0; i < n; ++i) {
    connectivity[i] = static_cast<std::int32_t>(i);
    offset[i] = connectivity[i] + 1;
  }
  return {vtk_array("connectivity", connectivity), vtk_array("offsets", offset)};
}

std::vector<VtkArray> polygon_cells(VtkPolyData const& data) {
  std::vector<std::int32_t> connectivity, offset;
  for (std::vector<std::int32_t> const& ring : data.ring) {
    connectivity.insert(connectivity.end(), ring.begin(), ring.end());
    offset.push_back(static_cast<std::int32_t>(connectivity.size()));
  }
  for (std::array<int, 3> const& t : data.triangle) {
    connectivity.insert(connectivity.end(), t.begin(), t.end());
    offset.push_back(static_cast<std::int32_t>(connectivity.size()));
  }
  return {vtk_array("connectivity", connectivity), vtk_array("offsets", offset)};
}

}  // namespace

VtkArray vtk_array(std::string name, std::vector<float> const& value, int components) {
  return make(std::move(name), "Float32", components, value);
}
VtkArray vtk_array(std::string name, std::vector<double> const& value, int components) {
  return make(std::move(name), "Float64", components, value);
}
VtkArray vtk_array(std::string name, std::vector<std::int32_t> const& value, int components) {
  return make(std::move(name), "Int32", components, value);
}
VtkArray vtk_array(std::string name, std::vector<Vec3> const& value) {
  return make(std::move(name), "Float64", 3, value);
}
VtkArray vtk_array(std::string name, std::vector<Vec3f> const& value) {
  return make(std::move(name), "Float32", 3, value);
}

void write_vtp(std::filesystem::path const& file, VtkPolyData const& data) {
  std::size_t const polygons = data.ring.size() + data.triangle.size();
  Document document;
  document.text(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n  <PolyData>\n");
  document.text(
      fmt::format("    <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
                  "NumberOfPolys=\"{}\">\n",
                  data.point.size(), data.vertices ? data.point.size() : 0, polygons));
  document.section("PointData", data.point_data);
  document.section("CellData", data.cell_data);
  document.section("Points", {vtk_array("Points", data.point)});
  document.section("Verts", vertex_cells(data.vertices ? data.point.size() : 0));
  document.section("Polys", polygon_cells(data));
  document.text("    </Piece>\n  </PolyData>\n");
  replace_whole_file(file, document.finish());
}

}  // namespace scree

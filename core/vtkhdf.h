// vtkhdf.h: the grains of a run as one VTKHDF time series: a step a frame, a point a grain.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "core/results.h"

namespace scree {

// VTKHDF 2.0, PolyData with /VTKHDF/Steps: read by VTK 9.3, ParaView 5.12 and later. Points carry what the points of
// ParaviewWriter carry, under the same names: body, shape, kind, material, group, replica, diameter [m], position [m],
// velocity [m/s], spin [rad/s], orientation (w, x, y, z); all real numbers are the doubles of the results. Inactive
// bodies are left out. What does not move is stored again only where the set of active bodies changes; `position` is
// another name of the points.
class VtkhdfWriter {
 public:
  // Creates `file` under a temporary name; finish() renames it. Unfinished, nothing is left behind. One frame at least
  // is to be written: the format knows no file without steps. All throw std::system_error naming the file.
  VtkhdfWriter(std::filesystem::path const& file, ResultsHeader const& header);
  ~VtkhdfWriter();
  void write_frame(Frame const& frame);
  void finish();

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace scree

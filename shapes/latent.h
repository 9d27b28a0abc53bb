// latent.h: the codes of a category of grains as a Gaussian, draws from it, and the line between two codes.
// Codes of one decoder only: a code means nothing to another network.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "shapes/random.h"
#include "shapes/shape.h"

namespace scree {

// code = mean + sum_k xi_k axis[k] with xi_k from N(0, 1), independent: the whitened coordinates.
struct CodeGaussian {
  std::string category;
  int net = -1;                           // network of the library
  int samples = 0;                        // codes it was estimated from
  std::vector<double> mean;               // (code size)
  std::vector<std::vector<double>> axis;  // (rank, code size): standard deviation times principal axis, largest first
};

// "ballast/0" is of category "ballast": what stands before the last slash; "" without one.
std::string category_of(std::string const& shape_name);

// Categories of the shapes that have a code, in the order of the library.
std::vector<std::string> coded_categories(Library const& library);

// Mean and covariance (over n - 1) of a category's codes. n codes span n - 1 directions at most, so with few of them
// the covariance of 10 numbers is singular: draws then stay in the flat through the known codes, of which the decoder
// has seen something, and there are n - 1 axes or fewer. `shrinkage` s in [0, 1) leaves it: the covariance becomes (1 -
// s) C + s tr(C) / size * I (Ledoit and Wolf 2004), which has full rank. Throws std::invalid_argument: no such category
// (names those that exist), fewer than two codes, codes of several networks, shrinkage out of range.
CodeGaussian fit_codes(Library const& library, std::string const& category, double shrinkage = 0);

// One code, every whitened coordinate within +-truncate (> 0, may be infinite), by drawing again: the density is that
// of the Gaussian, cut off.
std::vector<float> draw_code(CodeGaussian const& gaussian, double truncate, Random& random);

// Whitened coordinates of a code (rank); what lies off the axes is left out.
std::vector<double> whitened(CodeGaussian const& gaussian, std::vector<float> const& code);

// (1 - t) a + t b; beyond 0 and 1 it goes on along the line. Throws std::invalid_argument unless both are coded shapes
// of one network.
std::vector<float> interpolate_codes(Shape const& a, Shape const& b, double t);

}  // namespace scree

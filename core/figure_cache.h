// figure_cache.h: lists of measured numbers, kept between runs in the cache folder (shapes/content_cache.h).
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace scree {

// The numbers kept under this key, bit for bit; empty: none, or the file is damaged or not of this kind: measure anew.
std::vector<double> read_figures(std::string const& key);

// Keeps them, atomically. Where that is impossible nothing happens: it costs the time of measuring again.
void keep_figures(std::string const& key, std::vector<double> const& figures);

}  // namespace scree

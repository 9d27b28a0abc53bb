// report_page.h: one self-contained HTML page about a run: what ran, energies, measurements, times, the last frame.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/png_file.h"
#include "core/results.h"

namespace scree {

struct ReportPage {
  ResultsReader const* results = nullptr;
  Image picture;             // of the last frame
  std::string run_json;      // stages.json of the run; empty: none
  std::string measures_csv;  // what was measured over time (time,name,quantity,value); empty: none
  std::string title;
  int threads = 1;  // the page does not depend on it
};

// The page's text. Everything is inside: no network access, no other file. At most some 400 rows of the ledger, 600
// samples of a measurement and 20,000 grains are shown; the page says so where it leaves something out.
std::string report_page(ReportPage const& page);

// Building blocks, for tests.
std::string json_string(std::string const& text);                   // quoted; safe inside a script element
std::string base64(void const* data, std::size_t bytes);            // RFC 4648
std::vector<std::size_t> thinned(std::size_t n, std::size_t most);  // indices, evenly, with the first and the last

}  // namespace scree

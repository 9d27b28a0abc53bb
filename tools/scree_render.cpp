// scree_render.cpp: `scree render`: one frame of a results file as a picture, with the machine check beside it.
// SPDX-License-Identifier: Apache-2.0
#include "core/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "core/case.h"
#include "core/results.h"
#include "tools/scree_commands.h"

namespace scree {
namespace {

// "1280x960" -> width, height.
void read_size(std::string const& text, RenderOptions& options) {
  int end = 0;
  bool const read = std::sscanf(text.c_str(), "%dx%d%n", &options.width, &options.height, &end) == 2;
  bool const whole = read && end == static_cast<int>(text.size());
  if (!whole || options.width < 16 || options.height < 16 || options.width > 16384 || options.height > 16384)
    throw InputError({fmt::format("--size {}: write it as WIDTHxHEIGHT, each 16 ... 16384, e.g. 1280x960", text)});
}

// Body number + 1 as a 24-bit number, red the lowest byte; 0: no body.
Image id_image(Rendering const& rendering) {
  Image image{rendering.image.width, rendering.image.height, {}};
  for (int const id : rendering.id) {
    auto const code = static_cast<std::uint32_t>(std::max(id + 1, 0));
    for (int byte = 0; byte < 3; ++byte) image.rgb.push_back(static_cast<std::uint8_t>(code >> (8 * byte) & 255));
  }
  return image;
}

}  // namespace

int render_command(RenderArguments const& arguments) {
  RenderOptions options;
  read_size(arguments.size, options);
  CaseArguments machine;
  machine.threads = arguments.threads;
  options.threads = choose_threads(machine);
  double constexpr degree = 3.141592653589793 / 180;
  if (arguments.azimuth) options.azimuth = *arguments.azimuth * degree;
  if (arguments.elevation) options.elevation = *arguments.elevation * degree;
  ResultsReader const reader(arguments.results, arguments.recover);
  Frame const frame = reader.frame(arguments.frame);
  Rendering const rendering = render(reader.header(), frame, options);
  write_png(arguments.picture, rendering.image);
  if (!arguments.ids.empty()) write_png(arguments.ids, id_image(rendering));
  int const bodies = static_cast<int>(reader.header().shape.size());
  auto const floor = std::count(rendering.id.begin(), rendering.id.end(), render_floor);
  fmt::print("picture   {}: t = {:.4g} s, {:.0f} % of {} grains visible, floor in {:.0f} % of the pixels\n",
             arguments.picture.string(), frame.time, 100 * visible_share(rendering, bodies), bodies,
             100.0 * static_cast<double>(floor) / static_cast<double>(rendering.id.size()));
  return exit_ok;
}

}  // namespace scree

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

// "first:last:step" of `count` frames -> their numbers; negative counts from the end.
std::vector<int> read_frames(std::string const& text, int count) {
  int first = 0, last = 0, step = 1, end = 0;
  bool const two = std::sscanf(text.c_str(), "%d:%d%n", &first, &last, &end) == 2;
  bool whole = two && end == static_cast<int>(text.size());
  if (two && !whole)
    whole = std::sscanf(text.c_str(), "%d:%d:%d%n", &first, &last, &step, &end) == 3 &&
            end == static_cast<int>(text.size());
  if (first < 0) first += count;
  if (last < 0) last += count;
  if (!whole || step < 1 || first < 0 || last < first || last >= count)
    throw InputError({fmt::format("--frames {}: write FIRST:LAST or FIRST:LAST:STEP within 0 ... {}, e.g. 0:-1:10",
                                  text, count - 1)});
  std::vector<int> out;
  for (int k = first; k <= last; k += step) out.push_back(k);
  return out;
}

CutPlane read_cut(std::vector<double> const& v) {
  Vec3 const normal{v[3], v[4], v[5]};
  if (!(norm(normal) > 0)) throw InputError({"--cut: the normal (the last three numbers) has no direction"});
  return {{v[0], v[1], v[2]}, normalized(normal)};
}

// picture.png -> picture-0012.png
std::filesystem::path numbered(std::filesystem::path const& file, int number) {
  return file.parent_path() / fmt::format("{}-{:04}{}", file.stem().string(), number, file.extension().string());
}

// `device`: one line on where it runs.
RenderOptions read_options(RenderArguments const& arguments, std::string& device) {
  RenderOptions options;
  read_size(arguments.size, options);
  CaseArguments machine;
  machine.device = arguments.device;
  machine.threads = arguments.threads;
  SimulationOptions const backend = choose_backend(machine, &device);
  options.threads = backend.threads;
  options.network_device = backend.network_device;
  double constexpr degree = 3.141592653589793 / 180;
  if (arguments.azimuth) options.azimuth = *arguments.azimuth * degree;
  if (arguments.elevation) options.elevation = *arguments.elevation * degree;
  options.colour = colour_by(arguments.colour);
  options.colour_limit = arguments.colour_limit;
  if (!arguments.cut.empty()) options.cut = read_cut(arguments.cut);
  return options;
}

void say(std::filesystem::path const& picture, Frame const& frame, int bodies, RenderOptions const& options,
         Rendering const& rendering) {
  auto const floor = std::count(rendering.id.begin(), rendering.id.end(), render_floor);
  fmt::print("picture   {}: t = {:.4g} s, {:.0f} % of {} grains visible, floor in {:.0f} % of the pixels{}\n",
             picture.string(), frame.time, 100 * visible_share(rendering, bodies), bodies,
             100.0 * static_cast<double>(floor) / static_cast<double>(rendering.id.size()),
             is_scale(options.colour)
                 ? fmt::format(", scale 0 ... {:.4g} {}", rendering.colour_limit, unit_of(options.colour))
                 : "");
}

}  // namespace

int render_command(RenderArguments const& arguments) {
  std::string device;
  RenderOptions options = read_options(arguments, device);
  ResultsReader const reader(arguments.results, arguments.recover);
  bool const sequence = !arguments.frames.empty();
  std::vector<int> const frames =
      sequence ? read_frames(arguments.frames, reader.frames()) : std::vector<int>{arguments.frame};
  int const bodies = static_cast<int>(reader.header().shape.size());
  fmt::print("device    {}\n", device);
  for (int const k : frames) {
    Frame const frame = reader.frame(k);
    Rendering const rendering = render(reader.header(), frame, options);
    auto const picture = sequence ? numbered(arguments.picture, k) : arguments.picture;
    write_png(picture, rendering.image);
    if (!arguments.ids.empty()) write_png(sequence ? numbered(arguments.ids, k) : arguments.ids, id_image(rendering));
    say(picture, frame, bodies, options, rendering);
    options.camera = rendering.camera;  // a sequence keeps the camera and the scale of its first picture
    if (is_scale(options.colour) && rendering.colour_limit > 0) options.colour_limit = rendering.colour_limit;
  }
  return exit_ok;
}

}  // namespace scree

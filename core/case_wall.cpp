// case_wall.cpp: see case_wall.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/case_wall.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "core/nearest_name.h"
#include "core/toml_text.h"

namespace scree {
namespace {

void read_motion(CaseReader r, MotionCase& out) {
  bool const known = r.choice<MotionKind>(
      "kind", out.kind, {{"rotation", MotionKind::rotation}, {"translation", MotionKind::translation}}, {},
      Need::required);
  if (!known) return;
  bool const table = r.numbers("time", out.time);
  Need const constant = table ? Need::optional : Need::required;
  if (out.kind == MotionKind::rotation) {
    r.vector("axis", out.axis, Need::required);
    r.vector("through", out.through, Need::required);
    if (table)
      r.numbers("rates", out.rates, Need::required);
    else
      r.number("rate", out.rate, constant);
  } else {
    if (table)
      r.vectors("velocities", out.velocities, Need::required);
    else
      r.vector("velocity", out.velocity, constant);
  }
  if (!table) {
    r.number("start", out.start);
    r.number("end", out.end);
  }
  r.finish();
}

void read_side(CaseReader& r, WallCase& out) {
  r.choice<bool>("side", out.inside, {{"inside", true}, {"outside", false}});
}

void read_wall_file(CaseReader& r, WallCase& out) {
  std::string file;
  if (r.text("file", file, Need::required)) out.file = file;
  r.number("scale", out.scale);
  r.vector("shift", out.shift);
}

void read_wall_shape(CaseReader& r, WallCase& out) {
  switch (out.kind) {
    case WallKind::plane:
      r.vector("point", out.point, Need::required);
      r.vector("normal", out.normal, Need::required);
      return;
    case WallKind::box:
      read_side(r, out);
      r.vector("min", out.min, Need::required);
      r.vector("max", out.max, Need::required);
      if (out.inside) r.texts("open", out.open);
      return;
    case WallKind::cylinder:
      read_side(r, out);
      if (out.inside) r.texts("open", out.open);
      r.number("radius", out.radius, Need::required);
      break;
    case WallKind::capsule:
      r.number("radius", out.radius, Need::required);
      break;
    case WallKind::cone:
      r.number("radius_from", out.radius_from, Need::required);
      r.number("radius_to", out.radius_to, Need::required);
      r.number("thickness", out.thickness, Need::required);
      break;
    case WallKind::mesh:
      read_wall_file(r, out);
      if (!r.number("thickness", out.thickness)) read_side(r, out);
      return;
    case WallKind::terrain:
      read_wall_file(r, out);
      return;
  }
  r.vector("from", out.from, Need::required);
  r.vector("to", out.to, Need::required);
}

}  // namespace

void read_wall(CaseReader r, WallCase& out) {
  r.text("name", out.name, Need::required);
  r.text("material", out.material, Need::required);
  bool const known = r.choice<WallKind>("kind", out.kind,
                                        {{"plane", WallKind::plane},
                                         {"box", WallKind::box},
                                         {"cylinder", WallKind::cylinder},
                                         {"cone", WallKind::cone},
                                         {"capsule", WallKind::capsule},
                                         {"mesh", WallKind::mesh},
                                         {"terrain", WallKind::terrain}},
                                        {}, Need::required);
  if (!known) return;  // the other keys depend on the kind
  read_wall_shape(r, out);
  if (auto motion = r.table("motion")) read_motion(*motion, out.motion.emplace());
  r.finish();
}

namespace {

class WallCheck {
 public:
  using Fail = std::function<void(std::string const&, std::string)>;
  WallCheck(WallCase const& wall, Fail const& fail) : w_(wall), fail_(fail) {}

  void run() {
    switch (w_.kind) {
      case WallKind::plane:
        finite("point", w_.point);
        direction("normal", w_.normal, "it points into the free space");
        break;
      case WallKind::box:
        box();
        break;
      case WallKind::cylinder:
        axis();
        positive("radius", w_.radius);
        open({"from", "to"});
        break;
      case WallKind::capsule:
        axis();
        positive("radius", w_.radius);
        break;
      case WallKind::cone:
        cone();
        break;
      case WallKind::mesh:
        if (!(w_.thickness >= 0) || !std::isfinite(w_.thickness))
          fail_("thickness", fmt::format("{} must be > 0 m: what an open surface is thick", w_.thickness));
        [[fallthrough]];
      case WallKind::terrain:
        positive("scale", w_.scale);
        finite("shift", w_.shift);
    }
    if (w_.motion) motion(*w_.motion);
  }

 private:
  void finite(std::string const& key, Vec3 v) {
    if (!is_finite(v)) fail_(key, "must be finite");
  }
  void direction(std::string const& key, Vec3 v, std::string const& what) {
    if (!(is_finite(v) && norm(v) > 0)) fail_(key, "must have a length: " + what);
  }
  void positive(std::string const& key, double value) {
    if (!(value > 0 && std::isfinite(value))) fail_(key, fmt::format("{} must be above 0, and finite", value));
  }
  void axis() {
    finite("from", w_.from);
    finite("to", w_.to);
    if (norm2(w_.to - w_.from) == 0) fail_("to", "must differ from `from`: the two are the ends of the axis");
  }
  void open(std::vector<std::string> const& faces) {
    for (std::string const& face : w_.open)
      if (std::find(faces.begin(), faces.end(), face) == faces.end())
        fail_("open",
              fmt::format("'{}' is no face{}; faces: {}", face, did_you_mean(face, faces), fmt::join(faces, ", ")));
  }
  void box() {
    Vec3 const size = w_.max - w_.min;
    if (!(is_finite(size) && size.x > 0 && size.y > 0 && size.z > 0))
      fail_("max", fmt::format("the box is {} x {} x {} m: max must exceed min on every axis", size.x, size.y, size.z));
    open({"-x", "+x", "-y", "+y", "-z", "+z"});
    if (w_.inside && std::set(w_.open.begin(), w_.open.end()).size() == 6)
      fail_("open", "leaves no face: nothing is left of the wall; remove it, or keep a face");
  }
  void cone() {
    axis();
    positive("thickness", w_.thickness);
    for (auto const& [key, radius] : {std::pair{"radius_from", w_.radius_from}, std::pair{"radius_to", w_.radius_to}})
      if (!(std::isfinite(radius) && radius >= 0)) fail_(key, fmt::format("{} must be >= 0 m", radius));
    if (w_.radius_from == 0 && w_.radius_to == 0) fail_("radius_to", "one end must have a radius");
  }
  void motion(MotionCase const& m) {
    if (m.kind == MotionKind::rotation) direction("motion.axis", m.axis, "right-handed about it");
    finite("motion.through", m.through);
    finite("motion.velocity", m.velocity);
    if (!std::isfinite(m.rate)) fail_("motion.rate", "must be finite");
    if (!(m.start >= 0 && std::isfinite(m.start))) fail_("motion.start", fmt::format("{} must be >= 0 s", m.start));
    if (!(m.end > m.start)) fail_("motion.end", fmt::format("{} must come after start = {} s", m.end, m.start));
    if (m.time.empty()) return;
    std::size_t const values = m.kind == MotionKind::rotation ? m.rates.size() : m.velocities.size();
    if (values != m.time.size())
      fail_("motion.time", fmt::format("has {} entries, but there are {} values", m.time.size(), values));
    bool ascending = std::all_of(m.time.begin(), m.time.end(), [](double t) { return std::isfinite(t); });
    for (std::size_t i = 0; i + 1 < m.time.size(); ++i) ascending = ascending && m.time[i] < m.time[i + 1];
    if (!ascending) fail_("motion.time", "must be finite and ascending");
    bool const sound = std::all_of(m.rates.begin(), m.rates.end(), [](double r) { return std::isfinite(r); }) &&
                       std::all_of(m.velocities.begin(), m.velocities.end(), [](Vec3 v) { return is_finite(v); });
    if (!sound) fail_(m.kind == MotionKind::rotation ? "motion.rates" : "motion.velocities", "must be finite");
  }

  WallCase const& w_;
  Fail const& fail_;
};

std::string faces(WallCase const& w) {
  std::vector<std::string> words;
  for (std::string const& face : w.open) words.push_back(toml_quoted(face));
  return fmt::format("open = [{}]\n", fmt::join(words, ", "));
}
std::string side(WallCase const& w) { return fmt::format("side = \"{}\"\n", w.inside ? "inside" : "outside"); }
std::string ends(WallCase const& w) {
  return fmt::format("from = {}\nto = {}\n", toml_vector(w.from), toml_vector(w.to));
}
std::string file(WallCase const& w) {
  return fmt::format("file = {}\nscale = {}\nshift = {}\n", toml_quoted(std::filesystem::absolute(w.file).string()),
                     w.scale, toml_vector(w.shift));
}

std::string shape_to_toml(WallCase const& w) {
  switch (w.kind) {
    case WallKind::plane:
      return fmt::format("kind = \"plane\"\npoint = {}\nnormal = {}\n", toml_vector(w.point), toml_vector(w.normal));
    case WallKind::box:
      return "kind = \"box\"\n" + side(w) +
             fmt::format("min = {}\nmax = {}\n", toml_vector(w.min), toml_vector(w.max)) + (w.inside ? faces(w) : "");
    case WallKind::cylinder:
      return "kind = \"cylinder\"\n" + side(w) + ends(w) + fmt::format("radius = {}\n", w.radius) +
             (w.inside ? faces(w) : "");
    case WallKind::capsule:
      return "kind = \"capsule\"\n" + ends(w) + fmt::format("radius = {}\n", w.radius);
    case WallKind::cone:
      return "kind = \"cone\"\n" + ends(w) +
             fmt::format("radius_from = {}\nradius_to = {}\nthickness = {}\n", w.radius_from, w.radius_to, w.thickness);
    case WallKind::mesh:
      return "kind = \"mesh\"\n" + file(w) + (w.thickness > 0 ? fmt::format("thickness = {}\n", w.thickness) : side(w));
    case WallKind::terrain:
      return "kind = \"terrain\"\n" + file(w);
  }
  return {};
}

std::string motion_to_toml(MotionCase const& m) {
  bool const rotation = m.kind == MotionKind::rotation;
  std::string out = fmt::format("motion = {{ kind = \"{}\"", rotation ? "rotation" : "translation");
  if (rotation) out += fmt::format(", axis = {}, through = {}", toml_vector(m.axis), toml_vector(m.through));
  if (!m.time.empty()) {
    std::vector<std::string> values;
    for (double r : m.rates) values.push_back(fmt::format("{}", r));
    for (Vec3 v : m.velocities) values.push_back(toml_vector(v));
    return out + fmt::format(", time = [{}], {} = [{}] }}\n", fmt::join(m.time, ", "),
                             rotation ? "rates" : "velocities", fmt::join(values, ", "));
  }
  out += rotation ? fmt::format(", rate = {}", m.rate) : fmt::format(", velocity = {}", toml_vector(m.velocity));
  return out + fmt::format(", start = {}, end = {} }}\n", m.start, m.end);
}

}  // namespace

void check_wall(WallCase const& wall, std::function<void(std::string const&, std::string)> const& fail) {
  WallCheck(wall, fail).run();
}

std::string wall_to_toml(WallCase const& w) {
  return fmt::format("\n[[wall]]\nname = {}\nmaterial = {}\n", toml_quoted(w.name), toml_quoted(w.material)) +
         shape_to_toml(w) + (w.motion ? motion_to_toml(*w.motion) : "");
}

}  // namespace scree

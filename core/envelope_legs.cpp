// envelope_legs.cpp: see envelope_legs.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/envelope_legs.h"

#include <algorithm>

#include "core/case_tree.h"

namespace scree {
namespace {

std::optional<Vec3> vector_of(CaseNode const* node) {
  if (!node || node->element.size() != 3) return {};
  return Vec3{node->element[0].real, node->element[1].real, node->element[2].real};
}

CaseNode const* find(CaseNode const& root, char const* table, char const* key) {
  CaseNode const* const node = root.find(table);
  return node ? node->find(key) : nullptr;
}

// The entries of a list of tables; none when it is absent.
std::vector<CaseNode> entries(CaseNode const& root, char const* name) {
  CaseNode const* const node = root.find(name);
  return node ? node->element : std::vector<CaseNode>();
}

GrainMoment moment_of(ResultsHeader const& header, Frame const& frame, std::size_t body) {
  GrainMoment m{frame.time, frame.position[body], frame.velocity[body]};
  Shape const& shape = header.library.shape[header.shape[body]];
  double const d = header.diameter[body];
  Vec3 const gyration = shape.inertia * (d * d / shape.volume);  // principal moments per mass [m2]
  Vec3 const spin = transposed_times(to_matrix(frame.orientation[body]), frame.spin[body]);
  m.rotation = 0.5 * dot(gyration, multiply(spin, spin));
  m.energy = 0.5 * norm2(m.velocity) + m.rotation;
  return m;
}

bool is_deleted(Frame const& frame, std::size_t body) {
  return !frame.activity.empty() && frame.activity[body] == Activity::deleted;
}

}  // namespace

EnvelopeCase envelope_case(ResultsHeader const& header, std::string const& file) {
  CaseNode const root = parse_case_text(header.case_text, file + ": /case");
  EnvelopeCase out;
  for (CaseNode const& entry : entries(root, "grains"))
    if (CaseNode const* const name = entry.find("name")) out.group.push_back(name->text);
  out.gravity = vector_of(find(root, "gravity", "acceleration")).value_or(Vec3{});
  if (CaseNode const* const every = find(root, "output", "every")) out.every = every->real;
  for (CaseNode const& measure : entries(root, "measure")) {
    CaseNode const* const kind = measure.find("kind");
    if (!out.direction && kind && kind->text == "run_out") out.direction = vector_of(measure.find("direction"));
  }
  return out;
}

void walk_legs(ResultsReader const& reader, Vec3 gravity,
               std::function<void(int body, GrainMoment const&)> const& release,
               std::function<void(GrainLeg const&)> const& leg) {
  ResultsHeader const& header = reader.header();
  std::size_t const n = header.shape.size();
  std::vector<std::optional<GrainMoment>> last(n);  // of grains that are on their way
  for (int f = 0; f < reader.frames(); ++f) {
    Frame const frame = reader.frame(f);
    for (std::size_t i = 0; i < n; ++i) {
      int const body = static_cast<int>(i);
      if (last[i] && is_deleted(frame, i)) {
        // A deleted grain keeps the place where it left, but no velocity.
        GrainMoment to = *last[i];
        to.time = frame.time;
        to.position = frame.position[i];
        to.energy = std::max(0.0, to.energy + dot(gravity, to.position - last[i]->position));
        leg({body, *last[i], to, true});
        last[i].reset();
      } else if (frame.is_active(i)) {
        GrainMoment const now = moment_of(header, frame, i);
        double const dt = last[i] ? now.time - last[i]->time : 0;
        if (last[i])
          leg({body, *last[i], now, false, 0.5 * norm2(gravity) * dt * dt});
        else
          release(body, now);
        last[i] = now;
      }
    }
  }
}

}  // namespace scree

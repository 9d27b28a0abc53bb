// made_shapes_cache.cpp: see made_shapes_cache.h. Kept is a model file of the shapes, named by their places, and one
// more whose certificate's source is the note.
// SPDX-License-Identifier: Apache-2.0
#include "core/made_shapes_cache.h"

#include <optional>
#include <utility>

#include "shapes/content_cache.h"

namespace scree {
namespace {

int constexpr recipe = 1;  // counts changes of shapes/generate.cpp and sampled_grains.cpp that alter what is made
char constexpr note_name[] = "note";

void add_interval(ContentHash& hash, Interval const& i) { hash.add(i.low).add(i.high); }

Library packed(Library const& from, MadeShapes const& made) {
  Library kept{from.net, {}, {}, {}, made.shape};
  for (std::size_t i = 0; i < kept.shape.size(); ++i)
    kept.shape[i].name = std::to_string(i) + "/" + made.shape[i].name;  // steps of a line may share a name
  Shape note = kept.shape.front();
  note.name = note_name;
  note.certificate.source = made.note;
  kept.shape.push_back(std::move(note));
  return kept;
}

std::optional<MadeShapes> unpacked(Library kept) {
  if (kept.shape.size() < 2 || kept.shape.back().name != note_name) return std::nullopt;
  MadeShapes made;
  made.note = kept.shape.back().certificate.source;
  kept.shape.pop_back();
  for (Shape& s : kept.shape) s.name.erase(0, s.name.find('/') + 1);
  made.shape = std::move(kept.shape);
  return made;
}

}  // namespace

std::string made_shapes_key(Library const& from, GrainsCase const& grains, LimitsCase const& limits, std::uint64_t seed,
                            int group) {
  ContentHash hash;
  hash.add(recipe).add(grains.name).add(grains.count).add(seed).add(group);
  hash.add(limits.gradient_low).add(limits.gradient_high).add(limits.falling);
  if (grains.sample) {
    hash.add(grains.sample->category).add(grains.sample->truncate);
    for (FormScreen const& s : form_screens()) add_interval(hash, *grains.sample.*s.wanted);
  } else {
    InterpolateCase const& line = *grains.interpolate;
    hash.add(line.from).add(line.to).add(line.low).add(line.high).add(line.random);
  }
  for (Shape const& s : from.shape) hash.add(s.name).add(s.bounding_radius).add_phi(from, s);
  return hash.digits();
}

MadeShapes cached_make_shapes(Library const& from, GrainsCase const& grains, LimitsCase const& limits,
                              std::uint64_t seed, int group, int threads, std::vector<std::string>& notes) {
  if (grains.count == 0) return {};
  std::string const key = made_shapes_key(from, grains, limits, seed, group);
  if (std::optional<Library> kept = read_cached(key, notes))
    if (std::optional<MadeShapes> made = unpacked(std::move(*kept))) return *made;
  MadeShapes made = make_shapes(from, grains, limits, seed, group, threads);
  keep_cached(key, packed(from, made), "grains made for the case", notes);
  return made;
}

}  // namespace scree

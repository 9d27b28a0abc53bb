// unique_grains.cpp: see unique_grains.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/unique_grains.h"

#include <algorithm>
#include <utility>

#include "core/scene_evaluators.h"

namespace scree {
namespace {

int constexpr batch = 256;  // grains made at a time: their scratch stays below a megabyte

bool same_net(Mlp const& a, Mlp const& b) {
  return a.activation == b.activation && a.parameter == b.parameter && a.width == b.width && a.weight == b.weight &&
         a.bias == b.bias;
}

void add_unique_grain(Scene& scene, CompactGrain const& grain, int net, int set, Span<const float> code) {
  ShapeRecord record = record_of(to_shape(grain, net, code, {}));
  PackedMlp const& packed = scene.networks.net[net];
  record.sdf = SdfKind::net;
  record.net = net;
  record.bias_row = packed.append_bias(fold_code(packed.net(), code), scene.networks.bias_rows[net]);
  scene.compact.append(grain, set, record);
  scene.shape.push_back(record);
  scene.unique.code.insert(scene.unique.code.end(), code.begin(), code.end());
  scene.unique.area.push_back(static_cast<float>(grain.area));
  scene.unique.inertia.push_back(grain.inertia);
}

// Exactly the room that is needed: doubling would leave up to half of it empty.
void reserve(Scene& scene, CompactGrainMaker const& maker, int net, std::size_t grains, std::size_t code_size) {
  auto const more = [&](auto& v, std::size_t n) { v.reserve(v.size() + n); };
  scene.compact.reserve(grains, maker.directions());
  more(scene.shape, grains);
  more(scene.networks.bias_rows[net], grains * scene.networks.net[net].bias_stride());
  more(scene.unique.code, grains * code_size);
  more(scene.unique.area, grains);
  more(scene.unique.inertia, grains);
}

template <class T>
std::size_t bytes(std::vector<T> const& v) {
  return v.capacity() * sizeof(T);
}

}  // namespace

CompactMakers::Entry const& CompactMakers::get(int library, int net, int nodes) {
  auto const at = entry_.find({library, net, nodes});
  if (at != entry_.end()) return at->second;
  Entry entry{std::make_unique<CompactGrainMaker>(libraries_[library], net, nodes), -1};
  entry.set = scene_.compact.directions.place(entry.maker->directions());
  return entry_.emplace(std::tuple{library, net, nodes}, std::move(entry)).first->second;
}

int scene_network(Scene& scene, Mlp const& net) {
  for (std::size_t k = 0; k < scene.networks.net.size(); ++k)
    if (same_net(scene.networks.net[k].net(), net)) return static_cast<int>(k);
  scene.library.net.push_back(net);
  scene.networks.net.emplace_back(net);
  scene.networks.bias_rows.emplace_back();
  return static_cast<int>(scene.networks.net.size()) - 1;
}

UniqueGrainsMade add_unique_grains(Scene& scene, CompactGrainMaker const& maker, int net, Span<const float> codes,
                                   std::string name, int threads) {
  int const size = scene.networks.net[net].net().code_size(), count = codes.size() / std::max(size, 1);
  reserve(scene, maker, net, count, size);
  int const set = scene.compact.directions.place(maker.directions());
  int const first = static_cast<int>(scene.unique.inertia.size());
  std::size_t const first_code = scene.unique.code.size();
  UniqueGrainsMade out;
  std::vector<CompactGrain> grain(std::min(batch, count));
  std::vector<GrainFault> fault(grain.size());
  for (int begin = 0; begin < count; begin += batch) {
    int const n = std::min(batch, count - begin);
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (int i = 0; i < n; ++i) fault[i] = maker.make(codes.subspan((begin + i) * size, size), grain[i]);
    for (int i = 0; i < n; ++i) {
      ++out.faults[static_cast<int>(fault[i])];
      if (fault[i] == GrainFault::none)
        add_unique_grain(scene, grain[i], net, set, codes.subspan((begin + i) * size, size));
    }
  }
  out.made = std::exchange(out.faults[0], 0);
  scene.unique.group.push_back({std::move(name), net, first, out.made, first_code});
  return out;
}

CompactBytes compact_bytes(Scene const& scene) {
  CompactBytes b;
  CompactStore const& c = scene.compact;
  b.grains = c.record.size();
  if (b.grains == 0) return b;
  b.nodes = bytes(c.radius);
  b.culling = bytes(c.block_reach) + bytes(c.block_ball);
  b.record = bytes(c.record) + b.grains * sizeof(ShapeRecord);
  b.host = bytes(scene.unique.code) + bytes(scene.unique.area) + bytes(scene.unique.inertia);
  for (std::size_t i = 0; i < scene.shape.size(); ++i) {
    ShapeRecord const& r = scene.shape[i];
    if (r.compact < 0) continue;
    b.bias += scene.networks.net[r.net].bias_stride() * sizeof(float);
    if (i >= scene.library.shape.size()) continue;
    Shape const& s = scene.library.shape[i];
    b.host += sizeof(Shape) + bytes(s.code) + s.name.capacity() + s.certificate.source.capacity() +
              s.certificate.source_hash.capacity() + s.certificate.made_with.capacity();
  }
  return b;
}

Shape Scene::template_shape(int index) const {
  int const of = index - static_cast<int>(library.shape.size());
  if (of < 0) return library.shape[index];
  auto const group = std::find_if(unique.group.begin(), unique.group.end(),
                                  [&](UniqueGrains::Group const& g) { return of < g.first + g.count; });
  ShapeRecord const& r = shape[index];
  std::size_t const size = networks.net[r.net].net().code_size();
  auto const code = unique.code.begin() + static_cast<std::ptrdiff_t>(group->first_code + (of - group->first) * size);
  Shape s;
  s.name = group->name + std::to_string(of - group->first);
  s.kind = ShapeKind::net;
  s.net = r.net;
  s.code.assign(code, code + static_cast<std::ptrdiff_t>(size));
  s.query = {r.query_rotation, r.query_shift, r.query_scale};
  s.area = unique.area[of];
  s.inertia = unique.inertia[of];
  s.bounding_radius = r.bounding_radius;
  s.box = r.box;
  for (int k = 0; k < 3; ++k) s.box.min[k] += box_slack, s.box.max[k] -= box_slack;
  s.lipschitz = r.lipschitz;
  return s;
}

}  // namespace scree

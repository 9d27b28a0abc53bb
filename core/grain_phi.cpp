// grain_phi.cpp: see grain_phi.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/grain_phi.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "core/scene_evaluators.h"

namespace scree {

namespace {

double constexpr network_reach = 1.1;  // of the bounding radius: so far a network may be asked

}  // namespace

GrainPhi::GrainPhi(ResultsHeader const& header, Frame const& frame, std::shared_ptr<NetworkDevice> device)
    : header_(header), frame_(frame) {
  std::size_t const n = frame.position.size();
  if (header.shape.size() != n || header.diameter.size() != n || frame.orientation.size() != n)
    throw std::invalid_argument("render: the frame's bodies do not match the header's");
  for (Quat const& q : frame.orientation) rotation_.push_back(to_matrix(normalized(q)));
  for (Shape const& s : header.library.shape) {
    other_phi_.push_back(s.is_net() ? PhiBatch() : surface_phi(header.library, s));
    lipschitz_.push_back(s.kind == ShapeKind::analytic ? 1.0 : std::max(1.0, s.lipschitz));
  }
  place_networks(std::move(device));
}

void GrainPhi::place_networks(std::shared_ptr<NetworkDevice> device) {
  std::vector<Shape> const& shape = header_.library.shape;
  int const nets = static_cast<int>(header_.library.net.size());
  for (Mlp const& net : header_.library.net) networks_.net.emplace_back(net);
  networks_.bias_rows.resize(networks_.net.size());
  auto const group = [&](int s) { return shape[s].is_net() ? shape[s].net : nets; };
  first_place_.assign(nets + 2, 0);
  for (int s = 0; s < static_cast<int>(shape.size()); ++s) {
    ++first_place_.at(static_cast<std::size_t>(group(s)) + 1);
    ShapeRecord& record = record_.emplace_back(record_of(shape[s]));
    if (!shape[s].is_net()) continue;
    record.sdf = SdfKind::net;
    record.net = shape[s].net;
    record.bounding_radius *= network_reach;
    PackedMlp const& net = networks_.net[record.net];
    record.bias_row = net.append_bias(fold_code(net.net(), shape[s].code), networks_.bias_rows[record.net]);
  }
  std::partial_sum(first_place_.begin(), first_place_.end(), first_place_.begin());
  shape_at_.resize(shape.size());
  std::iota(shape_at_.begin(), shape_at_.end(), 0);
  std::stable_sort(shape_at_.begin(), shape_at_.end(), [&](int a, int b) { return group(a) < group(b); });
  place_of_.resize(shape.size());
  for (std::size_t k = 0; k < shape_at_.size(); ++k) place_of_[shape_at_[k]] = static_cast<int>(k);
  if (!device || first_place_[nets] == 0) return;  // nothing for it to do
  device->load(view(), networks_);
  networks_.device = std::move(device);
}

SceneView GrainPhi::view() const {
  SceneView v;
  v.shape = record_, v.shape_of = header_.shape, v.diameter = header_.diameter;
  return v;
}

Vec3 GrainPhi::in_body_frame(int body, Vec3 world) const {
  return transposed_times(rotation_[body], world - frame_.position[body]) / header_.diameter[body];
}

void GrainPhi::evaluate(std::vector<BodyPoint> const& queries, std::vector<double>& phi,
                        std::vector<Vec3>* gradient) const {
  std::size_t const n = queries.size();
  phi.resize(n);
  if (gradient) gradient->resize(n);
  // Counting sort by shape, so that neighbours in a network's batch share a code.
  std::vector<int> first(shape_at_.size() + 1, 0), order(n);
  for (BodyPoint const& q : queries) ++first[place_of_[header_.shape[q.body]] + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> next(first.begin(), first.end() - 1);
  QueryBatch batch;
  batch.resize(static_cast<int>(n));
  for (std::size_t i = 0; i < n; ++i) {
    int const to = next[place_of_[header_.shape[queries[i].body]]]++;
    order[to] = static_cast<int>(i);
    batch.partner[to] = queries[i].body;
    batch.point[to] = in_body_frame(queries[i].body, queries[i].point);
  }
  int const nets = static_cast<int>(networks_.net.size()), of_networks = first[first_place_[nets]];
  batch.group.assign(query_groups(nets) + 1, of_networks);
  for (int k = 0; k < nets; ++k) batch.group[k] = first[first_place_[k]];
  if (gradient) batch.gradient.resize(n);
  if (of_networks > 0) {
    std::unique_lock<std::mutex> turn(device_turn_, std::defer_lock);
    if (networks_.device) turn.lock();
    auto const ask = gradient ? evaluate_phi_gradient : evaluate_phi;
    ask({}, view(), networks_, batch);
  }
  for (std::size_t k = static_cast<std::size_t>(first_place_[nets]); k < shape_at_.size(); ++k) {
    int const at = first[k], count = first[k + 1] - at;
    if (count == 0) continue;
    other_phi_[shape_at_[k]]({batch.point.data() + at, count}, {batch.phi.data() + at, count},
                             gradient ? Span<Vec3>(batch.gradient.data() + at, count) : Span<Vec3>());
  }
  for (std::size_t k = 0; k < n; ++k) {
    int const body = batch.partner[k];
    phi[order[k]] = batch.phi[k] * header_.diameter[body];
    if (gradient) (*gradient)[order[k]] = rotation_[body] * batch.gradient[k];
  }
}

}  // namespace scree

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
// Most walks end within it; more would let those of a tile wait for its slowest.
int constexpr steps_a_launch = 16;

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

template <class BodyOf>
GrainPhi::Order GrainPhi::order_of(std::size_t n, BodyOf const& body_of) const {
  Order order{std::vector<int>(shape_at_.size() + 1, 0), std::vector<int>(n)};
  auto const place = [&](std::size_t i) { return place_of_[header_.shape[body_of(i)]]; };
  for (std::size_t i = 0; i < n; ++i) ++order.first[place(i) + 1];
  std::partial_sum(order.first.begin(), order.first.end(), order.first.begin());
  std::vector<int> next(order.first.begin(), order.first.end() - 1);
  for (std::size_t i = 0; i < n; ++i) order.item[next[place(i)]++] = static_cast<int>(i);
  return order;
}

std::vector<int> GrainPhi::network_groups(Order const& order) const {
  std::vector<int> group;
  for (std::size_t k = 0; k + 1 < first_place_.size(); ++k) group.push_back(order.first[first_place_[k]]);
  return group;
}

void GrainPhi::ask_networks(Order const& order, QueryBatch& batch, bool with_gradient) const {
  std::vector<int> group = network_groups(order);
  if (group.back() == 0) return;
  group.resize(query_groups(static_cast<int>(networks_.net.size())) + 1, group.back());  // no other kinds
  batch.group = std::move(group);
  std::unique_lock<std::mutex> turn(device_turn_, std::defer_lock);
  if (networks_.device) turn.lock();
  auto const ask = with_gradient ? evaluate_phi_gradient : evaluate_phi;
  ask({}, view(), networks_, batch);
}

void GrainPhi::ask_others(Order const& order, QueryBatch& batch, bool with_gradient) const {
  auto const none = Span<Vec3>();
  for (std::size_t k = first_place_[networks_.net.size()]; k < shape_at_.size(); ++k) {
    int const at = order.first[k], count = order.first[k + 1] - at;
    if (count == 0) continue;
    other_phi_[shape_at_[k]]({batch.point.data() + at, count}, {batch.phi.data() + at, count},
                             with_gradient ? Span<Vec3>(batch.gradient.data() + at, count) : none);
  }
}

void GrainPhi::evaluate(std::vector<BodyPoint> const& queries, std::vector<double>& phi,
                        std::vector<Vec3>* gradient) const {
  std::size_t const n = queries.size();
  phi.resize(n);
  Order const order = order_of(n, [&](std::size_t i) { return queries[i].body; });
  QueryBatch batch;
  batch.resize(static_cast<int>(n));
  if (gradient) gradient->resize(n), batch.gradient.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    BodyPoint const& q = queries[order.item[k]];
    batch.partner[k] = q.body;
    batch.point[k] = in_body_frame(q.body, q.point);
  }
  ask_networks(order, batch, gradient != nullptr);
  ask_others(order, batch, gradient != nullptr);
  for (std::size_t k = 0; k < n; ++k) {
    int const body = batch.partner[k], to = order.item[k];
    phi[to] = batch.phi[k] * header_.diameter[body];
    if (gradient) (*gradient)[to] = rotation_[body] * batch.gradient[k];
  }
}

void GrainPhi::step(std::vector<BallWalk>& walks) const {
  std::size_t const n = walks.size();
  Order const order = order_of(n, [&](std::size_t i) { return walks[i].body; });
  QueryBatch batch;
  batch.resize(static_cast<int>(n));
  for (std::size_t k = 0; k < n; ++k) {
    BallWalk const& w = walks[order.item[k]];
    batch.partner[k] = w.body;
    batch.point[k] = w.origin + w.direction * w.at;
  }
  if (on_device())
    walk_on_device(order, walks);
  else
    ask_networks(order, batch, false);
  ask_others(order, batch, false);
  for (std::size_t k = on_device() ? network_groups(order).back() : 0; k < n; ++k) {
    BallWalk& w = walks[order.item[k]];
    walk_on(batch.phi[k], lipschitz(w.body), w.end, w.at, w.step);
  }
}

void GrainPhi::walk_on_device(Order const& order, std::vector<BallWalk>& walks) const {
  WalkBatch batch;
  batch.group = network_groups(order);
  for (int k = 0; k < batch.group.back(); ++k) {
    BallWalk const& w = walks[order.item[k]];
    batch.origin.push_back(w.origin);
    batch.direction.push_back(w.direction);
    batch.end.push_back(w.end);
    batch.body.push_back(w.body);
    batch.at.push_back(w.at);
    batch.step.push_back(w.step);
  }
  std::lock_guard<std::mutex> const turn(device_turn_);
  networks_.device->walk({}, batch, steps_a_launch);
  for (int k = 0; k < batch.group.back(); ++k) {
    BallWalk& w = walks[order.item[k]];
    w.at = batch.at[k];
    w.step = batch.step[k];
  }
}

}  // namespace scree

// onnx_file.cpp: see onnx_file.h.
// SPDX-License-Identifier: Apache-2.0
#include "shapes/exchange/onnx_file.h"

#include <onnx/onnx_pb.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

namespace scree {
namespace {

using nlohmann::json;
int constexpr opset = 13;
int constexpr ir_version = 7;  // the oldest that knows opset 13

class Graph {
 public:
  Graph() {
    model_.set_ir_version(ir_version);
    model_.set_producer_name("scree");
    model_.set_domain("scree");
    model_.set_model_version(1);
    model_.add_opset_import()->set_version(opset);
    model_.mutable_graph()->set_name("signed_distance");
  }

  void metadata(std::string const& key, std::string const& value) {
    onnx::StringStringEntryProto* const entry = model_.add_metadata_props();
    entry->set_key(key);
    entry->set_value(value);
  }
  void input(std::string const& name, std::string const& rows, int columns) {
    describe(*model_.mutable_graph()->add_input(), name, rows, columns);
  }
  void output(std::string const& name, std::string const& rows, int columns) {
    describe(*model_.mutable_graph()->add_output(), name, rows, columns);
  }
  // A constant; shape empty: one number.
  std::string constant(std::string const& name, std::vector<int> const& shape, std::vector<float> const& value) {
    onnx::TensorProto* const tensor = model_.mutable_graph()->add_initializer();
    tensor->set_name(name);
    tensor->set_data_type(onnx::TensorProto::FLOAT);
    for (int extent : shape) tensor->add_dims(extent);
    tensor->set_raw_data(value.data(), value.size() * sizeof(float));
    return name;
  }
  // Returns the name of its result.
  std::string node(char const* operation, std::vector<std::string> const& inputs, std::string const& result) {
    onnx::NodeProto* const node = model_.mutable_graph()->add_node();
    node->set_op_type(operation);
    node->set_name(result);
    for (std::string const& input : inputs) node->add_input(input);
    node->add_output(result);
    return result;
  }
  std::string leaky_relu(std::string const& input, double slope, std::string const& result) {
    node("LeakyRelu", {input}, result);
    onnx::AttributeProto* const alpha =
        model_.mutable_graph()->mutable_node(model_.graph().node_size() - 1)->add_attribute();
    alpha->set_name("alpha");
    alpha->set_type(onnx::AttributeProto::FLOAT);
    alpha->set_f(static_cast<float>(slope));
    return result;
  }
  std::string bytes() const { return model_.SerializeAsString(); }

 private:
  static void describe(onnx::ValueInfoProto& value, std::string const& name, std::string const& rows, int columns) {
    value.set_name(name);
    onnx::TypeProto_Tensor* const type = value.mutable_type()->mutable_tensor_type();
    type->set_elem_type(onnx::TensorProto::FLOAT);
    type->mutable_shape()->add_dim()->set_dim_param(rows);
    type->mutable_shape()->add_dim()->set_dim_value(columns);
  }

  onnx::ModelProto model_;
};

std::string activate(Graph& graph, Mlp const& net, std::string const& z, std::string const& result) {
  if (net.activation == Activation::leaky_relu) return graph.leaky_relu(z, net.parameter, result);
  std::string const scaled = graph.node("Mul", {z, "parameter"}, result + "_scaled");
  if (net.activation == Activation::sine) return graph.node("Sin", {scaled}, result);
  return graph.node("Div", {graph.node("Softplus", {scaled}, result + "_softplus"), "parameter"}, result);
}

// Hidden activations from the first layer's sums `z` on, to the output "phi".
void add_layers(Graph& graph, Mlp const& net, std::string z) {
  if (net.activation != Activation::leaky_relu) graph.constant("parameter", {}, {static_cast<float>(net.parameter)});
  for (int l = 1; l < net.layers(); ++l) {
    std::string const k = std::to_string(l);
    std::string const h = activate(graph, net, z, "h" + k);
    graph.constant("w" + k, {net.width[l], net.width[l + 1]}, net.weight[l]);
    graph.constant("b" + k, {net.width[l + 1]}, net.bias[l]);
    z = graph.node("Gemm", {h, "w" + k, "b" + k}, l + 1 == net.layers() ? "phi" : "z" + k);
  }
}

// The network with the shape's code and query transform in its first layer and the scale in its last.
Mlp folded(Mlp net, Shape const& shape) {
  int const out = net.width[1];
  std::vector<float> const first = net.weight[0], bias = net.bias[0];
  QueryTransform const& q = shape.query;
  for (int o = 0; o < out; ++o) {
    auto const w = [&](int input) { return static_cast<double>(first[std::size_t(input) * out + o]); };
    Vec3 const row{w(0), w(1), w(2)};
    Vec3 const turned = transposed_times(q.rotation, row) * q.scale;
    double sum = bias[o] + dot(row, q.shift);
    for (int c = 0; c < net.code_size(); ++c) sum += w(3 + c) * shape.code[c];
    for (int k = 0; k < 3; ++k) net.weight[0][std::size_t(k) * out + o] = static_cast<float>(turned[k]);
    net.bias[0][o] = static_cast<float>(sum);
  }
  net.weight[0].resize(std::size_t(3) * out);
  net.width[0] = 3;
  for (float& v : net.weight.back()) v = static_cast<float>(v / q.scale);
  for (float& v : net.bias.back()) v = static_cast<float>(v / q.scale);
  return net;
}

json to_json(Vec3 v) { return {v.x, v.y, v.z}; }

std::string number(double value) { return json(value).dump(); }

}  // namespace

bool onnx_available() { return true; }

std::string onnx_model(Library const& library, Shape const& shape) {
  if (!shape.is_net()) throw std::invalid_argument("shape '" + shape.name + "' is no network");
  Mlp const net = folded(library.net.at(shape.net), shape);
  Graph graph;
  graph.metadata("sign", "positive_inside");
  graph.metadata("unit", "d");
  graph.metadata("frame", "body: centroid at 0, principal axes along x, y, z");
  graph.metadata("shape", shape.name);
  graph.metadata("bounding_radius", number(shape.bounding_radius));
  if (shape.certificate.mae >= 0) graph.metadata("mae", number(shape.certificate.mae));
  if (shape.certificate.band_mae >= 0) graph.metadata("band_mae", number(shape.certificate.band_mae));
  graph.input("x", "points", 3);
  graph.output("phi", "points", 1);
  graph.constant("w0", {3, net.width[1]}, net.weight[0]);
  graph.constant("b0", {net.width[1]}, net.bias[0]);
  add_layers(graph, net, graph.node("Gemm", {"x", "w0", "b0"}, "z0"));
  return graph.bytes();
}

std::string onnx_decoder(Library const& library, int index) {
  Mlp const& net = library.net.at(index);
  if (net.code_size() == 0)
    throw std::invalid_argument("network " + std::to_string(index) + " takes no code: export its shape");
  json shapes = json::array();
  for (Shape const& s : library.shape)
    if (s.is_net() && s.net == index) {
      Mat3 const& r = s.query.rotation;
      shapes.push_back({{"name", s.name},
                        {"code", s.code},
                        {"rotation", {to_json(r.row[0]), to_json(r.row[1]), to_json(r.row[2])}},
                        {"shift", to_json(s.query.shift)},
                        {"scale", s.query.scale}});
    }
  Graph graph;
  graph.metadata("sign", "positive_inside");
  graph.metadata("unit", "own");
  graph.metadata("frame", "own: d and body frame by phi_d(x) = phi(rotation x scale + shift, code) / scale");
  graph.metadata("shapes", shapes.dump());
  graph.input("x", "points", 3);
  graph.input("code", "codes", net.code_size());
  graph.output("phi", "points", 1);
  int const out = net.width[1];
  auto const rows = net.weight[0].begin() + 3 * out;  // the code's
  graph.constant("w0_x", {3, out}, {net.weight[0].begin(), rows});
  graph.constant("w0_code", {net.code_size(), out}, {rows, net.weight[0].end()});
  graph.constant("b0", {out}, net.bias[0]);
  // One code for all points, or a code a point: what is added spreads by itself.
  std::string const coded = graph.node("Gemm", {"code", "w0_code", "b0"}, "z0_code");
  add_layers(graph, net, graph.node("Add", {graph.node("MatMul", {"x", "w0_x"}, "z0_x"), coded}, "z0"));
  return graph.bytes();
}

}  // namespace scree

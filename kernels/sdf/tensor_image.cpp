// tensor_image.cpp: see tensor_image.h.
// SPDX-License-Identifier: Apache-2.0
#include "kernels/sdf/tensor_image.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

namespace scree::sdf_fused {
namespace {

struct Sample {
  Vec3f point;  // in the network's frame
  int bias_row = 0;
};

// Points spread over the balls of the shapes that use the network, for all shapes alike.
std::vector<Sample> samples_of(int net, SceneView const& scene, NetworkImage const& image) {
  std::vector<int> shapes;
  for (int s = 0; s < scene.shape.size(); ++s)
    if (scene.shape[s].net == net) shapes.push_back(s);
  std::vector<Sample> samples(shapes.empty() ? 0 : std::max<std::size_t>(tensor_samples, shapes.size()));
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    NetworkFrame const& frame = image.frame[shapes[i % shapes.size()]];
    Vec3 x;
    do x = {uniform(random), uniform(random), uniform(random)};
    while (norm2(x) > 1);
    samples[i] = {to_network(frame, 0, x * (frame.bounding_radius * (1 - 1e-9))), frame.bias_row};
  }
  return samples;
}

// Power of two that brings `largest` into [2^(power - 1), 2^power).
int exponent_to(double largest, int power) {
  int exponent = 0;
  if (largest > 0) std::frexp(largest, &exponent);
  return largest > 0 ? power - exponent : 0;
}
float scaled(float x, int exponent) { return std::ldexp(x, exponent); }
float largest_of(float const* from, int n) {
  float largest = 0;
  for (int i = 0; i < n; ++i) largest = std::max(largest, std::abs(from[i]));
  return largest;
}

// A network of a class as arrays of W, and what its layers reach.
struct Layers {
  int w, hidden;
  float const *forward, *bias, *backward, *last_forward, *last_backward;  // see NetworkRecord
  float const* bias_rows;
  float slope, last_bias;
  // Exponents of the scales.
  int weight[max_hidden] = {}, back_weight[max_hidden] = {}, value[max_hidden] = {}, back_value[max_hidden] = {};

  Layers(NetworkClass const& of, NetworkRecord const& net)
      : w(of.width),
        hidden(net.hidden),
        forward(of.weight.data() + net.first),
        bias(forward + std::size_t(hidden) * w * w),
        backward(bias + std::size_t(hidden) * w),
        last_forward(backward + std::size_t(hidden) * w * w),
        last_backward(last_forward + w),
        bias_rows(of.bias.data() + net.first_bias),
        slope(net.slope),
        last_bias(net.last_bias) {}
};

// Scalar evaluation of samples, in the order of nothing in particular: for maxima and errors only.
template <template <class> class Act>
class Probe {
 public:
  explicit Probe(Layers const& layers) : n_(layers), act_(layers), h_(layers.w), z_(layers.w) {
    record_.resize(std::size_t(n_.hidden) * n_.w);
  }

  // Largest activations and d phi / d z of each layer; phi of each sample.
  void ranges(std::vector<Sample> const& samples, double (&value)[max_hidden], double (&back_value)[max_hidden],
              std::vector<double>& phi) {
    for (Sample const& s : samples) {
      start(s);
      for (int l = 0; l < n_.hidden; ++l) {
        if (l > 0) layer(n_.forward + std::size_t(l) * n_.w * n_.w, n_.bias + l * n_.w);
        activate(l);
        value[l] = std::max<double>(value[l], largest_of(h_.data(), n_.w));
      }
      phi.push_back(last_layer());
      std::copy_n(n_.last_backward, n_.w, z_.begin());
      for (int l = n_.hidden - 1; l >= 0; --l) {
        for (int j = 0; j < n_.w; ++j) h_[j] = act_.backward({z_[j]}, {record_[l * n_.w + j]}).v;
        back_value[l] = std::max<double>(back_value[l], largest_of(h_.data(), n_.w));
        if (l > 0) layer(n_.backward + std::size_t(l) * n_.w * n_.w, nullptr);
      }
    }
  }

  // Largest difference that fp16 makes to phi.
  double rounding_error(std::vector<Sample> const& samples, std::vector<double> const& phi) {
    std::size_t const square = std::size_t(n_.w) * n_.w;
    std::vector<float> rounded(n_.hidden * square);
    for (int l = 1; l < n_.hidden; ++l)
      for (std::size_t i = l * square; i < (l + 1) * square; ++i)
        rounded[i] = to_half(n_.forward[i], scaled(1, n_.weight[l]));
    double largest = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      start(samples[i]);
      activate(0);
      for (int l = 1; l < n_.hidden; ++l) {
        float const scale = scaled(1, n_.value[l - 1]);
        for (float& h : h_) h = to_half(h, scale);
        layer(rounded.data() + l * square, n_.bias + l * n_.w);
        activate(l);
      }
      largest = std::max(largest, std::abs(last_layer() - phi[i]));
    }
    return largest;
  }

 private:
  static float to_half(float x, float scale) { return half_value(half_bits(x * scale)) / scale; }  // a power of two

  void start(Sample const& s) {
    float const* const row = n_.bias_rows + std::size_t(s.bias_row) * n_.w;
    for (int j = 0; j < n_.w; ++j) {
      float const* const k = n_.forward + j;
      z_[j] = row[j] + k[0] * s.point.x + k[n_.w] * s.point.y + k[2 * n_.w] * s.point.z;
    }
  }
  void layer(float const* weight, float const* bias) {
    float* const z = z_.data();
    for (int j = 0; j < n_.w; ++j) z[j] = bias ? bias[j] : 0;
    for (int k = 0; k < n_.w; ++k) {
      float const h = h_[k];
      for (int j = 0; j < n_.w; ++j) z[j] += weight[k * n_.w + j] * h;
    }
  }
  void activate(int l) {
    for (int j = 0; j < n_.w; ++j) {
      Lane kept;
      h_[j] = act_.value_and_record({z_[j]}, kept).v;
      record_[l * n_.w + j] = kept.v;
    }
  }
  double last_layer() const {
    double sum = n_.last_bias;
    for (int j = 0; j < n_.w; ++j) sum += double(n_.last_forward[j]) * h_[j];
    return sum;
  }

  Layers const& n_;
  Act<Lane> act_;
  std::vector<float> h_, z_, record_;
};

// Calls work(Probe<Act>).
template <class Work>
void probe(Activation activation, Layers const& layers, Work const& work) {
  switch (activation) {
    case Activation::leaky_relu:
      return work(Probe<sdf_activation::LeakyRelu>(layers));
    case Activation::sine:
      return work(Probe<sdf_activation::Sine>(layers));
    case Activation::softplus:
      return work(Probe<sdf_activation::Softplus>(layers));
  }
}

// The largest values of a layer go to [2^6, 2^7): 1,000 below infinity, since only samples were seen, and 2^10 above
// those whose low parts begin to lose bits. Weights are all known: the largest go to [2^14, 2^15).
int constexpr value_power = 7, weight_power = 15;

// Leaky ReLU commutes with positive factors: a layer's scale costs nothing, it is in what takes the product's scale
// off. Sines are at most 1; of softplus, whose argument carries beta, small values matter less than half precision's
// steps. Both keep their own unit on the way forward. The way back is linear: all scales are free there.
void choose_scales(Activation activation, int net, std::vector<Sample> const& samples, Layers& n,
                   std::vector<double>& phi) {
  double value[max_hidden] = {}, back_value[max_hidden] = {};
  probe(activation, n, [&](auto&& p) { p.ranges(samples, value, back_value, phi); });
  for (int l = 0; l < n.hidden; ++l) {
    if (activation == Activation::leaky_relu) n.value[l] = exponent_to(value[l], value_power);
    n.back_value[l] = exponent_to(back_value[l], value_power);
    if (l > 0) n.weight[l] = exponent_to(largest_of(n.forward + l * n.w * n.w, n.w * n.w), weight_power);
    if (l > 0) n.back_weight[l] = exponent_to(largest_of(n.backward + l * n.w * n.w, n.w * n.w), weight_power);
    if (!(std::ldexp(value[l], n.value[l]) < largest_half / 16))
      throw std::invalid_argument("network " + std::to_string(net) + " has activations of " + std::to_string(value[l]) +
                                  ", too near the end of half precision at 65504: it needs precision \"fp32\"");
  }
}

// Of phi in fp32 or fp16x3, so that a network without a half in it has a bound too [network's unit].
float constexpr float_error = 1e-5f;

// One layer as fragments: inputs k in rows, outputs n in columns of `weight` (W x W).
void append_fragments(float const* weight, int w, int exponent, std::vector<Half2>& out) {
  int const blocks = w / 8;
  std::size_t const first = out.size();
  out.resize(first + 2 * plane_words(w));
  for (int n = 0; n < blocks; ++n)
    for (int k = 0; k < blocks; ++k)
      for (int lane = 0; lane < warp_lanes; ++lane) {
        float const* const from = weight + (8 * k + fragment_column(lane)) * w + 8 * n + fragment_row(lane);
        std::size_t const at = first + fragment_word(blocks, n, k) + fragment_step(blocks, k) * lane;
        split_halves(scaled(from[0], exponent), scaled(from[w], exponent), out[at], out[at + plane_words(w)]);
      }
}

TensorRecord append(Layers const& n, NetworkRecord const& net, TensorClass& to) {
  TensorRecord record;
  record.first_word = to.word.size();
  record.first_number = to.number.size();
  record.first_bias = net.first_bias;
  record.hidden = n.hidden;
  record.last_bias = n.last_bias;
  record.slope = n.slope;
  record.first_scale = scaled(1, n.value[0]);
  auto const numbers = [&](float const* from, int count, int exponent) {
    for (int i = 0; i < count; ++i) to.number.push_back(scaled(from[i], exponent));
  };
  int const top = n.hidden - 1, square = n.w * n.w;
  numbers(n.forward, 3 * n.w, 0);
  for (int l = 1; l < n.hidden; ++l) {
    numbers(n.bias + l * n.w, n.w, n.value[l]);
    record.down[l] = scaled(1, n.value[l] - n.weight[l] - n.value[l - 1]);
    record.back_down[l] = scaled(1, n.back_value[l - 1] - n.back_weight[l] - n.back_value[l]);
    append_fragments(n.forward + l * square, n.w, n.weight[l], to.word);
  }
  for (int l = 1; l < n.hidden; ++l) append_fragments(n.backward + l * square, n.w, n.back_weight[l], to.word);
  numbers(n.last_forward, n.w, -n.value[top]);
  numbers(n.last_backward, n.w, n.back_value[top]);
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < n.w; ++j) to.number.push_back(scaled(n.backward[j * n.w + k], -n.back_value[0]));
  return record;
}

}  // namespace

std::vector<TensorClass> make_tensor_image(SceneView const& scene, NetworkImage const& image) {
  std::vector<TensorClass> classes(image.classes.size());
  for (std::size_t i = 0; i < image.class_of.size(); ++i) {
    NetworkClass const& of = image.classes[image.class_of[i]];
    NetworkRecord const& net = of.net[image.index_in_class[i]];
    Layers layers(of, net);
    std::vector<Sample> const samples = samples_of(static_cast<int>(i), scene, image);
    std::vector<double> phi;
    choose_scales(of.activation, static_cast<int>(i), samples, layers, phi);
    TensorClass& to = classes[image.class_of[i]];
    to.net.push_back(append(layers, net, to));
    probe(of.activation, layers, [&](auto&& p) {
      to.net.back().filter_bound = filter_margin * static_cast<float>(p.rounding_error(samples, phi)) + float_error;
    });
  }
  return classes;
}

}  // namespace scree::sdf_fused

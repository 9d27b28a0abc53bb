// bench_device.cpp: queries per second of the device's network kernels by the device's own clock, as a share of the
// fp32 peak measured in the same run, against level-set lookups on the same points; their results against the host's.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/os.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "kernels/base/build_info.h"
#include "kernels/base/device.h"
#include "kernels/sdf_queries.h"
#include "tools/bench/device_meters.h"

namespace scree::bench {
namespace {

double constexpr everywhere = -std::numeric_limits<double>::infinity(), nowhere = -everywhere;
double constexpr radius = 0.8;  // of the bodies' balls; the networks' unit is the bodies' [d]

struct Options {
  std::string device = "cuda", output;
  int queries = 4'000'000, rounds = 9, shapes = 400;
  double filtered = 1e8;
};

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + v.size() / 2, v.end());
  return v[v.size() / 2];
}

Mlp random_net(Activation activation, double parameter, std::vector<int> width, unsigned seed) {
  Mlp net;
  net.activation = activation, net.parameter = parameter, net.width = std::move(width);
  std::mt19937 random(seed);
  for (int l = 0; l < net.layers(); ++l) {
    int const in = net.width[l], out = net.width[l + 1];
    double const gain = activation == Activation::sine ? 1 / parameter : 1;
    std::normal_distribution<float> weight(0, static_cast<float>(gain * std::sqrt(2.0 / in))), bias(0, 0.1f);
    for (auto& w : net.weight.emplace_back(in * out)) w = weight(random);
    for (auto& b : net.bias.emplace_back(out)) b = bias(random);
  }
  return net;
}

// The same, with phi = 0 somewhere in the ball: moved by its median along an axis.
Mlp with_surface(Mlp net) {
  std::vector<double> phi;
  for (int i = 0; i < 101; ++i) phi.push_back(evaluate_reference(net, net.bias[0], {0, 0, radius * (i / 50.0 - 1)}));
  net.bias.back()[0] -= static_cast<float>(median(phi));
  return net;
}

// Bodies of many shapes, and points in their balls grouped by network, those of a body together, as node lists are.
struct Scene {
  NetworkSet networks;
  std::vector<ShapeRecord> shape;
  std::vector<int> shape_of;
  std::vector<double> diameter;
  QueryBatch batch;

  void add(Mlp const& net, int codes) {
    networks.net.emplace_back(net);
    networks.bias_rows.emplace_back();
    std::mt19937 random(static_cast<unsigned>(shape.size() + 1));
    std::normal_distribution<float> component(0, 0.1f);
    for (int k = 0; k < codes; ++k) {
      std::vector<float> code(net.code_size());
      for (float& c : code) c = component(random);
      ShapeRecord s;
      s.sdf = SdfKind::net;
      s.net = static_cast<int>(networks.net.size()) - 1;
      s.bias_row = networks.net.back().append_bias(fold_code(net, code), networks.bias_rows.back());
      s.bounding_radius = radius;
      shape_of.push_back(static_cast<int>(shape.size()));
      diameter.push_back(1);
      shape.push_back(s);
    }
  }
  SceneView view() const {
    SceneView v;
    v.shape = shape, v.shape_of = shape_of, v.diameter = diameter;
    return v;
  }
  void fill(int queries, unsigned seed = 2) {
    std::mt19937 random(seed);
    batch.point.clear(), batch.partner.clear();
    std::uniform_real_distribution<double> uniform(-radius, radius);
    int const bodies = static_cast<int>(shape_of.size());
    batch.group.assign(query_groups(static_cast<int>(networks.net.size())) + 1, 0);
    for (int b = 0; b < bodies; ++b) {
      int const count = queries / bodies + (b < queries % bodies);
      for (int k = 0; k < count; ++k) {
        Vec3 p;
        do p = {uniform(random), uniform(random), uniform(random)};
        while (norm(p) > radius);
        batch.point.push_back(p);
        batch.partner.push_back(b);
      }
      for (std::size_t g = shape[b].net + 1; g < batch.group.size(); ++g) batch.group[g] += count;
    }
    batch.phi.resize(batch.point.size());
    batch.gradient.resize(batch.point.size());
  }
};

struct Subject {
  std::string name;
  double queries_per_second = 0, flop = 0;  // of a query; 0: not counted
};

struct Gate {
  std::string name;
  double value, target;
  bool at_most;
  bool met() const { return at_most ? value <= target : value >= target; }
};

double rate(NetworkDevice& device, Scene& scene, double gradient_from, int rounds) {
  std::vector<double> seconds;
  device.evaluate({}, scene.batch, gradient_from);  // warm
  for (int r = 0; r < rounds; ++r) {
    device.evaluate({}, scene.batch, gradient_from);
    seconds.push_back(device.kernel_seconds());
  }
  return static_cast<double>(scene.batch.point.size()) / median(seconds);
}

// Largest difference to the host over the first points.
double difference(Scene& scene) {
  int const n = std::min<int>(scene.batch.group[1], 100'000);
  QueryBatch host;
  host.point.assign(scene.batch.point.begin(), scene.batch.point.begin() + n);
  host.partner.assign(scene.batch.partner.begin(), scene.batch.partner.begin() + n);
  host.phi.resize(n);
  host.group.assign(scene.batch.group.size(), n);
  host.group[0] = 0;
  evaluate_phi({}, scene.view(), scene.networks, host);
  double largest = 0;
  for (int i = 0; i < n; ++i) largest = std::max(largest, std::abs(host.phi[i] - scene.batch.phi[i]));
  return largest;
}

// Points within 2e-2 d of the surface, and those inside that the fp16 filter rejected. Each round: random points, two
// Newton steps to a random level of phi, then all with fp16x3, and through the filter.
struct Rejections {
  double asked = 0, inside = 0, falsely = 0;
};
Rejections false_rejections(NetworkDevice& device, Scene& scene, Options const& o) {
  Rejections found;
  double constexpr reach = 2e-2;
  for (unsigned round = 0; found.asked < o.filtered; ++round) {
    scene.fill(o.queries, 100 + round);
    QueryBatch& batch = scene.batch;
    std::mt19937 random(round);
    std::uniform_real_distribution<double> level(-reach, reach);
    for (int step = 0; step < 2; ++step) {
      device.evaluate({}, batch, everywhere);
      for (std::size_t i = 0; i < batch.point.size(); ++i) {
        Vec3 const g = batch.gradient[i];
        Vec3 const moved = batch.point[i] + g * ((level(random) - batch.phi[i]) / std::max(norm2(g), 1e-2));
        if (norm(moved) < radius) batch.point[i] = moved;
      }
    }
    device.evaluate({}, batch, everywhere);
    std::vector<double> const exact = batch.phi;
    device.evaluate({}, batch, 0);
    double near = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      near += std::abs(exact[i]) < reach;
      found.inside += exact[i] > 0;
      found.falsely += exact[i] > 0 && batch.phi[i] != exact[i];
    }
    if (near == 0) throw std::runtime_error("no point came near a surface");
    found.asked += near;
  }
  return found;
}

// Root mean square error of phi against the double reference, for a scene of one network without a code.
double error_of_phi(Scene const& scene, Mlp const& net) {
  std::size_t const n = std::min<std::size_t>(scene.batch.point.size(), 20'000);
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double const e =
        scene.batch.phi[i] - evaluate_reference(net, net.bias[0], to_double(to_float(scene.batch.point[i])));
    sum += e * e;
  }
  return std::sqrt(sum / static_cast<double>(n));
}

// The grids of 43^3 points over the ball's cube that the networks' values fill.
double grid_rate(Scene& scene, int rounds) {
  GridFrame frame;
  frame.nx = frame.ny = frame.nz = 43;
  frame.cell = 2 * radius / 42;
  frame.origin = {-radius, -radius, -radius};
  std::vector<float> value(frame.points() * scene.shape.size());
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (float& v : value) v = uniform(random);  // the cost does not depend on the values
  std::vector<double> phi(scene.batch.point.size());
  return static_cast<double>(phi.size()) /
         time_grid_lookups(frame, value, scene.batch.point, scene.batch.partner, rounds, phi);
}

void write_json(std::string const& file, std::string const& device, double peak, Options const& o,
                std::vector<Subject> const& subjects, std::vector<Gate> const& gates) {
  auto out = fmt::output_file(file);
  auto const number = [](double v) { return std::isfinite(v) ? fmt::format("{:.6g}", v) : std::string("null"); };
  out.print("{{\n  \"benchmark\": \"bench_device\",\n  \"commit\": \"{}\",\n  \"device\": \"{}\",\n",
            build_info().commit, device);
  out.print("  \"queries\": {},\n  \"rounds\": {},\n  \"peak_flop_per_s\": {},\n  \"subjects\": {{", o.queries,
            o.rounds, number(peak));
  for (std::size_t i = 0; i < subjects.size(); ++i)
    out.print("{}\n    \"{}\": {{\"queries_per_s\": {}, \"flop_per_query\": {}}}", i ? "," : "", subjects[i].name,
              number(subjects[i].queries_per_second), number(subjects[i].flop));
  out.print("\n  }},\n  \"results\": {{");
  for (std::size_t i = 0; i < gates.size(); ++i)
    out.print("{}\n    \"{}\": {{\"value\": {}, \"target\": {}}}", i ? "," : "", gates[i].name, number(gates[i].value),
              number(gates[i].target));
  out.print("\n  }}\n}}\n");
}

int run(int argc, char** argv) {
  CLI::App app("Queries per second of the network kernel on a GPU, with the bars it has to meet.");
  Options o;
  app.add_option("--device", o.device, "cuda, or emulated: the kernel's text on the host, to try the program")
      ->check(CLI::IsMember({"cuda", "emulated"}));
  app.add_option("--queries", o.queries, "points a launch")->check(CLI::Range(1000, 100'000'000));
  app.add_option("--shapes", o.shapes, "different shapes against as many grids")->check(CLI::Range(1, 10'000));
  app.add_option("--rounds", o.rounds, "launches of each subject")->check(CLI::Range(1, 1000));
  app.add_option("--filtered", o.filtered, "points near a surface that the fp16 filter is tried with")
      ->check(CLI::Range(1.0, 1e12));
  app.add_option("--output", o.output, "write the medians as JSON");
  CLI11_PARSE(app, argc, argv);

  auto const device = o.device == "cuda" ? make_cuda_network_device() : make_emulated_network_device();
  bool const on_device = o.device == "cuda";  // the emulated kernel is compared with nothing, and needs no GPU
  double const peak = on_device ? measure_device_peak() : std::numeric_limits<double>::quiet_NaN();
  std::vector<Subject> subjects;
  std::vector<Gate> gates;
  double worst = 0, worst_tensor = 0;
  std::vector<int> const plain{3, 40, 40, 40, 40, 40, 1}, coded{13, 40, 40, 40, 40, 40, 1};
  for (auto const& [activation, parameter] :
       {std::pair(Activation::leaky_relu, 0.01), std::pair(Activation::sine, 5.0)}) {
    Scene scene;
    Mlp const net = with_surface(random_net(activation, parameter, plain, 1));
    scene.add(net, 1);
    scene.fill(o.queries);
    device->load(scene.view(), scene.networks);
    double const forward = rate(*device, scene, nowhere, o.rounds),
                 gradient = rate(*device, scene, everywhere, o.rounds);
    worst = std::max(worst, difference(scene));
    double const fp32_error = error_of_phi(scene, net);
    std::string const name = to_string(activation);
    subjects.push_back({name + " 5x40, forward", forward, flop_per_query(net)});
    subjects.push_back({name + " 5x40, forward, then forward and back", gradient, 3 * flop_per_query(net)});
    gates.push_back({name + " forward, Gq/s", 1e-9 * forward, 2, false});
    device->load(scene.view(), scene.networks, Precision::fp16x3);
    double const nothing_wanted = 1e9;  // [m]: what the filter costs when it leaves nothing
    double const tensor_forward = rate(*device, scene, nowhere, o.rounds);
    double const tensor_gradient = rate(*device, scene, everywhere, o.rounds);
    worst_tensor = std::max(worst_tensor, error_of_phi(scene, net) / fp32_error);
    double const filter = rate(*device, scene, nothing_wanted, o.rounds);
    subjects.push_back({name + " 5x40, fp16x3, forward", tensor_forward, flop_per_query(net)});
    subjects.push_back({name + " 5x40, fp16x3, forward and back", tensor_gradient, 2 * flop_per_query(net)});
    subjects.push_back({name + " 5x40, fp16 filter", filter, flop_per_query(net)});
    gates.push_back({name + " fp16x3 forward, Gq/s", 1e-9 * tensor_forward, 4, false});
    gates.push_back({name + " fp16x3 forward and back, Gq/s", 1e-9 * tensor_gradient, 2, false});
    gates.push_back({name + " fp16 filter, Gq/s", 1e-9 * filter, 8, false});
    Rejections const rejections = false_rejections(*device, scene, o);
    gates.push_back(
        {fmt::format("{} falsely rejected of {:.3g} near, {:.3g} inside", name, rejections.asked, rejections.inside),
         rejections.falsely, 0, true});
    gates.push_back({name + " fp16x3 over fp32, forward", tensor_forward / forward, 1, false});
  }
  {
    Scene many, decoder;
    for (int k = 0; k < o.shapes; ++k) many.add(random_net(Activation::sine, 5, plain, k + 10), 1);
    decoder.add(random_net(Activation::sine, 5, coded, 1), o.shapes);
    for (Scene* s : {&many, &decoder}) {
      s->fill(o.queries);
      device->load(s->view(), s->networks);
      double const q = rate(*device, *s, nowhere, o.rounds);
      worst = std::max(worst, difference(*s));
      subjects.push_back({fmt::format("sine 5x40, {} {}", o.shapes, s == &many ? "networks" : "codes of one decoder"),
                          q, flop_per_query(s->networks.net[0].net())});
    }
    double const grid = on_device ? grid_rate(decoder, o.rounds) : std::numeric_limits<double>::quiet_NaN();
    subjects.push_back({fmt::format("{} grids of 43^3, trilinear", o.shapes), grid, 0});
    gates.push_back({fmt::format("grid lookups over queries, {} codes", o.shapes),
                     grid / subjects[subjects.size() - 2].queries_per_second, 6, true});
  }
  gates.push_back({"largest difference of phi to the host", worst, 1e-5, true});
  gates.push_back({"error of phi, fp16x3 over fp32", worst_tensor, 2, true});

  fmt::print("{}\npeak {:.1f} TFLOP/s in fp32, measured\n\n{:48} {:>10} {:>10} {:>8}\n", device->describe(),
             1e-12 * peak, "medians of kernel times", "Gqueries/s", "TFLOP/s", "of peak");
  for (Subject const& s : subjects) {
    fmt::print("{:48} {:10.3f}", s.name, 1e-9 * s.queries_per_second);
    if (s.flop > 0)
      fmt::print(" {:10.2f} {:7.1f} %", 1e-12 * s.flop * s.queries_per_second,
                 100 * s.flop * s.queries_per_second / peak);
    fmt::print("\n");
  }
  fmt::print("\n");
  bool met = true;
  for (Gate const& g : gates) {
    met = met && g.met();
    fmt::print("{:48} {:10.3g}  bar {} {:g}: {}\n", g.name, g.value, g.at_most ? "<=" : ">=", g.target,
               g.met() ? "met" : "MISSED");
  }
  if (!o.output.empty()) write_json(o.output, device->describe(), peak, o, subjects, gates);
  return met || o.device != "cuda" ? 0 : 1;
}

}  // namespace
}  // namespace scree::bench

int main(int argc, char** argv) {
  try {
    return scree::bench::run(argc, argv);
  } catch (scree::DeviceError const& e) {
    fmt::print(stderr, "bench_device: {}\n", e.what());
    return 3;
  } catch (std::exception const& e) {
    fmt::print(stderr, "bench_device: {}\n", e.what());
    return 2;
  }
}

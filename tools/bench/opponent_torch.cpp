// opponent_torch.cpp: the network in LibTorch on the CPU, one thread; gradient by autograd. Logs the BLAS it calls.
// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>
#include <link.h>
#include <torch/torch.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "tools/bench/opponents.h"

namespace scree::bench {

namespace {

class TorchNet final : public Opponent {
 public:
  explicit TorchNet(Mlp const& net) : slope_(net.parameter) {
    for (int l = 0; l < net.layers(); ++l) {
      weight_.push_back(
          torch::from_blob(const_cast<float*>(net.weight[l].data()), {net.width[l], net.width[l + 1]}).clone());
      bias_.push_back(torch::from_blob(const_cast<float*>(net.bias[l].data()), {net.width[l + 1]}).clone());
    }
  }

  void forward(Span<const Vec3f> point, int chunk, Span<float> phi) override {
    torch::InferenceMode const no_graph;
    for (int first = 0; first < point.size(); first += chunk) {
      int const n = std::min(chunk, point.size() - first);
      write(evaluate(input(point, first, n), true), phi.data + first);
    }
  }

  void gradient(Span<const Vec3f> point, int chunk, Span<float> phi, Span<Vec3f> gradient) override {
    for (int first = 0; first < point.size(); first += chunk) {
      int const n = std::min(chunk, point.size() - first);
      auto const x = input(point, first, n).requires_grad_(true);
      auto const y = evaluate(x, false);
      write(y, phi.data + first);
      write(torch::autograd::grad({y}, {x}, {torch::ones_like(y)})[0], &gradient[first].x);
    }
  }

 private:
  static torch::Tensor input(Span<const Vec3f> point, int first, int n) {
    return torch::from_blob(const_cast<float*>(&point[first].x), {n, 3});
  }
  static void write(torch::Tensor const& from, float* to) {
    auto const c = from.detach().contiguous();
    std::copy_n(c.data_ptr<float>(), c.numel(), to);
  }
  torch::Tensor evaluate(torch::Tensor h, bool in_place) const {
    for (std::size_t l = 0; l < weight_.size(); ++l) {
      h = torch::addmm(bias_[l], h, weight_[l]);
      if (l + 1 == weight_.size()) break;
      h = in_place ? torch::leaky_relu_(h, slope_) : torch::leaky_relu(h, slope_);
    }
    return h;
  }

  double slope_;
  std::vector<torch::Tensor> weight_, bias_;
};

int find_blas(dl_phdr_info* info, std::size_t, void* found) {
  std::string const name = info->dlpi_name;
  std::error_code error;
  auto const real = std::filesystem::canonical(name, error);
  auto const file = (error ? std::filesystem::path(name) : real).filename().string();
  if (file.find("blas") == std::string::npos && file.find("mkl") == std::string::npos) return 0;
  auto& text = *static_cast<std::string*>(found);
  text += (text.empty() ? "" : ", ") + file;
  return 0;
}

}  // namespace

std::unique_ptr<Opponent> make_torch(Mlp const& net) { return std::make_unique<TorchNet>(net); }

std::string blas_in_use() {
  std::string text;
  dl_iterate_phdr(find_blas, &text);
  if (auto* config = reinterpret_cast<char* (*)()>(dlsym(RTLD_DEFAULT, "openblas_get_config")))
    text += std::string(" (") + config() + ")";
  return text.empty() ? "none found" : text;
}

void use_one_thread() {
  at::set_num_threads(1);
  if (auto* set = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"))) set(1);
}

}  // namespace scree::bench

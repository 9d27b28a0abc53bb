// checkpoint.cpp: see checkpoint.h. A list of tensors in LibTorch's own format: a working file, not for exchange.
// SPDX-License-Identifier: Apache-2.0
#include "training/checkpoint.h"

#include <torch/serialize.h>
#include <torch/version.h>

#include <sstream>
#include <stdexcept>

namespace scree {
namespace {

using torch::Tensor;

int constexpr fixed_columns = 9;  // of a history row, before the bodies' errors

Tensor text_tensor(std::string const& text) {
  Tensor result = torch::empty({static_cast<std::int64_t>(text.size())}, torch::kUInt8);
  std::copy(text.begin(), text.end(), result.data_ptr<std::uint8_t>());
  return result;
}

std::string text_of(Tensor const& tensor) {
  auto const* const data = tensor.data_ptr<std::uint8_t>();
  return {data, data + tensor.numel()};
}

Tensor history_tensor(std::vector<EpochRecord> const& history) {
  std::int64_t const bodies = history.empty() ? 0 : static_cast<std::int64_t>(history.front().body_mae.size());
  Tensor result = torch::zeros({static_cast<std::int64_t>(history.size()), fixed_columns + bodies}, torch::kFloat64);
  double* at = result.data_ptr<double>();
  for (EpochRecord const& r : history) {
    for (double value : {double(r.epoch), double(r.step), double(r.steps), r.loss, r.train_mae, r.mean_mae, r.worst_mae,
                         double(r.best), r.seconds})
      *at++ = value;
    for (double value : r.body_mae) *at++ = value;
  }
  return result;
}

std::vector<EpochRecord> history_of(Tensor const& tensor) {
  std::vector<EpochRecord> history;
  std::int64_t const columns = tensor.size(1);
  for (std::int64_t i = 0; i < tensor.size(0); ++i) {
    double const* const at = tensor.data_ptr<double>() + i * columns;
    EpochRecord r;
    r.epoch = static_cast<int>(at[0]), r.step = static_cast<int>(at[1]), r.steps = static_cast<int>(at[2]);
    r.loss = at[3], r.train_mae = at[4], r.mean_mae = at[5], r.worst_mae = at[6];
    r.best = at[7] != 0, r.seconds = at[8];
    r.body_mae.assign(at + fixed_columns, at + columns);
    history.push_back(r);
  }
  return history;
}

}  // namespace

std::string fingerprint(std::vector<Body> const& bodies, TrainOptions const& o) {
  std::ostringstream text;
  text.precision(17);
  SamplingOptions const& s = o.samples;
  text << "LibTorch " TORCH_VERSION << " activation " << to_string(o.activation) << ' ' << o.parameter << " layers "
       << o.layers << " width " << o.width << " code " << o.code_size << " steps " << o.steps << " rows " << o.rows
       << " units " << o.units << " loss " << int(o.loss) << " schedule " << int(o.schedule) << " rate " << o.rate
       << " second moment " << o.second_moment << " code rule " << int(o.code_rule) << ' ' << int(o.code_start) << ' '
       << o.code_rate << ' ' << o.code_spread << ' ' << o.code_penalty << ' ' << o.code_limit << " slope "
       << o.slope_weight << " eikonal " << o.eikonal_weight << " finish " << o.finish.iterations << ' '
       << o.finish.history << ' ' << o.finish.samples << " test " << o.test_count << " seed " << o.seed << " device "
       << o.device << " samples " << s.count << ' ' << int(s.region) << ' ' << s.share_surface << ' ' << s.share_curved
       << ' ' << s.share_interior << ' ' << s.band << " bodies";
  for (Body const& b : bodies)
    text << ' ' << b.name << '|' << b.source << '|' << b.source_hash << '|' << b.bounding_radius;
  return text.str();
}

void write_checkpoint(std::filesystem::path const& file, std::string const& fingerprint, Trainer& trainer,
                      Progress const& progress) {
  torch::NoGradGuard const no_gradient;
  Tensor const none = torch::zeros({0});
  bool const coded = trainer.decoder().flat_codes().defined();
  std::vector<Tensor> const all = {
      text_tensor(fingerprint),
      torch::tensor({double(progress.epoch), double(progress.done), progress.best, double(progress.best_epoch),
                     double(trainer.weight_adam().count()), double(trainer.code_adam().count())},
                    torch::kFloat64),
      history_tensor(progress.history),
      trainer.decoder().flat_weights(),
      coded ? trainer.decoder().flat_codes() : none,
      trainer.weight_adam().mean(),
      trainer.weight_adam().square(),
      trainer.code_adam().mean(),
      trainer.code_adam().square(),
      progress.best_weights,
      coded ? progress.best_codes : none};
  std::filesystem::path const temporary = file.string() + ".partial";
  try {
    torch::save(all, temporary.string());
    std::filesystem::rename(temporary, file);
  } catch (std::exception const& error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw std::runtime_error(file.string() + ": the checkpoint cannot be written: " + error.what());
  }
}

void read_checkpoint(std::filesystem::path const& file, std::string const& fingerprint, Trainer& trainer,
                     Progress& progress) {
  std::vector<Tensor> all;
  try {
    torch::load(all, file.string());
  } catch (std::exception const&) {  // LibTorch's text is a page of stack frames
    throw std::runtime_error(file.string() + ": no readable checkpoint; remove it to start again");
  }
  if (all.size() != 11) throw std::runtime_error(file.string() + ": no checkpoint of a training");
  std::string const theirs = text_of(all[0]);
  if (theirs != fingerprint)
    throw std::invalid_argument(file.string() + ": the checkpoint is of another training; it has\n  " + theirs +
                                "\nasked for is\n  " + fingerprint);
  double const* const number = all[1].data_ptr<double>();
  progress.epoch = static_cast<int>(number[0]);
  progress.done = static_cast<int>(number[1]);
  progress.best = number[2];
  progress.best_epoch = static_cast<int>(number[3]);
  progress.history = history_of(all[2]);
  trainer.decoder().load(all[3], all[4]);
  trainer.weight_adam().restore(all[5], all[6], static_cast<std::int64_t>(number[4]));
  trainer.code_adam().restore(all[7], all[8], static_cast<std::int64_t>(number[5]));
  progress.best_weights = all[9];
  progress.best_codes = all[10];
}

}  // namespace scree

// train_options.cpp: the command-line options of every training.
// SPDX-License-Identifier: Apache-2.0
#include <map>

#include "tools/train_commands.h"

namespace scree {
namespace {

std::map<std::string, Activation> const activations = {
    {"sine", Activation::sine}, {"softplus", Activation::softplus}, {"leaky_relu", Activation::leaky_relu}};
std::map<std::string, Loss> const losses = {{"l1", Loss::l1}, {"l2", Loss::l2}, {"smooth_l1", Loss::smooth_l1}};
std::map<std::string, Schedule> const schedules = {{"cosine", Schedule::cosine}, {"constant", Schedule::constant}};
std::map<std::string, SampleRegion> const regions = {{"ball", SampleRegion::ball},
                                                     {"shell", SampleRegion::paper_shell}};

// The activation's own parameter where none is given.
double default_parameter(Activation activation) {
  switch (activation) {
    case Activation::sine:
      return 8;
    case Activation::softplus:
      return 20;
    case Activation::leaky_relu:
      return 0.01;
  }
  return 1;  // unreachable: every activation is listed
}

template <class T>
void add_choice(CLI::App& c, char const* name, T& value, std::map<std::string, T> const& words, char const* what) {
  c.add_option_function<std::string>(
       name, [&value, words](std::string const& word) { value = words.at(word); }, what)
      ->check(CLI::IsMember(words))
      ->trigger_on_parse();
}

void add_network_options(CLI::App& c, TrainOptions& t) {
  c.add_option("--layers", t.layers, "Hidden layers")->check(CLI::Range(1, 16))->capture_default_str();
  c.add_option("--width", t.width, "Neurons a hidden layer")->check(CLI::Range(8, 64))->capture_default_str();
  c.add_option_function<std::string>(
       "--activation",
       [&t](std::string const& word) {
         t.activation = activations.at(word);
         t.parameter = default_parameter(t.activation);
       },
       "sine (default), softplus or leaky_relu")
      ->check(CLI::IsMember(activations))
      ->trigger_on_parse();
  c.add_option("--parameter", t.parameter, "omega of sine (8), beta of softplus (20), slope of leaky_relu (0.01)");
}

void add_loss_options(CLI::App& c, TrainOptions& t) {
  add_choice(c, "--loss", t.loss, losses, "l1 (default), l2 or smooth_l1");
  c.add_option("--slope-weight", t.slope_weight, "Weight of the directional derivative in the loss")
      ->capture_default_str();
  c.add_option("--eikonal-weight", t.eikonal_weight, "Weight of | |grad phi| - 1 |; makes a step three times dearer")
      ->capture_default_str();
  add_choice(c, "--schedule", t.schedule, schedules, "cosine (default) or constant rate");
  c.add_option("--rate", t.rate, "First learning rate")->capture_default_str();
  c.add_option("--finish", t.finish.iterations, "L-BFGS iterations after the last step")->capture_default_str();
}

void add_sampling_options(CLI::App& c, SamplingOptions& s) {
  c.add_option("--samples", s.count, "Training samples a shape")->capture_default_str();
  add_choice(c, "--region", s.region, regions, "ball (default), or the paper's shell");
  c.add_option("--share-surface", s.share_surface, "Share of samples beside the surface")->capture_default_str();
  c.add_option("--share-curved", s.share_curved, "Share beside edges and bends")->capture_default_str();
  c.add_option("--share-interior", s.share_interior, "Share inwards from the surface")->capture_default_str();
  c.add_option("--band", s.band, "Width of the first two [d]")->capture_default_str();
}

}  // namespace

void add_training_options(CLI::App& c, TrainArguments& a) {
  TrainOptions& t = a.train;
  c.add_option("-o,--output", a.output, "Model file to write (.h5)")->required();
  c.add_flag("--force", a.force, "Replace an existing output file");
  // First: the options after it change the recipe.
  c.add_option_function<std::string>(
       "--recipe",
       [&a](std::string const& word) {
         a.recipe = word;
         bool const coded = a.train.code_size > 0;
         int constexpr grains = 20;
         if (word == "paper") a.train = coded ? paper_coded_options(grains) : paper_single_options();
       },
       "default, or paper: that of Li et al. (2026); write it before the options that change it")
      ->check(CLI::IsMember({"default", "paper"}))
      ->trigger_on_parse();
  add_network_options(c, t);
  add_loss_options(c, t);
  add_sampling_options(c, t.samples);
  CLI::Option* const steps = c.add_option("--steps", t.steps, "Optimiser steps")->capture_default_str();
  c.add_option("--seconds", a.seconds, "Choose the steps so that training takes about this long [s]")->excludes(steps);
  c.add_option("--rows", t.rows, "Samples of a work unit")->capture_default_str();
  c.add_option("--units", t.units, "Work units a step; changes the result, --threads does not")->capture_default_str();
  c.add_option("--seed", t.seed, "Seed of weights, samples and batches")->capture_default_str();
  c.add_option("--threads", t.threads, "CPU threads")->check(CLI::Range(1, 256))->capture_default_str();
  c.add_option("--device", t.device, "cpu, cuda, or auto")
      ->check(CLI::IsMember({"cpu", "cuda", "auto"}))
      ->capture_default_str();
  c.add_option("--checkpoint", a.checkpointing.file, "Write the training's state here about every minute");
  c.add_flag("--resume", a.checkpointing.resume, "Go on from the checkpoint if there is one")->needs("--checkpoint");
  c.add_option("--log", a.log, "Write test errors of every epoch to this CSV file");
  c.add_flag("-q,--quiet", a.quiet, "Only the last line");
}

}  // namespace scree

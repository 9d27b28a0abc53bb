// main.cpp: a program of another project that steps a case with scree::core and prints where its grain is.
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "core/simulation.h"

int main(int, char** argv) {
  scree::Simulation simulation(scree::load_case(argv[1], {}), {});
  while (simulation.step() == scree::RunState::running) {
  }
  std::printf("%.6f s %.6f m\n", simulation.time(), simulation.frame().position.at(0).z);
}

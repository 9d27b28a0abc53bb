// queue.h: where a stage runs (backend, threads, stream) and who times it.
// First argument of every stage; owns nothing.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace scree {

class Profile;

enum class Backend { cpu, cuda };

struct Queue {
  Backend backend = Backend::cpu;
  int threads = 1;             // OpenMP threads of the CPU backend
  void* stream = nullptr;      // cudaStream_t of the CUDA backend
  Profile* profile = nullptr;  // nullptr: nothing is timed
};

}  // namespace scree

// config.h: compiler facts every other file may rely on.
// One place for the host/device markers, so that the same source compiles with g++ and nvcc.
// SPDX-License-Identifier: Apache-2.0
#pragma once

static_assert(__cplusplus >= 202002L, "Scree needs C++20 (nvcc: pass -std=c++20)");

#if defined(__CUDACC__)
#define SCREE_HD __host__ __device__
#else
#define SCREE_HD
#endif

// process_memory.h: how much memory this process has in use, as the kernel counts it.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace scree {

// Resident set [bytes], after what the C library keeps of freed memory went back to the system. Pages that were never
// touched do not count. Linux; 0 where /proc is missing.
std::size_t resident_bytes();

}  // namespace scree

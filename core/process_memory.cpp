// process_memory.cpp: see process_memory.h.
// SPDX-License-Identifier: Apache-2.0
#include "core/process_memory.h"

#include <unistd.h>

#include <fstream>
#include <string>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace scree {

std::size_t resident_bytes() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
  // The exact sum over all mappings; the counters of statm are kept for each processor and may lag by many pages.
  std::ifstream rollup("/proc/self/smaps_rollup");
  for (std::string word; rollup >> word;)
    if (std::size_t kilobytes = 0; word == "Rss:" && rollup >> kilobytes) return kilobytes * 1024;
  std::size_t size = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> size >> resident;  // in pages
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace scree

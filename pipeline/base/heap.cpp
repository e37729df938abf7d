#include "pipeline/base/heap.h"

#include <malloc.h>
#include <sys/prctl.h>

#include <cstddef>
#include <cstdio>

// jemalloc's (its manual, section MALLCTL NAMESPACE); null where the program uses glibc's heap.
extern "C" int mallctl(const char* name, void* old, std::size_t* old_size, void* given, std::size_t given_size)
    __attribute__((weak));

// Read by jemalloc as it starts (its manual, section TUNING). Huge pages: a build touches its memory once, mostly, and a
// page fault for each 4 KB was a tenth of its time. What is free goes back after five seconds: each tile finds the pages of the one
// before; half a second cost a fifth more time and saved a fifteenth of the memory.
extern "C" const char* malloc_conf;
const char* malloc_conf = "thp:always,dirty_decay_ms:5000,muzzy_decay_ms:0";

namespace blockrand::base {

void give_memory_back() {
  if (mallctl == nullptr) {
    ::malloc_trim(0);
    return;
  }
  constexpr const char* kAllArenas = "arena.4096.purge";  // MALLCTL_ARENAS_ALL
  mallctl(kAllArenas, nullptr, nullptr, nullptr, 0);
}

void keep_memory_low() {
  // A huge page stays as long as a byte of it is used: 50 MB at the peak of a dense area.
  ::prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
  if (mallctl == nullptr) {
    constexpr int kKept = 200'000;  // bytes at the end of the heap
    ::mallopt(M_TRIM_THRESHOLD, kKept);
    ::mallopt(M_MMAP_THRESHOLD, 128 * 1024);
    return;
  }
  // Pages that are free go back after this. Sooner costs time: of a dense area 88 CPU seconds instead of 63 with 100 ms, for 70 MB less.
  std::ptrdiff_t decay = 1000;  // ms
  mallctl("arenas.dirty_decay_ms", nullptr, nullptr, &decay, sizeof(decay));
  unsigned arenas = 0;
  std::size_t size = sizeof(arenas);
  if (mallctl("arenas.narenas", &arenas, &size, nullptr, 0) != 0) return;
  for (unsigned a = 0; a < arenas; ++a) {
    char name[64];
    std::snprintf(name, sizeof(name), "arena.%u.dirty_decay_ms", a);
    mallctl(name, nullptr, nullptr, &decay, sizeof(decay));
  }
}

}  // namespace blockrand::base

// SPDX-License-Identifier: MIT
// Preloaded before the program (LD_PRELOAD): lets one of its allocations fail.
//
//   AFTERGLOW_FAULT_CALL=N     the Nth allocation fails with std::bad_alloc (from 1; 0: none)
//   AFTERGLOW_FAULT_LOG=FILE   where the program asks, written when it ends: the number of the first and of the last
//                              allocation by each way through its functions, then that of all, a line each
//
// Only what the program's own code asks of `operator new` from main() on counts, directly or through libraries that
// pass exceptions on: compilers inside drivers end the process when they get no memory, and nobody above them can help
// that.
#include <dlfcn.h>
#include <execinfo.h>
#include <link.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <new>
#include <set>
#include <utility>

namespace {

struct Range {
  std::uintptr_t begin = 0, end = 0;
  bool holds(const void* address) const {
    const auto at = reinterpret_cast<std::uintptr_t>(address);
    return at >= begin && at < end;
  }
};

Range program, library, own;  // the executable, libstdc++ and this file
std::atomic<bool> ready{false};
std::atomic<long> calls{0};
long wanted = 0;
const char* log_name = nullptr;
thread_local bool inside = false;

/// By their ways: the numbers of the first and the last allocation.
using Ways = std::map<std::uint64_t, std::pair<long, long>>;
Ways* ways = nullptr;  // never freed: threads may outlive what is destroyed at the end
std::mutex ways_mutex;

int note_module(dl_phdr_info* info, std::size_t, void*) {
  Range range{~std::uintptr_t{0}, 0};
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& part = info->dlpi_phdr[i];
    if (part.p_type != PT_LOAD) continue;
    range.begin = std::min<std::uintptr_t>(range.begin, info->dlpi_addr + part.p_vaddr);
    range.end = std::max<std::uintptr_t>(range.end, info->dlpi_addr + part.p_vaddr + part.p_memsz);
  }
  if (info->dlpi_name[0] == 0) program = range;
  if (std::strstr(info->dlpi_name, "libstdc++")) library = range;
  if (range.holds(reinterpret_cast<const void*>(&note_module))) own = range;
  return 0;
}

struct Setting {
  Setting() {
    if (const char* number = std::getenv("AFTERGLOW_FAULT_CALL")) wanted = std::atol(number);
    log_name = std::getenv("AFTERGLOW_FAULT_LOG");
    if (log_name) ways = new Ways;
    dl_iterate_phdr(note_module, nullptr);
    void* warm[1];
    backtrace(warm, 1);  // loads what it needs
  }
  ~Setting() {
    ready = false;
    std::FILE* log = log_name ? std::fopen(log_name, "we") : nullptr;
    if (!log) return;
    const std::lock_guard lock(ways_mutex);
    std::set<long> places;
    for (const auto& [way, numbers] : *ways) places.insert({numbers.first, numbers.second});
    places.insert(calls);
    for (const long place : places) std::fprintf(log, "%ld\n", place);
    std::fclose(log);
  }
} setting;

/// Drivers are loaded late, and share what the C++ library's templates left in the program.
bool is_foreign(const void* address) {
  Dl_info info{};
  return dladdr(address, &info) && info.dli_fname &&
         (std::strstr(info.dli_fname, "libLLVM") || std::strstr(info.dli_fname, "ulkan") ||
          std::strstr(info.dli_fname, "libVkLayer"));
}

bool is_the_programs() {
  constexpr int kDepth = 16;
  void* frames[kDepth];
  const int count = backtrace(frames, kDepth);
  int first = 0;
  while (first < count && (own.holds(frames[first]) || library.holds(frames[first]))) ++first;
  if (first == count || !program.holds(frames[first])) return false;
  for (int i = first; i < count && i < first + 6; ++i)
    if (!program.holds(frames[i]) && !library.holds(frames[i]) && is_foreign(frames[i])) return false;
  return true;
}

/// What of the program called what, down to main or the thread's first function. Depths of recursion are alike.
std::uint64_t way_here() {
  constexpr int kDepth = 96;
  void* frames[kDepth];
  const int count = backtrace(frames, kDepth);
  std::uint64_t way = 14695981039346656037u;  // FNV-1a
  const void* before = nullptr;
  for (int i = 0; i < count; ++i) {
    if (!program.holds(frames[i]) || frames[i] == before) continue;
    way = (way ^ (reinterpret_cast<std::uintptr_t>(frames[i]) - program.begin)) * 1099511628211u;
    before = frames[i];
  }
  return way;
}

void note_way(long number) {
  const std::uint64_t way = way_here();
  const std::lock_guard lock(ways_mutex);
  ways->try_emplace(way, number, number).first->second.second = number;
}

bool strikes() {
  if (!ready || inside) return false;
  inside = true;
  long number = 0;
  if (is_the_programs()) {
    number = ++calls;
    if (ways) note_way(number);
  }
  inside = false;
  return number != 0 && number == wanted;
}

void* take(std::size_t size, std::size_t alignment) {
  if (strikes()) return nullptr;
  if (size == 0) size = 1;
  if (alignment <= alignof(std::max_align_t)) return std::malloc(size);
  return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

void* take_or_throw(std::size_t size, std::size_t alignment) {
  if (void* memory = take(size, alignment)) return memory;
  if (const auto handler = std::get_new_handler()) handler();
  throw std::bad_alloc();
}

}  // namespace

#define EXPORT __attribute__((visibility("default")))

using Main = int (*)(int, char**, char**);
static Main real_main = nullptr;
static int main_from_here(int argc, char** argv, char** environment) {
  ready = true;
  return real_main(argc, argv, environment);
}
// NOLINTNEXTLINE(bugprone-reserved-identifier): the C library calls main by way of it
extern "C" EXPORT int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(),
                                        void (*rtld_fini)(), void* stack_end) {
  real_main = main;
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  const auto start = reinterpret_cast<Start>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(main_from_here, argc, argv, init, fini, rtld_fini, stack_end);
}

EXPORT void* operator new(std::size_t size) { return take_or_throw(size, 1); }
EXPORT void* operator new[](std::size_t size) { return take_or_throw(size, 1); }
EXPORT void* operator new(std::size_t size, std::align_val_t a) { return take_or_throw(size, std::size_t(a)); }
EXPORT void* operator new[](std::size_t size, std::align_val_t a) { return take_or_throw(size, std::size_t(a)); }
EXPORT void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return take(size, 1); }
EXPORT void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return take(size, 1); }
EXPORT void operator delete(void* memory) noexcept { std::free(memory); }
EXPORT void operator delete[](void* memory) noexcept { std::free(memory); }
EXPORT void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
EXPORT void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
EXPORT void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
EXPORT void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
EXPORT void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
EXPORT void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
EXPORT void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
EXPORT void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }

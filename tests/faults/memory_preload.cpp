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
#include <unwind.h>

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

/// Goes up from an allocation until it is known whose it is.
struct Asker {
  bool known = false, is_the_programs = false;
  int left = 6;
};

_Unwind_Reason_Code look_at(_Unwind_Context* context, void* into) {
  auto& asker = *static_cast<Asker*>(into);
  const auto* at = reinterpret_cast<const void*>(_Unwind_GetIP(context));
  if (!asker.known && (own.holds(at) || library.holds(at))) return _URC_NO_REASON;
  if (!asker.known) asker.is_the_programs = program.holds(at);
  asker.known = true;
  if (!program.holds(at) && !library.holds(at) && is_foreign(at)) asker.is_the_programs = false;
  return asker.is_the_programs && --asker.left > 0 ? _URC_NO_REASON : _URC_NORMAL_STOP;
}

bool is_the_programs() {
  Asker asker;
  _Unwind_Backtrace(look_at, &asker);
  return asker.is_the_programs;
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

bool strikes(const void* caller) {
  if (!ready || inside) return false;
  if (!ways && (wanted == 0 || calls >= wanted)) return false;  // nothing is left to find out
  if (!program.holds(caller) && !library.holds(caller)) return false;
  inside = true;
  long number = 0;
  if (is_the_programs()) {
    number = ++calls;
    if (ways) note_way(number);
  }
  inside = false;
  return number != 0 && number == wanted;
}

void* take(std::size_t size, std::size_t alignment, const void* caller) {
  if (strikes(caller)) return nullptr;
  if (size == 0) size = 1;
  if (alignment <= alignof(std::max_align_t)) return std::malloc(size);
  return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
}

void* take_or_throw(std::size_t size, std::size_t alignment, const void* caller) {
  if (void* memory = take(size, alignment, caller)) return memory;
  if (const auto handler = std::get_new_handler()) handler();
  throw std::bad_alloc();
}

}  // namespace

#define EXPORT __attribute__((visibility("default")))
#define CALLER __builtin_return_address(0)

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

EXPORT void* operator new(std::size_t size) { return take_or_throw(size, 1, CALLER); }
EXPORT void* operator new[](std::size_t size) { return take_or_throw(size, 1, CALLER); }
EXPORT void* operator new(std::size_t size, std::align_val_t a) { return take_or_throw(size, std::size_t(a), CALLER); }
EXPORT void* operator new[](std::size_t size, std::align_val_t a) {
  return take_or_throw(size, std::size_t(a), CALLER);
}
EXPORT void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return take(size, 1, CALLER); }
EXPORT void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return take(size, 1, CALLER); }
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

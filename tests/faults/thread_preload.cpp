// SPDX-License-Identifier: MIT
// Preloaded before the program (LD_PRELOAD): a limit on threads, as that of a user or of a control group.
//
//   AFTERGLOW_FAULT_CALL=N    the Nth thread beside the first is one too many, at any time; 0: there is no limit
//   AFTERGLOW_FAULT_LOG=FILE  a line with the most that ran at a time, whenever there are more
#include <dlfcn.h>
#include <pthread.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <mutex>

namespace {

using Start = void* (*)(void*);
using Create = int(pthread_t*, const pthread_attr_t*, Start, void*);

struct Count {
  std::mutex mutex;
  long running = 0, most = 0;
};
/// Never freed: threads end after the last destructor, too.
Count& count() {
  static Count& count = *new Count;
  return count;
}

long number(const char* name) {
  const char* value = std::getenv(name);
  return value ? std::atol(value) : 0;
}

/// False: it is one too many.
bool enter() {
  static const long limit = number("AFTERGLOW_FAULT_CALL");
  Count& all = count();
  const std::lock_guard lock(all.mutex);
  if (limit > 0 && all.running + 1 >= limit) return false;
  if (++all.running <= all.most) return true;
  all.most = all.running;
  const char* file = std::getenv("AFTERGLOW_FAULT_LOG");
  if (std::FILE* log = file ? std::fopen(file, "a") : nullptr) {
    std::fprintf(log, "%ld\n", all.most);
    std::fclose(log);
  }
  return true;
}

void leave(void*) {
  Count& all = count();
  const std::lock_guard lock(all.mutex);
  --all.running;
}

struct Work {
  Start start;
  void* argument;
};

void* run(void* given) {
  const Work work = *static_cast<Work*>(given);
  delete static_cast<Work*>(given);
  void* result = nullptr;
  pthread_cleanup_push(leave, nullptr);
  result = work.start(work.argument);
  pthread_cleanup_pop(1);
  return result;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int pthread_create(pthread_t* thread,
                                                                     const pthread_attr_t* attributes, Start start,
                                                                     void* argument) {
  static auto* const next = reinterpret_cast<Create*>(dlsym(RTLD_NEXT, "pthread_create"));
  if (!enter()) return EAGAIN;
  auto* work = new Work{start, argument};
  const int result = next(thread, attributes, run, work);
  if (result == 0) return 0;
  leave(nullptr);
  delete work;
  return result;
}

// SPDX-License-Identifier: MIT
// A host of the library that goes on after an error, as long-running hosts do.
//
//   fault_host LOOK OUT          frames of two sizes in turn, each asked for again when it failed; their floats go to
//   OUT.
//                                Exit code 5: a frame that failed four times
//   fault_host LOOK --memory N   allocations of the library fail, one at a time, at N places of a stack's first frame
//   and
//                                N of a later one; the same frame once more must then have the pixels that it had
#include <link.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <new>
#include <string>
#include <vector>

#include <afterglow.h>

namespace {

std::uintptr_t library_begin = 0, library_end = 0;
std::atomic<bool> counting{false};
std::atomic<long> allocations{0}, failing{0};

int note_library(dl_phdr_info* info, std::size_t, void*) {
  if (std::strstr(info->dlpi_name, "libafterglow") == nullptr) return 0;
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& part = info->dlpi_phdr[i];
    if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
    library_begin = info->dlpi_addr + part.p_vaddr;
    library_end = library_begin + part.p_memsz;
  }
  return 0;
}

void* allocate(std::size_t size, const void* from) {
  const auto caller = reinterpret_cast<std::uintptr_t>(from);
  if (counting && caller >= library_begin && caller < library_end && ++allocations == failing) throw std::bad_alloc();
  void* memory = std::malloc(size != 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size, __builtin_return_address(0)); }
void* operator new[](std::size_t size) { return allocate(size, __builtin_return_address(0)); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace {

struct Shape {
  int width, height;
};
constexpr Shape kShapes[] = {{96, 54}, {640, 361}};  // the second in several bands, where pixels are staged

/// Whether it did; what went wrong goes to stderr.
bool done(afterglow_error* error) {
  if (error == nullptr) return true;
  std::fprintf(stderr, "%s\n", afterglow_error_get_text(error).data);
  afterglow_error_free(error);
  return false;
}

afterglow_stack* stack_of(afterglow_device* device, const char* look) {
  afterglow_stack_options options = afterglow_stack_options_default();
  options.preset_file = afterglow_str(look);
  options.precision = AFTERGLOW_PRECISION_FP32;
  for (int tries = 0; tries < 4; ++tries) {
    afterglow_stack* stack = nullptr;
    if (done(afterglow_stack_create(device, &options, &stack))) return stack;
  }
  std::exit(5);
}

/// Frame 1, again and again: what looks back sees none before it, or itself.
bool run(afterglow_stack* stack, Shape shape, std::vector<float>& result) {
  const std::size_t samples = static_cast<std::size_t>(shape.width) * static_cast<std::size_t>(shape.height) * 4;
  std::vector<float> pixels(samples);
  for (std::size_t i = 0; i < samples; ++i)
    pixels[i] = i % 4 == 3 ? 1.f : 0.05f + 2.f * std::fabs(std::sin(static_cast<float>(i % 7919) * 0.013f));
  result.assign(samples, -7.f);
  afterglow_frame frame = afterglow_frame_default();
  frame.number = 1;
  frame.time = 1.0 / 24;
  afterglow_run_info info = afterglow_run_info_default();
  info.frame = &frame;
  info.source = {pixels.data(), shape.width, shape.height, 4, AFTERGLOW_FLOAT, 0, 0};
  info.result = {result.data(), shape.width, shape.height, 4, AFTERGLOW_FLOAT, 0, 0};
  allocations = 0;
  counting = true;
  afterglow_error* const error = afterglow_stack_run(stack, &info);
  counting = false;
  return done(error);
}

int in_turn(afterglow_device* device, const char* look, const char* file) {
  std::FILE* const out = std::fopen(file, "wb");
  if (out == nullptr) return 4;
  afterglow_stack* const stack = stack_of(device, look);
  for (int turn = 0; turn < 6; ++turn) {
    std::vector<float> result;
    int tries = 0;
    while (!run(stack, kShapes[turn % 2], result))
      if (++tries == 4) return 5;
    std::fwrite(result.data(), sizeof(float), result.size(), out);
  }
  afterglow_stack_free(stack);
  return std::fclose(out) == 0 ? 0 : 4;
}

int without_memory(afterglow_device* device, const char* look, long most) {
  std::map<int, std::vector<float>> right;
  afterglow_stack* stack = stack_of(device, look);
  std::vector<float> result;
  for (const int shape : {0, 1})
    if (!run(stack, kShapes[shape], right[shape])) return 1;
  if (!run(stack, kShapes[0], result)) return 1;
  const long later = allocations;
  afterglow_stack_free(stack);
  stack = stack_of(device, look);
  if (!run(stack, kShapes[0], result)) return 1;
  const long first = allocations;
  int failed = 0, wrong = 0;
  const auto strike = [&](long place, int shape, const char* where) {
    failing = place;
    if (!run(stack, kShapes[shape], result)) ++failed;
    failing = 0;
    if (run(stack, kShapes[shape], result) && result == right[shape]) return;
    std::printf("wrong behind allocation %ld of %s\n", place, where);
    ++wrong;
  };
  for (long i = 1; i <= most; ++i) strike(1 + i * (later - 1) / most, static_cast<int>(i % 2), "a later frame");
  for (long i = 1; i <= most; ++i) {
    afterglow_stack_free(stack);
    stack = stack_of(device, look);
    strike(1 + i * (first - 1) / most, 0, "the first frame");
  }
  afterglow_stack_free(stack);
  std::printf("%ld and %ld allocations, %d frames failed, %d wrong\n", first, later, failed, wrong);
  return wrong == 0 && failed > 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  dl_iterate_phdr(note_library, nullptr);
  const afterglow_device_options options = afterglow_device_options_default();
  afterglow_device* device = nullptr;
  for (int tries = 0; device == nullptr; ++tries)
    if (!done(afterglow_device_open(&options, &device)) && tries == 3) return 5;
  const bool memory = argc > 3 && std::strcmp(argv[2], "--memory") == 0;
  const int code = memory ? without_memory(device, argv[1], std::atol(argv[3])) : in_turn(device, argv[1], argv[2]);
  afterglow_device_free(device);
  return code;
}

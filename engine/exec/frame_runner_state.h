// SPDX-License-Identifier: MIT
// What a FrameRunner is made of. A frame is begun (frame_begin.cpp), run and waited for (frame_execute.cpp), and read
// back (frame_runner.cpp).
#pragma once

#include <array>
#include <cstdint>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/stopwatch.h"
#include "exec/frame_images.h"
#include "exec/frame_runner.h"
#include "exec/kernel_timer.h"
#include "exec/submit.h"

namespace afterglow {

struct FrameRunner::State {
  State(Device& device_in, const FrameImages::Options& options, int place_in)
      : device(device_in), place(place_in), images(device_in, options), timer(device_in) {}

  Device& device;
  int place;
  FrameImages images;
  bool flags = false;         ///< the last run's result tells of what is not finite
  std::optional<Rect> shown;  ///< the part of the result that the last run made; none: the result is the source
  KernelTimer timer;
  /// What the command buffer holds and what it needs to be so again.
  struct Recorded {
    std::uint64_t program = 0;
    std::vector<bool> run;
    FrameImages::Handles images;
    std::vector<VkImageLayout> layouts;  ///< of the inputs, before and after
    int bindings = 0;
    friend bool operator==(const Recorded&, const Recorded&) = default;
  };
  static constexpr int kOneOff = 2;                       ///< buffer of the Submitter for what is submitted once
  std::array<std::optional<Recorded>, kOneOff> recorded;  ///< by Program::recording
  /// What a program is bound to: the images, and its own count then.
  struct Bound {
    std::uint64_t program = 0;
    FrameImages::Handles images;
    int bindings = 0;
    friend bool operator==(const Bound&, const Bound&) = default;
  };
  std::optional<Bound> bound;
  /// A frame that began.
  struct Begun {
    Program* ran = nullptr;  ///< null: the result is the source
    HostImage source;
    FrameTimes times;
    Plan plan{};                                   ///< of `ran`, for messages
    Program* running = nullptr;                    ///< what was submitted
    std::uint64_t runaways = 0;                    ///< of it, when the frame began
    std::optional<Clock::time_point> submitted{};  ///< none: its kernels have been waited for
    std::optional<Error> failed{};                 ///< as was found then
  };
  std::optional<Begun> begun;
  Program* warming_up = nullptr;  ///< whose pixels `warm_up` submitted, which have not been waited for
  Submitter submitter;            // it waits before the images go
  /// A frame that began, whose pixels are being converted by another thread. It touches nothing but the images.
  struct Packing {
    Program* program = nullptr;
    std::map<std::string, HostImage> host;
    Choose choose;
    std::future<Result<double>> uploaded{};  ///< how long it took; ends before the rest goes

    Packing(Program* program_in, const std::map<std::string, HostImage>& host_in, const Choose& choose_in)
        : program(program_in), host(host_in), choose(choose_in) {}
  };
  std::optional<Packing> packing;  // last: its thread uses the others

  Result<void> submit(const std::function<void(VkCommandBuffer)>& record, int which);
  Result<void> leave_readable();
  Result<void> begin(Program& program, const std::map<std::string, HostImage>& host, KernelTiming timing,
                     const Choose& choose);
  Result<void> begin_packing(Program& program, const std::map<std::string, HostImage>& host, const Choose& choose);
  void launch_packed();
  Result<void> begin_download();
  Result<void> prepare(Program& program, const std::map<std::string, HostImage>& host);
  Result<double> upload(const Program& program, const std::map<std::string, HostImage>& host, bool look);
  Result<void> launch(Program& program, KernelTiming timing, const Choose& choose);
  Result<void> given_up(Result<void> failed);
  void forget_result();
  Result<std::uint64_t> read_back(Rect part, HostResult& out, bool look_for_flags);
  Result<void> execute(Program& program, const std::vector<bool>& run, KernelTiming timing);
  Result<void> time_separately(Program& program, const std::vector<bool>& run);
  Result<void> wait();
  Result<FrameTimes> end();
};

}  // namespace afterglow

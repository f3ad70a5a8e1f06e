// SPDX-License-Identifier: MIT
// The one way to run a stack: frames go in, one after the other, and come out in the same order. Where pixels take the
// way over staging buffers, several are in flight: another thread packs one while the one before it runs and the one
// before that is read back.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exec/frame.h"
#include "exec/program_cache.h"

namespace afterglow {

struct RendererOptions {
  std::uint64_t max_memory = 6ull << 30;  ///< bytes of device memory for the images of one frame
  /// On devices whose memory is the CPU's, pixels are written into and read from the images themselves, and one frame
  /// is in flight; false takes the way over staging buffers that every GPU can go.
  bool direct = true;
  /// In flight at most, over staging buffers that hold whole pictures (each frame has its own source, result and
  /// buffers). 1: one at a time, over buffers of a few rows.
  int frames = 1;
};

/// A frame to run.
struct RenderRequest {
  ProgramCache* programs = nullptr;  ///< null: nothing runs, the result is the source
  ShaderLibrary* shaders = nullptr;
  FrameWork work{};
  /// "source" and the auxiliary images that the graph asks for. Their pixels must stay until `launch`, the source's
  /// until `collect`.
  std::map<std::string, HostImage> inputs{};
  KernelTiming timing = KernelTiming::none;  ///< others than none: no other frame is in flight meanwhile
};

/// What became of a frame.
struct FrameReport {
  FrameTimes times;
  std::vector<Skipped> skipped;      ///< effects that its content made idle, and kernels that were done before
  std::vector<std::string> kernels;  ///< of the program that ran, fused passes as "a+b"
  ProgramMemory memory;              ///< of the whole program, whatever was idle
  std::uint64_t program = 0;         ///< id of the program that ran; 0: nothing ran, the result is the source
};

/// Not thread-safe. The caches that it is given must outlive the frames that use them.
class Renderer {
 public:
  /// Errors: device.
  static Result<std::unique_ptr<Renderer>> create(Device& device, const RendererOptions& options);
  /// Waits for what is in flight.
  ~Renderer();

  int frames() const;     ///< that may be in flight
  int in_flight() const;  ///< submitted and not collected

  /// On devices that compile late, begins to warm up what `programs` has prepared (FrameRunner::warm_up), as frames
  /// usually need it, and does not wait. The program; null when there is nothing to run, or the device compiles early.
  /// No frame may be in flight. Errors: those of `submit`.
  Result<Program*> warm_up(ProgramCache& programs, ShaderLibrary& shaders);

  /// Makes the frame's program the present one of its cache, packs, uploads and submits. Needs `in_flight` below
  /// `frames`. Where several may be in flight the frame is submitted by what is called next, and what fails then is
  /// told by `collect`. Errors: script, other (an input is missing or of another size), io (over `max_memory`), device.
  Result<void> submit(RenderRequest request);
  /// Submits the oldest frame, if it is still being packed, and those before it: from then on its inputs may change,
  /// but for the pixels of a source that may be its result. What fails is told by `collect`.
  void launch();
  /// Waits for the oldest frame and reads its result back. Errors: device, other (nothing is in flight).
  Result<FrameReport> collect(HostResult& out);
  /// Both, for one frame alone.
  Result<FrameReport> render(RenderRequest request, HostResult& out);
  /// Until no frame that is in flight touches its program any more: before programs are prepared otherwise. Results can
  /// be collected still; what became of a frame is told then. Errors: device (of a warm-up).
  Result<void> wait();

  /// Runs a frame and leaves its result on the device: see `images` and `read_result`. Whoever reads the images of the
  /// frame before must be done with them: a submission that does has to be waited for. Errors: those of `submit`.
  Result<FrameReport> show(RenderRequest request);
  /// What the last `show` left on the device. Null images before the first.
  DeviceImages images() const;
  /// The result of the last `show`, or that part of it: the rest of `out` is undefined. Errors: other (nothing was
  /// run), device.
  Result<void> read_result(HostResult& out, const std::optional<Rect>& part = {});
  /// How long kernel `kernel` of the program that `show` ran last takes, by itself: it is run once more, which changes
  /// no pixel. None when another program ran last, or nothing did. Needs a program that keeps its images. Errors:
  /// device.
  Result<std::optional<double>> time_kernel(Program& program, std::size_t kernel);

  /// Runs a program that no cache keeps, made by ProgramCache::by_passes, in the frame that its histories began.
  Result<FrameTimes> run(Program& program, const std::map<std::string, HostImage>& inputs, HostResult& out);
  /// Pixels of an image between kernels as the last `run` left them. Errors: other (they are not kept).
  Result<HostResult> read_image(Program& program, ImageId image);

  struct Counters {
    int images = 0, buffers = 0, recordings = 0;
  };
  Counters counters() const;  ///< objects made and commands recorded so far; steady frames leave them alone

 private:
  struct State;
  explicit Renderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow

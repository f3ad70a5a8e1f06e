// SPDX-License-Identifier: MIT
// Moves pictures between host and device around a program: upload, submit, read back.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "exec/frame.h"

namespace afterglow {

/// Which program runs a frame, asked once its inputs have been packed: from then on the program is touched. It must
/// take the same inputs; null: nothing has to run, the result is the source. `content`: of the source
/// (graph/condition.h), when it was asked for.
struct ChooseProgram {
  std::function<Result<Program*>(const SourceContent& content)> program{};
  bool look = false;  ///< find out what is in the source
};

/// Images, staging memory, command buffer and fence for one frame at a time; reused while sizes stay the same. What a
/// Renderer has several of. Not thread-safe.
class FrameRunner {
 public:
  struct Options {
    std::uint64_t max_memory = 6ull << 30;
    /// On devices whose memory is the CPU's, pixels are written into and read from the images themselves; false takes
    /// the way over staging buffers that every GPU can go.
    bool direct = true;
    /// Staging buffers hold whole pictures, so that nothing waits for the device between `begin` and `finish`.
    bool whole_staging = false;
    int place = 0;  ///< its own among those that take turns with a program (Program::bind)
  };
  /// Errors: device.
  static Result<std::unique_ptr<FrameRunner>> create(Device& device, const Options& options);
  static Result<std::unique_ptr<FrameRunner>> create(Device& device, std::uint64_t max_memory, bool direct = true) {
    return create(device, Options{.max_memory = max_memory, .direct = direct});
  }
  ~FrameRunner();
  using Choose = ChooseProgram;

  /// Uploads "source" and the auxiliary images that the graph asks for, runs, reads the result back into `out` (RGBA
  /// float; resized by it). What is known to be the same as before is not done again: uploads of the same content, and
  /// kernels for which nothing has changed (Program::kernels_to_run). Of a program with a region, the region alone is
  /// written. Errors: other (an input is missing or of another size), io (over `max_memory`), device.
  Result<FrameTimes> run(Program& program, const std::map<std::string, HostImage>& inputs, HostResult& out,
                         KernelTiming timing, const Choose& choose = Choose{});
  /// The first half of `run`: packs, uploads and submits. With `timing` it waits for the device, else it does not. With
  /// whole staging buffers another thread packs, and the rest is left for `launch`, `wait` or `finish`. What `inputs`
  /// point at must stay until `finish`. Errors: those of `run`; then there is nothing to finish.
  Result<void> begin(Program& program, const std::map<std::string, HostImage>& inputs, KernelTiming timing,
                     const Choose& choose);
  /// Submits the frame that began, once its pixels are packed; nothing where that has been done. What fails is told by
  /// `finish`. The program must still be the one that frames run.
  void launch();
  /// Begins to draw a pixel with each kernel of a program that frames will run: drivers of CPU devices compile a kernel
  /// when something is first drawn with it (exec/cpu/warm_up.h), and need not do so in the first frame, which waits for
  /// this. Makes the images of such frames. No frame may be in flight. `backwards`: see Program::record_a_pixel_each.
  /// Errors: io (over `max_memory`), device.
  Result<void> warm_up(Program& program, bool backwards = false);
  /// Until the kernels of the frame that began have run: then its program may be used for another. What became of that
  /// frame is told by `finish`. Errors: device (of a warm-up).
  Result<void> wait();
  /// The second half. Errors: device.
  Result<FrameTimes> finish(HostResult& out);
  /// What the result image holds is not what its program made last: another runner's has been made since.
  void forget_result();
  /// Like `run`, but the result stays on the device: see `images` and `read_result`. `program` null: nothing has to
  /// run, the source alone is brought to the device. Whoever reads the images of the frame before must be done with it:
  /// a submission that does has to be waited for.
  Result<FrameTimes> run_on_device(Program* program, const std::map<std::string, HostImage>& inputs,
                                   KernelTiming timing, const Choose& choose = Choose{});
  /// How long kernel `kernel` of the program that ran last takes, by itself: it is run once more, which changes no
  /// pixel. None when another program ran last, or nothing did. Needs a program created with `keep_images`. Whoever
  /// reads `images` must be done with them. Errors: device.
  Result<std::optional<double>> time_kernel(Program& program, std::size_t kernel);
  /// What the last run left on the device. Null images before the first.
  DeviceImages images() const;
  /// The result of the last run, or that part of it: the rest of `out` is undefined. When nothing had to run it is the
  /// source, which is not read back. Errors: other (nothing was run), device.
  Result<void> read_result(HostResult& out, const std::optional<Rect>& part = {});
  /// Pixels of a transient image as the last run left them. Needs a program created with `reference`. Errors: other.
  Result<HostResult> read_image(Program& program, ImageId image);

  struct Counters {
    int images = 0, buffers = 0, recordings = 0;
  };
  Counters counters() const;  ///< objects made and commands recorded so far; steady frames leave them alone

 private:
  struct State;
  explicit FrameRunner(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow

// Moves pictures between host and device around a program: upload, submit, read back.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/hash.h"
#include "exec/program.h"
#include "graph/condition.h"

namespace afterglow {

struct KernelTime {
  std::string name;
  double milliseconds = 0;
};
struct FrameTimes {
  double upload = 0, execute = 0, readback = 0;  ///< milliseconds, wall clock
  std::vector<KernelTime> kernels;               ///< empty unless asked for and known
  int kernels_run = 0, kernels_kept = 0;         ///< kept: what they made in an earlier run is still right
  bool separate_submissions = false;             ///< kernels were timed one submission each; not part of `execute`
};
enum class KernelTiming { none, timestamps, submissions };

/// One input of a frame in host memory: interleaved floats.
struct HostImage {
  const float* pixels = nullptr;
  Size size;
  int channels = 4;
  std::optional<Hash> content{};  ///< of the pixels, when known: an image of the same content is not uploaded again
};

struct HostResult {
  /// RGBA. It may be the very memory of the input "source": it is written after all inputs have been read. A vector
  /// that is large enough already is not allocated again.
  std::vector<float> pixels;
  std::vector<std::uint8_t> codes;  ///< instead of `pixels`, of a program with ProgramOptions::codes: RGBA
  std::uint64_t clamped = 0;        ///< half storage: source or result samples held at ±65504
  /// Of a program with ProgramOptions::flag_non_finite: some alpha is 0. Such a program's `pixels` have no other alpha.
  bool flagged = false;
  bool keep_alpha = false;  ///< write R, G and B alone where `pixels` has the size of the result already
};

/// An image of a FrameRunner between frames. It may be sampled in fragment shaders of later submissions to the device's
/// queue without a barrier, in this layout, and must be left in it.
struct DeviceImage {
  ImageBinding binding;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};
struct DeviceImages {
  DeviceImage source, result;
  bool ran = false;  ///< false: nothing had to run, the result *is* the source
};

/// Images, staging memory, command buffer and fence for one frame at a time; reused while sizes stay the same. Not
/// thread-safe.
class FrameRunner {
 public:
  /// `direct`: on devices whose memory is the CPU's, pixels are written into and read from the images themselves; false
  /// takes the way over staging buffers that every GPU can go. Errors: device.
  static Result<std::unique_ptr<FrameRunner>> create(Device& device, std::uint64_t max_memory, bool direct = true);
  ~FrameRunner();
  /// Which program runs a frame, asked once its source has been packed. It must take the same inputs; null: nothing has
  /// to run, the result is the source.
  using Choose = std::function<Result<Program*>(const SourceContent& content)>;

  /// Uploads "source" and the auxiliary images that the graph asks for, runs, reads the result back into `out` (RGBA
  /// float; resized by it). What is known to be the same as before is not done again: uploads of the same content, and
  /// kernels for which nothing has changed (Program::kernels_to_run). Of a program with a region, the region alone is
  /// written. Errors: other (an input is missing or of another size), io (over `max_memory`), device.
  Result<FrameTimes> run(Program& program, const std::map<std::string, HostImage>& inputs, HostResult& out,
                         KernelTiming timing, const Choose& choose = {});
  /// Like `run`, but the result stays on the device: see `images` and `read_result`. `program` null: nothing has to
  /// run, the source alone is brought to the device. Whoever reads the images of the frame before must be done with it:
  /// a submission that does has to be waited for.
  Result<FrameTimes> run_on_device(Program* program, const std::map<std::string, HostImage>& inputs,
                                   KernelTiming timing, const Choose& choose = {});
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

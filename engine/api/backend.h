// SPDX-License-Identifier: MIT
// What the C interface needs of the engine, and nothing else. The files named backend… are the only ones of this room
// that know how the engine runs a stack.
#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "exec/renderer.h"
#include "gpu/device.h"
#include "script/build.h"
#include "session/stack.h"

namespace afterglow::api {

/// A device and what its stacks share. Stacks may use it on several threads.
struct SharedDevice {
  Diagnostics diagnostics;
  std::unique_ptr<Device> device;
  std::shared_ptr<SharedKernels> shared;

  explicit SharedDevice(Diagnostics::Sink sink) : diagnostics(std::move(sink)) {}
  /// Caches below `cache_folder`; empty: none on disk. Errors: device.
  Result<void> open(const DeviceOptions& options, const std::filesystem::path& cache_folder);
  Result<void> adopt(const AdoptedDevice& adopted, const std::filesystem::path& cache_folder);

  /// After fork() neither the driver's threads nor ours are there: whoever waits for them waits for ever.
  bool is_of_this_process() const { return process_ == getpid(); }
  /// Errors (device): it is of another process.
  Result<void> check_process() const;

 private:
  const pid_t process_ = getpid();
  void share(const std::filesystem::path& cache_folder);
};

struct BackendOptions {
  std::filesystem::path preset;
  StackOptions stack;
  bool commands = false;  ///< recorded into the caller's command buffers
  bool follow = false, time_kernels = false;
  Diagnostics::Sink message;
  std::function<void()> wake;
};

/// What a host says about a preset; later values win.
struct Given {
  std::vector<Override> overrides;
  std::vector<ArgumentValue> arguments;
};

/// What a frame is made for.
struct Shape {
  BuildContext context;
  std::optional<DisplayEncoding> encoding;
  std::optional<Rect> region;
};

/// Where a stack comes from: loaded once, or following its files. One thread at a time.
class Source {
 public:
  virtual ~Source() = default;
  virtual Stack& stack() = 0;  ///< the last good one
  /// All of them; those that do not fit are left out with a warning, unless they must. When there is an error the ones
  /// before stay.
  virtual Result<void> set(const Given& given, MustFit must_fit) = 0;
  virtual Result<bool> update() = 0;
  virtual Result<void> reload(const std::optional<std::string>& text) = 0;
  /// What the preset says about the frame; edits that have to be waited for are taken first.
  virtual Result<std::shared_ptr<const Build>> evaluate(const Shape& shape) = 0;
};
Result<std::unique_ptr<Source>> load_source(SharedDevice& device, const BackendOptions& options,
                                            Diagnostics& diagnostics);
Result<std::unique_ptr<Source>> follow_source(SharedDevice& device, const BackendOptions& options,
                                              Diagnostics& diagnostics);

/// What `Backend::report` tells.
struct BackendReport {
  std::string preset, device, choice, choice_from;
  double max_error = 0;
  std::vector<std::string> kernels;
  std::vector<Skipped> skipped;
  ProgramMemory memory;
  std::uint64_t clamped = 0;
  double script = 0, compile = 0;  ///< milliseconds so far
  FrameTimes times;                ///< of the last frame
};

/// A stack of the interface. One thread at a time.
class Backend {
 public:
  static Result<std::unique_ptr<Backend>> open(std::shared_ptr<SharedDevice> device, const BackendOptions& options);
  ~Backend();

  const BackendOptions& options() const { return options_; }
  const SharedDevice& device() const { return *device_; }
  Diagnostics& diagnostics() { return diagnostics_; }
  Preset& preset() const { return source_->stack().preset(); }
  /// As they are in the frame that was prepared last, or would be by now; before there is one, for no frame in
  /// particular.
  const std::vector<StackEntry>& entries() { return seen() ? *seen()->entries : preset().entries(); }
  const Explanation& explanation() { return seen() ? *seen()->explanation : preset().explanation(); }
  /// Of the same frame: how many earlier frames it needs. 0 before there is one.
  int pre_roll() const;

  /// Further overrides; those of the same names go. Errors: usage, script: then the ones before stay.
  Result<void> set(const std::vector<Override>& several);
  Result<void> unset(const std::optional<std::string>& name);  ///< none: all
  /// No value: its default.
  Result<void> set_argument(const std::string& name, const std::optional<std::string>& value);
  Result<bool> update();
  Result<void> reload(const std::optional<std::string>& text);

  Result<void> prepare(const Shape& shape);
  bool prepared() const { return prepared_; }
  bool runs() const { return source_->stack().runs(); }
  void reset_histories() { source_->stack().reset_histories(); }

  /// `inputs` and `result` with `read_row` and `write_row`.
  Result<void> run(const Shape& shape, const std::map<std::string, HostImage>& inputs, HostResult& result);

  VkFormat result_format() const { return source_->stack().result_format(); }
  Result<void> bind(const std::map<std::string, ImageBinding>& inputs, const ImageBinding& result);
  Result<void> record(VkCommandBuffer commands);

  BackendReport report() const;

 private:
  Backend(std::shared_ptr<SharedDevice> device, const BackendOptions& options);
  Result<void> set_all(Given all, MustFit must_fit);
  class Forgetting;
  const Build* seen();
  void forget_what_went(const Stack* before);
  Result<std::shared_ptr<const Build>> evaluate(const Shape& shape);
  Result<void> prepare_frame(const Shape& shape);
  Result<void> run_frame(const Shape& shape, const std::map<std::string, HostImage>& inputs, HostResult& result);
  std::shared_ptr<SharedDevice> device_;  // last to go
  BackendOptions options_;
  Diagnostics diagnostics_;
  Given given_;
  std::unique_ptr<Source> source_;
  std::unique_ptr<Renderer> renderer_;  // first to go: it waits for what is in flight
  bool prepared_ = false;
  // Of the last frame.
  std::optional<Shape> shape_;
  std::shared_ptr<const Build> build_;
  std::optional<std::shared_ptr<const Build>> seen_;  ///< by what was set since; null: it cannot be made
  std::vector<Skipped> skipped_;
  FrameReport last_;
  std::uint64_t clamped_ = 0;
};

}  // namespace afterglow::api

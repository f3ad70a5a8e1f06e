// SPDX-License-Identifier: MIT
// A preset made runnable on a device, without moving any pixels: what an engine records into its own command buffer,
// and what Session drives for whole pictures.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/result.h"
#include "exec/renderer.h"
#include "gpu/device.h"
#include "script/build.h"
#include "session/display_encoding.h"

namespace afterglow {

enum class Precision { automatic, fp32, fp16 };

struct StackOptions {
  PresetOptions preset;
  Precision precision = Precision::automatic;
  std::optional<double> max_error;  ///< E of math.md §13; default: the preset's, else 2e-3
  bool reference = false;           ///< every pass on its own in fp32 with computed weights: the slow truth
  bool skip_idle = true;  ///< run frames without the effects that their content makes idle (never with `reference`)
  bool flag_non_finite = false;  ///< the result's alpha tells of colours that were not finite: see ProgramOptions
  bool keep_images = false;      ///< images between passes stay, so that after an edit only what it changes runs again
  /// Programs of other structures that stay besides the present one, for presets whose structure moves with the frame
  /// and for sizes in turn; with their images and the present one's, within a quarter of `max_memory`.
  int spare_programs = 2;
  std::uint64_t max_memory = 6ull << 30;  ///< bytes of device memory for images
  std::filesystem::path cache_folder;     ///< for shaders and pipelines; empty: no disk caches
  /// At most so many rows an invocation, whatever calibration says. Fewer make large frames slower and shaders faster
  /// to compile; the pixels are the same.
  int most_rows = kMaxRows;
  bool copy_result = false;               ///< the last effect's image is an image between passes like any other
  std::optional<ExecutionConfig> choice;  ///< execute so, whatever calibration and precision say
  std::filesystem::path calibration;      ///< a table of `afterglow calibrate`; empty: the shipped one
  /// Null: the stack's own. Its cache folder counts, and whoever made it calls Device::use_pipeline_cache.
  std::shared_ptr<SharedKernels> shared;
};

/// How a stack is executed, and why so.
struct StackChoice {
  ExecutionConfig execution;
  std::string from;  ///< "calibration/devices.json, any gpu", "given", "--reference"
  double max_error = 2e-3;
};

/// A frame to run.
struct FrameRequest {
  std::shared_ptr<const Build> build;         ///< evaluated for it
  std::optional<DisplayEncoding> encoding{};  ///< the result is 8-bit codes (not with StackOptions::reference)
  std::optional<Rect> region{};               ///< only this part, in pixels of the picture and within it
  double step = 1;                            ///< frames since the one before it, see BuildContext
  bool restart = false;                       ///< no frame is before it
};
/// With the place in time that the context of the build says.
inline FrameRequest request_for(std::shared_ptr<const Build> build, const std::optional<DisplayEncoding>& encoding = {},
                                const std::optional<Rect>& region = {}) {
  const double step = build->context.step;
  const bool restart = build->context.restart;
  return {std::move(build), encoding, region, step, restart};
}

/// Bound to one device, which must outlive it. Not thread-safe.
class Stack {
 public:
  /// Runs the preset's script; touches no device. Errors: script, usage (override), io (calibration).
  static Result<std::unique_ptr<Stack>> load(const std::filesystem::path& preset, const StackOptions& options,
                                             Diagnostics& diagnostics);
  ~Stack();

  Preset& preset();
  /// The image that takes the result's place from the next `work` or `prepare` on: "" for the result itself, "source",
  /// or the name of an image that a pass makes ("glow.down[2]"). While the graph has none of that name, the result
  /// stays and `shows` is false.
  void show(const std::string& image);
  bool shows() const;  ///< the image that was asked for last, in the last graph
  /// Names that `show` knew in the last graph: "source", then those that passes make, in their order.
  const std::vector<std::string>& images() const;

  /// What the preset says about a frame: its scripts run once for it, here and nowhere else. Needs no device.
  Result<std::shared_ptr<const Build>> evaluate(const BuildContext& context);
  /// What runs of it, up to the image that is shown. Needs no device. Errors: script.
  Result<FrameWork> work(const FrameRequest& frame);
  /// The same for a Renderer, which still wants the pictures. `build` is this frame's from here on.
  Result<RenderRequest> request(FrameRequest frame);
  /// Bytes of device memory that the stack's images take for such a picture, with the source and the result. Needs no
  /// device.
  std::uint64_t memory_needed(const Build& build) const;

  /// Looks up how to execute on a device. Call before `prepare`. `own_images`: source and result will be a
  /// Renderer's, made as the programs like them best.
  void use(Device& device, bool own_images = false);
  /// With the storage of the last `work`: half floats are for frames whose effects promise their error alone.
  const StackChoice& choice() const;
  /// What was made on the device; null before `use`.
  ProgramCache* programs();
  ShaderLibrary& shaders();

  /// Makes shaders, pipelines and memory for the frame, or only rewrites parameters where they are there. Must not be
  /// called while a submission that uses this stack is in flight. Errors: script, device, io (memory limit).
  Result<void> prepare(FrameRequest frame);
  /// Evaluates and prepares.
  Result<void> prepare(const BuildContext& context, const std::optional<DisplayEncoding>& encoding = {},
                       const std::optional<Rect>& region = {});
  /// Of the last `prepare` or `request`; null before it.
  const std::shared_ptr<const Build>& build() const;
  /// False when no effect has anything to do: the result *is* the source, and `record` records nothing. A display
  /// encoding is something to do, unless a Renderer runs the stack (`use` with `own_images`).
  bool runs() const;
  /// The program of the last `prepare`; null before it, and when nothing runs.
  Program* program() const;
  /// Effects, passes and pixels that no frame like the last one that was prepared runs, with reasons.
  std::vector<Skipped> skipped() const;

  /// Takes the place of `before`, a stack of the same device and SharedKernels: its frames go on from those. With
  /// `programs` what that has made is taken over too, if the device executes both alike. `before` must not be used any
  /// more; no submission of either may be in flight.
  void take_over(Stack& before, bool programs);
  /// What earlier frames handed on is forgotten: the next `prepare` begins anew, as BuildContext::restart does.
  void reset_histories();

  /// The file of a shader that a graph names; empty for unknown ones.
  std::filesystem::path shader_file(const std::string& shader) const;
  /// Format that the result image must have: VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT, or with a
  /// display encoding VK_FORMAT_R8G8B8A8_UNORM.
  VkFormat result_format() const;

  /// See Program::bind and Program::record for layouts and barriers. Where effects have histories, the frame that is
  /// recorded is the one that `prepare` was given last (BuildContext::frame, step, restart): count frames, and submit
  /// in the order of recording. Preparing a number once more makes that frame once more, from the same frame before it.
  Result<void> bind(const std::map<std::string, ImageBinding>& inputs, const ImageBinding& result);
  void record(VkCommandBuffer commands);

  double script_milliseconds() const;   ///< loading and evaluating so far
  double compile_milliseconds() const;  ///< shaders and pipelines so far

 private:
  struct State;
  explicit Stack(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow

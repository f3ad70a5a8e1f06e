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
#include "exec/choice.h"
#include "exec/program.h"
#include "gpu/device.h"
#include "script/preset.h"

namespace afterglow {

enum class Precision { automatic, fp32, fp16 };

struct StackOptions {
  PresetOptions preset;
  Precision precision = Precision::automatic;
  std::optional<double> max_error;        ///< E of math.md §13; default: the preset's, else 2e-3
  bool reference = false;                 ///< every pass on its own in fp32 with computed weights: the slow truth
  std::uint64_t max_memory = 6ull << 30;  ///< bytes of device memory for images
  std::filesystem::path cache_folder;     ///< for shaders and pipelines; empty: no disk caches
  std::optional<Choice> choice;           ///< execute so, whatever calibration and precision say
  std::filesystem::path calibration;      ///< a table of `afterglow calibrate`; empty: the shipped one
};

/// 8-bit display codes as the last kernel's work: sRGB-encoded, as a display file holds them.
struct DisplayEncoding {
  bool straight_alpha = false;  ///< colours are divided by the source's alpha, which becomes the codes' alpha
  bool dither = false;          ///< ±½ step of ordered noise
  friend bool operator==(const DisplayEncoding&, const DisplayEncoding&) = default;
};

/// How a stack is executed, and why so.
struct StackChoice {
  Choice execution;
  std::string from;  ///< "calibration/devices.json, any gpu", "given", "--reference"
  double max_error = 2e-3;
};

/// Bound to one device, which must outlive it. Not thread-safe.
class Stack {
 public:
  /// Runs the preset's script; touches no device. Errors: script, usage (override), io (calibration).
  static Result<std::unique_ptr<Stack>> load(const std::filesystem::path& preset, const StackOptions& options,
                                             Diagnostics& diagnostics);
  ~Stack();

  Preset& preset();
  /// What runs for a picture of this size: passes, and what was skipped and why. Needs no device.
  Result<Graph> graph(const BuildContext& context);
  /// Bytes of device memory that the stack's images take for such a picture, with the source and the result. Needs no
  /// device.
  Result<std::uint64_t> memory_needed(const BuildContext& context);

  /// Looks up how to execute on a device. Call before `prepare`. `own_images`: source and result will be a
  /// FrameRunner's, made as the program likes them best (ProgramOptions::source_is_storage, result_by_rows).
  void use(Device& device, bool own_images = false);
  const StackChoice& choice() const;

  /// Makes shaders, pipelines and memory for pictures of this size, or only rewrites parameters when the structure is
  /// as before. Must not be called while a submission that uses this stack is in flight. Errors: script, device, io
  /// (memory limit).
  /// With `encoding` (not with StackOptions::reference) the result is RGBA8.
  Result<void> prepare(const BuildContext& context, const std::optional<DisplayEncoding>& encoding = {});
  /// False when no effect has anything to do: the result *is* the source, and `record` records nothing.
  bool runs() const;
  /// The program of the last `prepare`; null before it, and when nothing runs.
  Program* program();
  /// The graph of the last `prepare`.
  const Graph& prepared_graph() const;

  /// Format that the result image must have: VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT, or with a
  /// display encoding VK_FORMAT_R8G8B8A8_UNORM.
  VkFormat result_format() const;
  /// See Program::bind and Program::record for layouts and barriers.
  Result<void> bind(const std::map<std::string, ImageBinding>& inputs, const ImageBinding& result);
  void record(VkCommandBuffer commands) const;

  double script_milliseconds() const;   ///< loading and building so far
  double compile_milliseconds() const;  ///< shaders and pipelines so far

 private:
  struct State;
  explicit Stack(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow

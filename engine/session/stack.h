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
#include "exec/idle_programs.h"
#include "exec/image_pool.h"
#include "exec/pipeline_pool.h"
#include "exec/program.h"
#include "exec/warm_up.h"
#include "gpu/device.h"
#include "script/preset.h"
#include "session/display_encoding.h"
#include "shader/kernel.h"

namespace afterglow {

enum class Precision { automatic, fp32, fp16 };

/// What stacks of one device may share: kernels and pipelines that one has made, the others need not make again.
struct StackShared {
  explicit StackShared(std::filesystem::path cache_folder) : compiler(std::move(cache_folder)) {}
  KernelCompiler compiler;
  PipelinePool pipelines;
  ImagePool images;  ///< of those that keep them: they must be run on one thread
};

struct StackOptions {
  PresetOptions preset;
  Precision precision = Precision::automatic;
  std::optional<double> max_error;  ///< E of math.md §13; default: the preset's, else 2e-3
  bool reference = false;           ///< every pass on its own in fp32 with computed weights: the slow truth
  bool skip_idle = true;  ///< run frames without the effects that their content makes idle (never with `reference`)
  bool flag_non_finite = false;  ///< the result's alpha tells of colours that were not finite: see ProgramOptions
  bool keep_images = false;      ///< images between passes stay, so that after an edit only what it changes runs again
  /// Programs of other structures that stay besides the present one, for presets whose structure moves with the frame;
  /// with their images, within `max_memory` altogether.
  int spare_programs = 0;
  std::uint64_t max_memory = 6ull << 30;  ///< bytes of device memory for images
  std::filesystem::path cache_folder;     ///< for shaders and pipelines; empty: no disk caches
  /// At most so many rows an invocation, whatever calibration says. Fewer make large frames slower and shaders faster
  /// to compile; the pixels are the same.
  int most_rows = kMaxRows;
  std::optional<Choice> choice;       ///< execute so, whatever calibration and precision say
  std::filesystem::path calibration;  ///< a table of `afterglow calibrate`; empty: the shipped one
  /// Null: the stack's own. Its cache folder counts, and whoever made it calls Device::use_pipeline_cache.
  std::shared_ptr<StackShared> shared;
};

/// How a stack is executed, and why so.
struct StackChoice {
  Choice execution;
  std::string from;  ///< "calibration/devices.json, any gpu", "given", "--reference"
  double max_error = 2e-3;
};

/// What the programs of a stack are made for.
struct StackWork {
  Graph graph;
  Hash texts;  ///< of the shaders
  StackChoice choice;
};
/// Would programs that are made for one do for the other, with other values: the same passes, texts of shaders, images
/// and way of execution?
bool same_work(const StackWork& a, const StackWork& b);

/// Bound to one device, which must outlive it. Not thread-safe.
class Stack {
 public:
  /// Runs the preset's script; touches no device. Errors: script, usage (override), io (calibration).
  static Result<std::unique_ptr<Stack>> load(const std::filesystem::path& preset, const StackOptions& options,
                                             Diagnostics& diagnostics);
  ~Stack();

  Preset& preset();
  /// The image that takes the result's place from the next `graph` or `prepare` on: "" for the result itself, "source",
  /// or the name of an image that a pass makes ("glow.down[2]"). While the graph has none of that name, the result
  /// stays and `shows` is false.
  void show(const std::string& image);
  bool shows() const;  ///< the image that was asked for last, in the last graph
  /// Names that `show` knew in the last graph: "source", then those that passes make, in their order.
  const std::vector<std::string>& images() const;

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
  /// With `encoding` (not with StackOptions::reference) the result is RGBA8. With `region`, in pixels of the picture
  /// and within it, only that part of the result is made.
  Result<void> prepare(const BuildContext& context, const std::optional<DisplayEncoding>& encoding = {},
                       const std::optional<Rect>& region = {});
  /// As `prepare`, where programs are there that will do: those of the last structure or spare ones. False when
  /// shaders, pipelines or memory would have to be made: then nothing is changed.
  Result<bool> prepare_if_made(const BuildContext& context);
  /// The first half of `prepare`: builds the graph and makes nothing yet. Touches no device.
  Result<StackWork> build(const BuildContext& context, const std::optional<DisplayEncoding>& encoding = {});
  /// The second half: makes what the last `build` has found.
  Result<void> prepare_built(const std::optional<DisplayEncoding>& encoding = {});
  /// Takes over the scripts of a stack that was loaded later with the same StackShared, with all that they say, and
  /// gives it its own. Programs stay, and the next `prepare` keeps those that still do. Touches no device.
  void adopt(Stack& later);
  /// What `other`, which is not used any more, has made for its structures becomes spare here. Same StackShared and
  /// options.
  void keep_programs_of(Stack& other);
  /// A pixel of each kernel of the last `prepare`, on another device. Touches none of this stack's. Errors: those of
  /// `prepare`.
  Result<void> warm_up(WarmUp& on);
  /// False when no effect has anything to do: the result *is* the source, and `record` records nothing.
  bool runs() const;
  /// The program of the last `prepare`; null before it, and when nothing runs.
  Program* program();
  /// The graph of the last `prepare`.
  const Graph& prepared_graph() const;
  /// Effects, passes and pixels that no frame like the last one that was prepared runs, with reasons.
  std::vector<Skipped> skipped() const;

  /// Whether the content of a frame may make effects idle: then ask `program_for` for the program of each frame.
  bool depends_on_content() const;
  /// The program for a frame with such a source (see IdlePrograms), and what it leaves out. Programs are made when they
  /// are first wanted, and kept. Errors: those of `prepare`.
  Result<IdlePrograms::Choice> program_for(const SourceContent& content);
  /// The region of the last `prepare`.
  const std::optional<Rect>& region() const;
  /// Programs made for the present structure.
  int programs() const;

  /// A program for a variant of this stack's graph that runs every pass by itself and keeps all its images, with the
  /// stack's shaders and histories. In full floats, unless the histories are half floats. Errors: those of `prepare`.
  Result<std::unique_ptr<Program>> program_by_passes(const Graph& graph, const std::optional<Rect>& region) const;
  /// The file of a shader that the last graph names; empty for unknown ones.
  std::filesystem::path shader_file(const std::string& shader) const;

  /// Format that the result image must have: VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT, or with a
  /// display encoding VK_FORMAT_R8G8B8A8_UNORM.
  VkFormat result_format() const;
  /// What earlier frames handed on is forgotten: the next `prepare` begins anew, as BuildContext::restart does.
  void reset_histories();
  /// Goes on where `other` is in its frames, with the images of its histories that mean the same here. `other` is left
  /// without them and must not be used any more; no submission of either may be in flight. Errors: other.
  Result<void> take_histories(Stack& other);

  /// See Program::bind and Program::record for layouts and barriers. Where effects have histories, the frame that is
  /// recorded is the one that `prepare` was given last (BuildContext::frame, step, restart): count frames, and submit
  /// in the order of recording. Preparing a number once more makes that frame once more, from the same frame before it.
  Result<void> bind(const std::map<std::string, ImageBinding>& inputs, const ImageBinding& result);
  void record(VkCommandBuffer commands);

  double script_milliseconds() const;   ///< loading and building so far
  double compile_milliseconds() const;  ///< shaders and pipelines so far

 private:
  struct State;
  explicit Stack(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow

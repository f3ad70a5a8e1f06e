// SPDX-License-Identifier: MIT
// A graph made runnable on a device: pipelines, memory, descriptors. Record it into any command buffer.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/result.h"
#include "gpu/device.h"
#include "graph/graph.h"
#include "graph/plan.h"
#include "graph/region.h"
#include "shader/kernel.h"

namespace afterglow {

class Histories;     // exec/histories.h
class ImagePool;     // exec/image_pool.h
class PipelinePool;  // exec/pipeline_pool.h

/// Pixels of a target from which it is worth a kernel of its own: on smaller ones little is won, and each kernel must
/// be compiled.
struct WorthAKernel {
  std::int64_t ratio = 1 << 16;  ///< that knows how its sizes relate
  std::int64_t rows = 1 << 19;   ///< that makes several rows an invocation
};

struct ProgramOptions {
  ExecutionConfig config{};  ///< as wished: what the device cannot do is left out
  bool reference = false;    ///< every pass on its own, computed weights, no sharing of memory, images may be read back
  /// With `config.storage_reads`: the inputs that will be bound have STORAGE usage, the formats of `input_format`
  /// (host_input.h), and come in GENERAL layout.
  bool inputs_are_storage = false;
  /// So many images of a kernel at most are read as storage images; what the device allows is settled by the program.
  int most_storage_reads = std::numeric_limits<int>::max();
  WorthAKernel worth{};
  bool unorm8 = false;  ///< the result holds 8-bit codes (RGBA8): the last pass gives them as 0…1
  /// The result's alpha is 0 where a colour that was not finite came up in a pass and no pass of another kernel that
  /// reads around its pixel made it finite again, and where a pass made more than the half floats of its image hold;
  /// elsewhere 1 (`unorm8`: what the last pass gave). See FiniteCheck.
  bool flag_non_finite = false;
  bool result_by_rows = false;  ///< the result that will be bound has targets by rows (`Program::result_rows`)
  bool result_stored = false;   ///< likewise, and it has STORAGE usage and comes in GENERAL (`Program::stores_result`)
  /// Only this part of the result is made, in its pixels; what else the result holds is undefined. Empty: all of it.
  std::optional<Rect> region{};
  /// Images between kernels keep their pixels from run to run (they share no memory), so that `record` can run the
  /// kernels alone for which something has changed.
  bool keep_images = false;
  PipelinePool* pipelines = nullptr;  ///< shared with other programs of the device; null: the program's own
  /// With `keep_images`: images between kernels are shared with other programs that have the same kernels, and so is
  /// what they hold. Null: the program's own. It must outlive the program.
  ImagePool* images = nullptr;
  /// Images of the graph's histories, shared with other programs; null: the program makes its own.
  std::shared_ptr<Histories> histories{};
  std::uint64_t max_memory = 6ull << 30;
};

struct ProgramMemory {
  std::uint64_t arena = 0, sum = 0, lower_bound = 0;  ///< bytes of transient images: shared, unshared, least possible
  std::uint64_t histories = 0;                        ///< of what frames hand on
};

/// An image of the caller's or of a Frame that a program reads or writes. Reads happen in SHADER_READ_ONLY_OPTIMAL, the
/// result is written in COLOR_ATTACHMENT_OPTIMAL (by rows, and stored: in GENERAL); the caller brings images into these
/// layouts and is told so in `record`.
struct ImageBinding {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkFormat format = VK_FORMAT_UNDEFINED;
  Size size;
  std::vector<VkImageView> rows{};  ///< RowTargets::views() of a result that is written several rows at a time
};

/// Immutable structure; parameters may be rewritten between frames. Not thread-safe.
class Program {
 public:
  static constexpr int kUnlikeOthers = -1;

  /// Errors: script (shader, a parameter or input that is not given), device (limits, memory), io (over `max_memory`).
  static Result<std::unique_ptr<Program>> create(Device& device, ShaderLibrary& shaders, KernelCompiler& compiler,
                                                 const Graph& graph, const ProgramOptions& options);
  ~Program();

  /// Rewrites parameter bytes from a graph of the same structure; no shader, pipeline or memory is touched. Where the
  /// pixels that the graph brings along are others, no place is bound any more. A graph of
  /// another structure (`same_structure`) is ignored: it needs a program of its own. Must not be called while a
  /// submission of this program is in flight. Errors: device.
  Result<void> set_parameters(const Graph& graph);

  /// By name of an input ("source", "depth", …): a number that no other pixels of it ever had, in this process.
  using InputVersions = std::map<std::string, std::uint64_t>;
  /// The kernels that have to run for the result to be right with these inputs, the parameters as they are, and what
  /// images hold. Parallel to the plan's kernels. Without `keep_images` all or none, but for what is made
  /// once (Plan::once). `result_lost`: the result image does not hold what this program last wrote. What these kernels'
  /// images hold counts as lost until `up_to_date`.
  std::vector<bool> begin_run(const InputVersions& inputs, bool result_lost);
  /// Notes that what `begin_run` said has run, in the frame that its histories began.
  void up_to_date();
  /// Whether the frame that its histories began has one before it, for the history of that name.
  bool has_previous(const std::string& history) const;
  /// What frames hand on to the next; null when the graph has no histories. `Histories::begin` says which frame
  /// `record` records.
  Histories* histories() const;
  /// Other histories, which must have been fitted to this graph (or to one that it was reduced from); nothing happens
  /// where it uses their images already. Else commands recorded before must not be submitted again, and none may be in
  /// flight. Errors: other (they do not fit).
  Result<void> use(std::shared_ptr<Histories> histories);
  /// Frames with the same number are recorded alike, but for what `bindings` tells: 0 and 1 take turns where there are
  /// histories. kUnlikeOthers: the frame has none before it; its commands are good for it alone, and `record` must not
  /// be called for another one of these until it is done.
  int recording() const;

  /// How often a loop of it has run away so far.
  std::uint64_t runaways() const;
  /// Of a run that began when `runaways` was that and is over: errors (script) when a loop of a kernel turned more
  /// often than an invocation may (CompiledKernel::loops). What the run made counts as lost.
  Result<void> check_loops(std::uint64_t since);

  /// Of a run that is over and that nobody wants: lets its loops turn again.
  Result<void> forget_runaways();

  /// Tells programs apart for as long as the process lives.
  std::uint64_t id() const;

  /// Points the graph's inputs and its result at images. Formats of inputs are free (sampled as float); the result's
  /// is `result_format`. Frames that take turns, each with images of its own, have a place each (0, 1, …): what is
  /// recorded for one stays good when another is bound. Must not be called while a submission of that place is in
  /// flight. It submits what the graph brings along and the device does not have yet, and waits; each place makes its
  /// descriptors the first time. A program whose graph's result is its source does nothing. Errors: other (no such
  /// image can be bound), device.
  Result<void> bind(const std::map<std::string, ImageBinding>& inputs /* "source", "depth", … */,
                    const ImageBinding& result, int place = 0);

  /// Whether `bind` has said which images `record` reads and writes, and brought along what they are read with.
  bool bound(int place = 0) const;

  /// How often images were bound so far or came to be unbound, those of histories too. Commands that were recorded
  /// before the last time must not be submitted again.
  int bindings(int place = 0) const;

  /// Records all kernels with their barriers. Inputs must be in SHADER_READ_ONLY_OPTIMAL with their writes made visible
  /// to fragment shader reads; the result must be in COLOR_ATTACHMENT_OPTIMAL (with
  /// `result_rows` above 1, it and its targets in GENERAL; with `stores_result` in GENERAL, ready to be written by
  /// compute shaders) and is left so. `timestamps`: pool with kernels().size()+1 queries, or null. `run`: as
  /// `begin_run` said, or empty for all. Nothing for a place that is not bound.
  void record(VkCommandBuffer commands, VkQueryPool timestamps = VK_NULL_HANDLE, const std::vector<bool>& run = {},
              int place = 0) const;

  /// Records one kernel once more after a run, as the frame that ran last; every image holds and is laid out after it
  /// what and as it was before. Needs `keep_images`, or that all that ran are recorded again, in their order. The
  /// caller's images as for `record`. `timestamps`: a pool with 2 queries, or null.
  void record_again(VkCommandBuffer commands, std::size_t kernel, VkQueryPool timestamps = VK_NULL_HANDLE,
                    int place = 0) const;

  /// Records one pixel of each kernel: drivers that compile when something is first drawn do so then. As `record` in
  /// the rest, but what images hold is undefined behind it. `backwards`: the last kernel first, where images between
  /// kernels are linear, as those of CPU devices are.
  void record_a_pixel_each(VkCommandBuffer commands, bool backwards = false, int place = 0);

  const Plan& plan() const;
  const Graph& graph() const;
  ProgramMemory memory() const;
  /// What authors of its shaders should know, each once: see CompiledKernel::warnings.
  std::vector<std::string> warnings() const;
  VkFormat storage_format() const;
  /// What is read of inputs and made of the others: everything, unless there is a region.
  const Regions& parts() const;
  /// As it is executed: what was wished, as far as the device can do it.
  const ExecutionConfig& config() const;
  bool flags_non_finite() const;   ///< ProgramOptions::flag_non_finite
  VkFormat result_format() const;  ///< the storage format, or R8G8B8A8_UNORM with ProgramOptions::unorm8
  /// With `result_by_rows`: how many rows the targets of the result must have; 1: they are not used.
  int result_rows() const;
  /// With `result_stored`: the result is not drawn, but stored by a compute shader.
  bool stores_result() const;
  /// The layout in which `record` wants the inputs: SHADER_READ_ONLY_OPTIMAL, or GENERAL (then with STORAGE usage).
  VkImageLayout input_layout() const;
  /// A transient image and the layout it is in after a whole run; null for images without memory of their own (inputs,
  /// the result, what fused passes hand on). Its pixels are `kept` after the run by a program created with `reference`
  /// alone.
  struct Transient {
    ImageBinding binding;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    bool kept = false;
  };
  std::optional<Transient> transient(ImageId image) const;

  struct Counters {
    int pipelines = 0, images = 0, allocations = 0;
  };
  Counters counters() const;  ///< objects made so far; steady frames leave them alone

 private:
  struct State;
  explicit Program(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow

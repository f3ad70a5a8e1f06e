// SPDX-License-Identifier: MIT
// The programs of one stack on one device, and what its frames hand on to each other. A frame's program is found by the
// structure of its graph, the texts of its shaders, its region and its encoding; values alone never make a new one.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "exec/image_pool.h"
#include "exec/pipeline_pool.h"
#include "exec/program.h"
#include "graph/condition.h"

namespace afterglow {

/// What the stacks of one device may share: kernels and pipelines that one has made, the others need not make again.
/// Thread-safe.
struct SharedKernels {
  explicit SharedKernels(std::filesystem::path cache_folder) : compiler(std::move(cache_folder)) {}
  KernelCompiler compiler;
  PipelinePool pipelines;
  ImagePool images;  ///< of programs that keep them: they must be run on one thread
};

/// What is to run for a frame: a value.
struct FrameWork {
  Graph graph{};
  Hash texts{};                  ///< of the graph's shaders: see `texts_of`
  std::optional<Rect> region{};  ///< of the result, in its pixels and within it; empty: all of it
  bool unorm8 = false;           ///< the last pass gives 8-bit codes
  /// In place of that of ProgramCacheOptions::config, which looks at no frame.
  std::optional<Storage> storage{};
  double frame = 1, step = 1;  ///< number, and how many after the frame before it; see Histories::begin
  bool restart = false;        ///< no frame is before it
  bool runs() const { return graph.result != graph.source; }
};
/// Can one program do for both, with other values?
bool same_program(const FrameWork& a, const FrameWork& b);
/// Of all shaders of a graph, with what they include. Errors: script.
Result<Hash> texts_of(const Graph& graph, ShaderLibrary& shaders);

struct ShaderFindings {
  std::vector<Error> errors;
  std::vector<std::string> warnings;  ///< see CompiledKernel::warnings
};

/// Kernels that were checked: most levels of a pyramid, and most of other graphs of the same look, are described alike;
/// some that are not have the same text.
struct CheckedKernels {
  std::vector<KernelDesc> described;
  std::set<Hash> texts;
};

/// Compiles every kernel that the frame's program has on a CPU device for `run`, touching none. What is wrong with
/// each. Kernels of `checked` are not compiled again; those that were are added to it.
ShaderFindings check_kernels(ShaderLibrary& shaders, KernelCompiler& compiler, const FrameWork& work,
                             const ExecutionConfig& config, CheckedKernels& checked);

struct ProgramCacheOptions {
  ExecutionConfig config{};
  bool reference = false;   ///< every pass on its own, computed weights, no sharing of memory
  bool own_images = false;  ///< source and result will be a Renderer's, made as the programs like them best
  bool skip_idle = true;    ///< run frames without the effects that their content makes idle (never with `reference`)
  bool flag_non_finite = false;  ///< see ProgramOptions, also for the next
  bool keep_images = false;
  /// Programs of other structures that stay besides the present one, for presets whose structure moves with the frame;
  /// with their images and the present one's, within a quarter of `max_memory`.
  int spare = 0;
  std::uint64_t max_memory = 6ull << 30;  ///< bytes of device memory for images
  Diagnostics* diagnostics = nullptr;     ///< takes the warnings of shaders (CompiledKernel::warnings); null: nobody
};

/// Not thread-safe; but caches with the same SharedKernels may be filled on different threads. Device and shaders must
/// outlive it.
class ProgramCache {
 public:
  ProgramCache(Device& device, std::shared_ptr<SharedKernels> shared, const ProgramCacheOptions& options);
  ~ProgramCache();
  ProgramCache(const ProgramCache&) = delete;
  ProgramCache& operator=(const ProgramCache&) = delete;

  const ProgramCacheOptions& options() const;

  /// Whether `find` would make nothing.
  bool has(const FrameWork& work) const;
  /// Makes the program for this frame the present one, from here if it is here, else new. Without `has` no submission
  /// of any program here may be in flight; else nothing that is in flight is touched. Errors: script, device, io
  /// (memory limit); then there is no present one.
  Result<void> find(FrameWork work, ShaderLibrary& shaders);
  /// Writes the values of the frame that was found last, and begins it in the histories. No submission of the program
  /// may be in flight.
  Result<void> begin();
  /// `find` and `begin`.
  Result<void> prepare(FrameWork work, ShaderLibrary& shaders);

  /// The frame of the last `find`; null before it, and after one that failed.
  const FrameWork* work() const;
  /// The present program; null when nothing runs.
  Program* program() const;

  /// The program of that number (Program::id), if it is one of the present structure; else null.
  Program* program(std::uint64_t id) const;

  /// What runs a frame.
  struct Choice {
    Program* program = nullptr;      ///< null: nothing runs, the result is the source
    std::vector<Skipped> skipped{};  ///< effects that the content makes idle, with reasons
  };
  /// Whether the content of a frame may make effects idle: then ask `for_content`.
  bool depends_on_content() const;
  /// The program for a frame with such a source, without the effects and the work on alpha that it makes idle. Made
  /// when it is first wanted, and kept. Errors: those of `find`.
  Result<Choice> for_content(const SourceContent& content, ShaderLibrary& shaders);

  /// `for_content` of a source as most are, before a frame is there: opaque, and no effect is idle. Null when nothing
  /// runs. Errors: those of `find`.
  Result<Program*> usual(ShaderLibrary& shaders);

  /// The frame that began was recorded or has run.
  void made();
  /// What earlier frames handed on is forgotten: the next one has none before it.
  void reset_histories();
  /// See Histories.
  std::vector<std::string> take_replaced_histories();
  /// Takes the place of `before`: goes on where that is in its frames, with the images of its histories that mean the
  /// same here, and if so with its programs as spare ones. `before` must not be used any more, and no submission of
  /// either may be in flight.
  void take_over(ProgramCache& before, bool programs);

  /// A program for a variant of the graph that runs every pass by itself and keeps all its images, with these
  /// histories. In full floats, unless the histories are half floats. Errors: those of `find`.
  Result<std::unique_ptr<Program>> by_passes(const Graph& graph, const std::optional<Rect>& region,
                                             ShaderLibrary& shaders) const;
  /// Such a program once more, for the frame that began: false where its histories are others now and it cannot be
  /// used.
  bool can_use_again(Program& by_passes) const;
  const std::shared_ptr<SharedKernels>& kernels() const;
  /// As programs here are made, for WarmUp.
  ProgramOptions program_options() const;

  int programs() const;         ///< made for the present structure
  double milliseconds() const;  ///< that shaders and pipelines took so far

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace afterglow

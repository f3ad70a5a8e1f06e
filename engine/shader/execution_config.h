// SPDX-License-Identifier: MIT
// How a stack is executed, as one value: the calibration chooses it, the bench varies it, a report names it, and every
// room down to the kernel reads it. It is declared here alone, in the first room that needs it. Every value of it makes
// the same picture, within the error that its storage and its fetches allow.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/result.h"

namespace afterglow {

/// Which passes share a kernel.
enum class Fusion {
  none,     ///< every pass on its own
  filters,  ///< a filter with the pixel pass of the same effect that follows it: passes as math.md §4 writes them
  all       ///< pixel passes with whatever feeds them
};

/// What images between kernels hold.
enum class Storage { fp32, fp16 };

inline constexpr int kMaxRows = 8;  ///< colour attachments that every desktop device has

struct ExecutionConfig {
  Fusion fusion = Fusion::all;
  Storage storage = Storage::fp32;
  /// The sampler may interpolate (8-bit fractions) where that helps and the device can.
  bool hardware_filter = false;
  /// Images are read as storage images where shaders and device allow it: faster on CPU devices.
  bool storage_reads = false;
  /// Passes that have a second way, by a compute shader, take it: faster where many invocations run at once.
  bool compute = false;
  /// Kernels are compute shaders, which store their pixels, where nothing keeps them from it; else they are drawn.
  /// Faster on GPUs that have more of them than of what draws, such as those of data centres.
  bool dispatched = false;
  /// Images that have one or two channels (graph/graph.h) are stored in four all the same. Devices that cannot draw or
  /// read the formats of fewer do so anyway.
  bool four_channels = false;
  bool share_memory = true;  ///< images whose lifetimes do not overlap share bytes
  /// Rows of its target that one invocation of a kernel may make where neighbouring rows read the same texels
  /// (1 … kMaxRows): faster on CPU devices. More than 1 makes the images between kernels linear.
  int rows = 1;
  /// The driver is kept from compiling a kernel again for each value of its parameters, as CPU drivers do. Costs an
  /// instruction a read. It has no word: exec/cpu decides it by the device.
  bool defeat_uniform_inlining = false;
  /// Loops that may never end are ended, with an error (kernel.h, CompiledKernel::loops). Without a word: wherever the
  /// device can.
  bool guard_loops = false;
  /// Sample shaders that tell where they are done (kDoneFunction) are drawn twice: what is done, then the rest. CPU
  /// drivers take all pixels through both sides of a branch, but leave out groups of pixels that fail a depth test.
  /// It has no word:
  /// exec/cpu decides it.
  bool two_draws = false;
  /// Parameters come to fragment shaders through the vertex shader: CPU drivers read a uniform block for each pixel by
  /// itself. Likewise without a word.
  bool flat_parameters = false;
  friend bool operator==(const ExecutionConfig&, const ExecutionConfig&) = default;
};

/// The baseline of all comparisons: one RGBA16F fragment pass for each pass of math.md §4, read through a linear
/// sampler (a B-spline is then four fetches).
inline constexpr ExecutionConfig kPlain16f{
    .fusion = Fusion::filters, .storage = Storage::fp16, .hardware_filter = true};
/// The same in full floats.
inline constexpr ExecutionConfig kPlain32f{
    .fusion = Fusion::filters, .storage = Storage::fp32, .hardware_filter = true};

/// "fused fp32 storage-reads rows8": the words of all that is not default, after fusion and storage.
std::string execution_name(const ExecutionConfig& config);

/// Reads what `execution_name` writes, or "plain16f", "plain32f". Words may be separated by spaces or '+', in any
/// order. Errors: usage.
/// `from`: what is not said is as there.
Result<ExecutionConfig> parse_execution(const std::string& text, const ExecutionConfig& from = {});

/// All words, for messages.
std::vector<std::string> execution_words();

}  // namespace afterglow

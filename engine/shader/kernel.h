// SPDX-License-Identifier: MIT
// A kernel: one full-screen fragment shader, or one compute shader, made of an anchor (how the first colour of a pixel
// is found) and pixel stages that follow. Assembled from authors' GLSL and from filters described as data, then
// compiled to SPIR-V and reflected.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/filter.h"
#include "core/result.h"
#include "shader/execution_config.h"
#include "shader/interface.h"
#include "shader/library.h"

namespace afterglow {

/// Colours inside a kernel have numbers: 0 is the anchor's, n what the n-th pixel stage made.
inline constexpr int kOwnImage = -1;  ///< no such colour: it is read from an image, at the target's pixel

/// One author's shader in a kernel with the values of its specialised parameters (by name; missing: the default).
struct KernelStage {
  std::shared_ptr<const ShaderSource> shader;
  std::map<std::string, double> constants;
  std::string label;  ///< name of the pass, for messages and comments: "glow.threshold"
  /// Its colour is divided by its alpha before and multiplied behind (by what math.md §19 makes of it); of neighbours
  /// that want it, once around all. What such a stage returns as alpha does not count.
  bool straight = false;
  /// Of a straight stage: what it makes of black is taken away where alpha is 0.
  bool lights_black = false;
  /// Of a sample stage: how far it reads (graph/graph.h). A hint: no text depends on it.
  std::optional<double> reach = {};
  /// Of a pixel stage: the number of the colour that flows into `apply`, or kOwnImage. Nothing: that of the stage
  /// before it.
  std::optional<int> color = {};
  /// Pixel-wise inputs that are colours of this kernel, by name; the others are images.
  std::map<std::string, int> values = {};
  /// Pixel-wise inputs ("source": the colour) whose image an earlier stage has read at the own pixel: that stage, as in
  /// KernelParam::stage, and its input's name. They need no slot of their own.
  std::map<std::string, std::pair<int, std::string>> again = {};
  /// What it makes has so many channels, 1, 2 or 4: those behind them are 0, alpha 1, whatever it says.
  int channels = 4;
};

/// How source and target sizes of a filter anchor relate on an axis; the executor picks it from the sizes, the
/// assembler emits cheaper addressing for the exact cases.
enum class AxisRatio { any, same, half, twice, fourfold };  // n_dst = n_src · {?, 1, 1/2, 2, 4}, exactly

/// How the engine reads an image: through a sampler, or as a storage image of a format, which some devices do much
/// faster (lavapipe: 0.6 against 1.8 ns a texel of four floats).
enum class ImageRead {
  sampled,
  storage_rgba32f,
  storage_rgba16f,
  storage_r32f,
  storage_rg32f,
  storage_r16f,
  storage_rg16f
};

/// What a kernel writes: 32-bit floats; 16-bit floats (held to ±65504 and rounded); 8 bits of codes that the last stage
/// gives as 0…1.
enum class KernelTarget { float32, float16, unorm8 };

/// What a kernel does where a colour on its way is not finite: that of the anchor, one that a stage reads at its own
/// pixel, or what a stage made of them, whatever later stages make of it. (Finite ones whose sum is above 1e38 count as
/// such; so does what half floats cannot hold, in a kernel that writes them.)
enum class FiniteCheck {
  none,
  propagate,  ///< it writes NaN there, so that later kernels see it
  flag        ///< it writes alpha 0 there, and elsewhere 1 (unorm8: what the last stage gave)
};

struct KernelDesc {
  /// Anchor stage: exactly one of `filter` (source is bound at image 0) or `sample` is set; neither: the own pixel of
  /// image 0.
  std::optional<Filter> filter;
  AxisRatio ratio_x = AxisRatio::any, ratio_y = AxisRatio::any;
  int filter_channels = 4;            ///< of what the filter makes, as KernelStage::channels
  std::optional<KernelStage> sample;  ///< a shader with sample_at, or with compute_at: then this is a compute shader
  std::vector<KernelStage> stages;    ///< pixel stages, in order
  /// As the program that it is of; but `rows` are those that one invocation of this kernel makes, each its own output
  /// location: invocation (x, Y) makes the pixels (x, rows·Y) … (x, rows·Y + rows − 1). What neighbouring rows both
  /// read is read once.
  ExecutionConfig config{};
  KernelTarget target = KernelTarget::float32;
  int target_channels = 4;  ///< that its image stores: 1, 2 or 4
  FiniteCheck finite_check = FiniteCheck::none;
  /// Wished for each image slot, in the order of AssembledKernel::images; those beyond the end are sampled. An input
  /// that an author's shader uses in any other way than by the prelude's functions stays sampled.
  std::vector<ImageRead> reads{};
};

/// Whether both come to the same text: all but the labels of their stages counts. Cheap beside `assemble`.
bool same_kernel(const KernelDesc& a, const KernelDesc& b);

/// Name and version of the compiler of kernels: part of cache keys. Does not initialise it.
std::string glsl_compiler_version();

/// Where a dynamic parameter lies in the kernel's uniform block.
struct KernelParam {
  int stage = 0;  ///< 0-based over [sample, stages…] (the sample stage, when there is one, is 0)
  std::string name;
  ParamType type = ParamType::float1;
  std::uint32_t offset = 0;                      ///< bytes, from SPIR-V reflection
  static constexpr std::uint32_t kUnread = ~0u;  ///< offset of one that the compiled shader does not have
  int elements = 0;                              ///< of an array; 0: it is none
};

/// GLSL ready for the compiler, with what the executor must bind.
/// Set 0: binding 0 the uniform block (absent when `block_size` is 0), bindings 1… the images in the order of `images`,
/// combined image samplers or storage images. The block is std140; a bool takes 4 bytes, 0 or 1. Slots that are
/// `interpolated` need a sampler with linear filtering and clamp-to-edge; the others only use texelFetch. The result is
/// location 0, or with several rows an invocation, locations 0 … rows−1. A compute shader stores its result in a
/// storage image, which is bound behind the others. Push constants: see kPushConstantBytes below.
struct AssembledKernel {
  std::string glsl;
  /// Image slots: the anchor's source (filter or own pixel) or the sample stage's sampler2D inputs in order of
  /// declaration, then of each pixel stage the image that is its colour (`kOwnImage`: "source") and its pixel-wise and
  /// sampler2D inputs in order of declaration, without those that are colours of the kernel
  /// or were read before.
  struct ImageSlot {
    int stage = -1;    ///< -1: the anchor's source; else as in KernelParam::stage
    std::string name;  ///< input name, or "source" for the anchor
    ImageRead read =
        ImageRead::sampled;     ///< what the kernel got: a combined image sampler or a read-only storage image
    bool interpolated = false;  ///< by a sampler with linear filtering and clamp-to-edge
  };
  std::vector<ImageSlot> images;
  std::vector<KernelParam> params;      ///< dynamic parameters in the order of the block; offsets are not known yet (0)
  std::vector<std::string> file_names;  ///< index used in #line directives → file path; [0] is the engine's own text
  /// A variable that authors declare without a value, or the result of a function that may have none. It gets zeros.
  struct UnsetVariable {
    /// `argument`: an `out` one that its function may leave as it is.
    enum class Role { variable, argument, result };
    std::string name;      ///< as in the file
    std::string variable;  ///< of file scope: its name in `glsl`; else empty
    std::string file;
    int line = 0;
    Role role = Role::variable;
  };
  std::vector<UnsetVariable> unset;
  std::vector<std::string> warnings;   ///< of its shaders: "look/shaders/glow.glsl:7: …"
  std::optional<Workgroup> workgroup;  ///< of a compute shader
  bool two_draws = false;              ///< see KernelDraw
  Hash hash;                           ///< of glsl
};

/// Which pixels a kernel makes, as the value of its specialisation constant kDrawConstant, which those with `two_draws`
/// have. `done`: those that its sample shader is done with, at depth 0; the others, which it leaves at depth 1, mean
/// nothing. `rest`: the others.
enum class KernelDraw { all = 0, done = 1, rest = 2 };
inline constexpr std::uint32_t kDrawConstant = 0;
/// `spirv` of such a kernel for the second draw: depth is tested before it runs, whatever it stores.
std::vector<std::uint32_t> tested_early(std::vector<std::uint32_t> spirv);

/// A kernel's `spirv` whose parameters and sizes come from a vertex shader that reads the same block and push
/// constants.
struct FlatParameters {
  std::vector<std::uint32_t> fragment, vertex;
};
/// Nothing where it reads no parameters or sizes, or more than `most_locations` of four numbers can hold. Pixels are
/// the same bits.
std::optional<FlatParameters> flat_parameters(const std::vector<std::uint32_t>& spirv, std::uint32_t most_locations);

/// Push constants of every kernel (its one stage): ivec2 target size, ivec2 size of image 0.
inline constexpr std::uint32_t kPushConstantBytes = 16;

struct CompiledKernel {
  std::vector<std::uint32_t> spirv;
  std::vector<AssembledKernel::ImageSlot> images;
  std::vector<KernelParam> params;
  std::uint32_t block_size = 0;  ///< bytes of the uniform block; 0: none
  int rows = 1;                  ///< that one invocation makes
  /// They take turns; those of a sample shader read mostly the same texels, each once. Else one row is as fast.
  bool rows_pay = false;
  std::optional<Workgroup> workgroup;  ///< of a compute shader; the target is then the last of the images to bind
  std::uint64_t shared_bytes = 0;      ///< that a workgroup shares
  KernelTarget target = KernelTarget::float32;
  int target_channels = 4;
  bool two_draws = false;        ///< see KernelDraw
  bool flat_parameters = false;  ///< as in its execution
  /// What authors should know, as FILE:LINE: TEXT: variables that may be read before they have a value (they are 0).
  std::vector<std::string> warnings;
  /// With `config.guard_loops`, where each loop stands, when one of them may be endless. The kernel then needs a
  /// storage buffer of one word, 0 before it runs, behind all images: afterwards it is 0, or n when loop n − 1 turned
  /// more often than an invocation may; its pixels mean nothing then.
  struct LoopPlace {
    std::string file;  ///< empty: the engine's own text
    int line = 0;
  };
  std::vector<LoopPlace> loops;
  Hash hash;
};
/// Turns that the loops of one invocation may make together, where they are guarded.
extern const std::uint32_t kMaxLoopTurns;

/// What neighbouring rows of the target read: all `together`, and each by itself, summed. Counted in lines of a
/// separable filter, in texels of a free one.
struct RowsRead {
  int together = 0, apart = 0;
  int lines = 0;  ///< of texels, all together
};
/// For a kernel with this filter as its anchor; nothing where each row is made by itself.
std::optional<RowsRead> rows_shared(const Filter& filter, AxisRatio ratio_y, int rows);

/// Pure text. Errors: script, only for what ShaderLibrary could not see.
Result<AssembledKernel> assemble(const KernelDesc& kernel);

/// GLSL → SPIR-V with glslang, reflected with SPIRV-Cross, cached on disk by the hash of the assembled text and the
/// compiler version. Corrupt cache files are ignored and rebuilt; the folder is held within CacheLimits
/// (core/cache_folder.h). Thread-safe.
class KernelCompiler {
 public:
  explicit KernelCompiler(std::filesystem::path cache_folder);  ///< empty: no disk cache
  ~KernelCompiler();

  /// Errors (script): GLSL errors, with the author's file and line, and the compiler's further lines in `trail`.
  Result<CompiledKernel> compile(const KernelDesc& kernel);
  /// The same of what `assemble` made of the kernel.
  Result<CompiledKernel> compile(const KernelDesc& kernel, AssembledKernel assembled);

  struct Counters {
    int compiled = 0, from_disk = 0, from_memory = 0;
  };
  Counters counters() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace afterglow

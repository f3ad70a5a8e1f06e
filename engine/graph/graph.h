// SPDX-License-Identifier: MIT
// The pass graph as plain data: what a preset's `build` functions describe. No Lua, no Vulkan.
// Images are immutable: a pass makes exactly one new image, so a graph is a list of passes in a valid order.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/filter.h"
#include "core/geometry.h"
#include "core/image_data.h"
#include "core/result.h"
#include "shader/execution_config.h"
#include "shader/interface.h"

namespace afterglow {

using ImageId = int;
inline constexpr ImageId kNoImage = -1;

struct GraphImage {
  std::string name;  ///< "source", "depth", or the name of the pass that makes it
  Size size;
  int producer = -1;  ///< index of the pass that makes it; -1: an input of the graph, or what a history holds
  /// Of an image that the look brings along (tables, pictures from files): its pixels, which may change without a
  /// rebuild. Such an image is no input of a frame; the program holds it.
  std::shared_ptr<const ImageData> data = {};
  /// Of an image that a pass makes: 1, 2 or 4. Readers find (r, 0, 0, 1), (r, g, 0, 1) or all four, whatever its pass
  /// says of the others and however many are stored (stored_channels).
  int channels = 4;
  /// Of an image that a pass makes: full floats, whatever the others between passes are stored in.
  bool precise = false;
};

/// A value for a shader parameter (bool as 0/1): component_count numbers, a matrix's column by column; of an array
/// those of its elements, one behind the other.
struct ParamValue {
  ParamType type = ParamType::float1;
  std::vector<double> v{};
  int elements = 0;  ///< of an array; 0: it is none
  friend bool operator==(const ParamValue&, const ParamValue&) = default;
};

/// As scripts write it: a single row of numbers, or the rows of a matrix, or the elements of an array.
std::vector<std::vector<double>> rows_of(const ParamValue& value);

struct PassInput {
  std::string name;  ///< as the shader declares it; "source" for the colour of a pixel pass or of a filter
  ImageId image = kNoImage;
  bool pixelwise = false;  ///< read at the target's own pixel only: the image is as large as the target
  friend bool operator==(const PassInput&, const PassInput&) = default;
};

struct Pass {
  std::string name;    ///< unique: "glow.down[2]"
  std::string effect;  ///< name of the effect's entry, "glow"
  PassKind kind = PassKind::pixel;
  std::string shader;  ///< "glow/threshold"; empty for filters
  /// Of a sample pass: a compute shader with the same inputs and parameters that makes the same image, for devices on
  /// which workgroups do it faster. Empty: none.
  std::string by_workgroups;
  Filter filter;                             ///< for kind filter
  std::vector<PassInput> inputs;             ///< a pixel pass's first input is "source"
  std::map<std::string, ParamValue> params;  ///< dynamic: values may change without a rebuild
  std::map<std::string, double> constants;   ///< specialised: part of the structure
  /// Of a sample pass: how far from the point that corresponds to a target pixel's centre it reads, in texels of each
  /// input. Empty: anywhere. Decides what a region needs, and whether it is tried to let
  /// rows of pixels share what they read.
  std::optional<double> reach;
  /// Of a pixel pass: its colour is divided by its alpha before and multiplied by it behind (math.md §19).
  bool straight = false;
  /// Of a straight one: it may make light of black, which is taken away again where alpha is 0: nothing is there.
  bool lights_black = false;
  ImageId output = kNoImage;
  std::string file;  ///< script and line that asked for it, for messages
  int line = 0;
};

/// Something that was left out, and why: an effect, a pass.
struct Skipped {
  std::string name;
  std::string reason;  ///< "intensity is 0", "no depth input", "nobody reads its image"
  std::vector<std::string> lacks = {};  ///< inputs that it needs and that are not there
  bool can_lack = false;                ///< the look says that it may be without them
  friend bool operator==(const Skipped&, const Skipped&) = default;
};

/// An effect whose output is exactly its input, bit for bit, as long as no red, green or blue of `image` is above
/// `limit` (a 32-bit float; all of them finite and ≥ 0). See graph/condition.h.
struct IdleCondition {
  std::string effect;         ///< name of the effect's entry
  ImageId image = kNoImage;   ///< the effect's own source: what is looked at, and what takes the place of `output`
  ImageId output = kNoImage;  ///< what the effect makes
  double limit = 0;           ///< rounded to a 32-bit float, as parameters of shaders are
};

/// An image that one frame makes for the next. Both images have the same size. See graph/history.h.
struct History {
  std::string name;             ///< unique: "glow.past"
  std::string effect;           ///< name of the effect's entry
  ImageId previous = kNoImage;  ///< read: what `next` was in the frame before; no pass makes it
  ImageId next = kNoImage;      ///< made by a pass; not the result
  /// Read in place of `previous` when there is no frame before; made before anything reads `previous`. kNoImage: every
  /// pixel is `initial` then.
  ImageId first = kNoImage;
  std::array<double, 4> initial{};  ///< rounded to 32-bit floats; may change without a rebuild
  bool precise = true;              ///< in full floats, whatever the storage of the other images
  int pre_roll = 1;                 ///< earlier frames after which it hardly matters that there was none before them
};

struct Graph {
  std::vector<GraphImage> images;
  std::vector<Pass> passes;
  ImageId source = kNoImage;                 ///< the picture
  std::map<std::string, ImageId> auxiliary;  ///< "depth", "normal", … that some effect asked for
  ImageId result = kNoImage;                 ///< == source when nothing runs
  std::vector<Skipped> skipped;
  std::vector<IdleCondition> idle;  ///< in the order of the stack; limits may change without a rebuild
  std::vector<History> histories;   ///< in the order in which effects ask for them
};

/// Whether a compute pass makes the image. Such an image is neither the result nor kept by a history: those are drawn
/// to.
bool is_computed(const Graph& graph, ImageId image);

/// How many channels an auxiliary image holds, where its name tells: of "depth" 1, of "motion" 2, of "normal" 3. Others
/// hold what a frame brings.
std::optional<int> known_channels(const std::string& input);

/// How many channels the memory of a pass's or a history's image holds: as many as it has, of what a history keeps as
/// many as `previous` has, but four of the result and where `config` wants no fewer.
int stored_channels(const Graph& graph, ImageId image, const ExecutionConfig& config);

/// Names of the shaders that a pass may run.
std::vector<std::string> shaders_of(const Pass& pass);

/// Checks what the script binding cannot break but a program might: ids in range, producers before readers, no image
/// written twice, sizes ≥ 1, unique names, pixel-wise inputs as large as the target, conditions between images of one
/// size, histories whose images exist and fit. Errors (script) name effect and pass.
Result<void> validate(const Graph& graph);

/// True when b differs from a in dynamic parameter values and in the pixels of what the look brings along alone, so
/// that a program made for a can run b.
bool same_structure(const Graph& a, const Graph& b);

/// JSON for `afterglow graph --format json` and for tests.
std::string to_json(const Graph& graph);

}  // namespace afterglow

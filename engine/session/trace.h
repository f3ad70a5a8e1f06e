// SPDX-License-Identifier: MIT
// Finds out which passes of a frame make values that are not finite, and makes the frame without them: every pass runs
// by itself, in full floats where that means the same, with a pass behind it that mends what it made. So each pass
// reads finite values alone, and what it makes that is not finite is its own doing.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/picture.h"
#include "script/preset.h"
#include "session/stack.h"

namespace afterglow {

/// What one pass made out of finite values.
struct PassFinding {
  std::string pass;    ///< as in `afterglow graph`: "glow.down[2]"; "history NAME": what an earlier frame handed on
  std::string effect;  ///< name of the effect's entry
  std::string file;    ///< the script that asked for the pass, and where
  int line = 0;
  std::string shader;  ///< file; empty for filters
  Size size;           ///< of its image
  NonFinite found;     ///< places are pixels of that image
};

/// "pass 'glow.divide' made 12 NaN, first at pixel 5,3: (nan, 0, 0, 1)", with the file that is to blame.
std::string finding_text(const PassFinding& finding);
/// Places become pixels of the picture, from the upper left corner of its display window, where an image covers it.
void set_places(std::vector<PassFinding>& findings, const Picture& picture);

/// Finite values that half floats cannot hold, of one pass.
struct PassOverflow {
  std::string pass, effect;
  std::uint64_t samples = 0;
  NonFinitePixel first;
};

struct Trace {
  std::vector<PassFinding> passes;      ///< in their order
  std::vector<PassOverflow> overflows;  ///< passes with values beyond ±65504, in their order
  Image result;                         ///< RGB mended; A that of the source
};

/// What stands in a message where no pass is to blame.
inline constexpr const char* kUntraced =
    "values that are not finite came up in fused passes, but in no pass by itself in full floats; try --reference";

/// The graph with a pass behind each that makes what is not finite 0, or a mean of neighbours. `made[i]`: the image
/// that pass i of `graph` makes in the new one, before it is mended.
struct GuardedGraph {
  Graph graph;
  std::vector<ImageId> made;
};
GuardedGraph guard(const Graph& graph, NanPolicy policy);

/// Not thread-safe. Keeps what it made for the next frame.
class Tracer {
 public:
  Tracer(Device& device, std::uint64_t max_memory);
  ~Tracer();
  /// Makes the frame that the stack was prepared for last once more, from its picture. With a region, only that part is
  /// made and looked at. Errors: those of Stack::prepare and of Renderer::run.
  Result<Trace> run(Stack& stack, const Picture& picture, const FrameRequest& request, NanPolicy policy);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace afterglow

// SPDX-License-Identifier: MIT
// Runs stacks on pictures, in any way of execution, and keeps what can be used again.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exec/frame.h"
#include "image/picture.h"
#include "reference/stack.h"
#include "session/stack.h"
#include "stress/look.h"

namespace afterglow::stress {

/// How a stack is executed.
struct Way {
  ExecutionConfig choice;  ///< ignored with `plain`
  bool plain = false;      ///< every pass on its own in full floats (StackOptions::reference)
  bool skip_idle = false;  ///< effects that the content makes idle are left out, as `run` does
  bool copied = false;     ///< the result is copied: its last pass runs as one in the middle does
  std::optional<Rect> region;
  std::string show;  ///< the image that takes the result's place; empty: the result
  std::string name() const;
};

struct Made {
  Image image;  ///< RGBA
  std::uint64_t clamped = 0;
  bool shown = true;  ///< false: there is no image of the name that was asked for
};

/// What scripts say about a look for pictures of a size.
struct LookFacts {
  std::vector<reference::Entry> entries;  ///< those that run, as the oracle wants them
  std::vector<Invariant> invariants;      ///< promises of a stack of one effect that is not faded, blended or masked
  std::optional<double> error;  ///< against double precision, in full floats, as far as its effects promise it
  bool runs = false;
  std::string left_out;     ///< why the first entry that does not run is left out; empty: all run
  std::string changing;     ///< Build::changing
  bool divides = false;     ///< by alpha, unless that is 1 everywhere
  bool looks_back = false;  ///< a frame hands something on to the next
  std::size_t passes = 0;
  std::vector<std::string> images;  ///< names of those that passes make as large as the picture: Way::show takes them
};

/// Not thread-safe.
class Harness {
 public:
  /// `device` must outlive it. `cache`: for shaders; empty: none.
  static Result<std::unique_ptr<Harness>> create(Device& device, const std::filesystem::path& cache,
                                                 Diagnostics& diagnostics);
  ~Harness();

  /// The result of a stack for a picture, which begins a sequence. Of a picture whose `content` is known, a result that
  /// was made before is given again. Errors: as of Stack::prepare and FrameRunner::run.
  Result<Made> run(const Look& look, const Picture& picture, double frame, const Way& way);
  /// The results of frames that follow each other, the first without one before it. All have the same size.
  Result<std::vector<Made>> run_sequence(const Look& look, const std::vector<Picture>& pictures, double first,
                                         const Way& way);
  /// What the region of `way` reads of each input of the picture, by name; nothing where nothing runs.
  Result<std::map<std::string, Rect>> read_of_inputs(const Look& look, const Picture& picture, double frame,
                                                     const Way& way);
  /// Every image that the passes make, by name, when each runs on its own in full floats.
  Result<std::vector<std::pair<std::string, Image>>> images(const Look& look, const Picture& picture, double frame);
  /// Errors: script (the effect refuses the settings, or its script fails), io (images larger than is tried).
  Result<LookFacts> facts(const Look& look, Size size, double frame);

  /// Forgets stacks, and with them their pipelines, and results of earlier pictures.
  void forget();
  /// As `run` executes on this device, but for what half floats and filtered fetches would change.
  const ExecutionConfig& usual() const;
  Device& device();

 private:
  struct State;
  explicit Harness(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace afterglow::stress

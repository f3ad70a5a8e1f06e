// SPDX-License-Identifier: MIT
// Looks beside the player whether a look makes values that are not finite, and which passes do: what is on screen was
// mended. On a device and a thread of its own, which gives way to whatever else wants the processor.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "play/read_ahead.h"
#include "session/stack.h"
#include "session/trace.h"

namespace afterglow {

struct FiniteWatchOptions {
  DeviceOptions device;      ///< is opened for each answer
  bool until_asked = false;  ///< questions wait for `finish`: nothing runs beside what is being measured
};

/// A frame, and the look as it is on screen.
struct FiniteQuestion {
  std::filesystem::path preset;
  std::optional<std::string> text;  ///< none: as the file has it
  std::vector<Override> overrides;
  std::vector<ArgumentValue> arguments;
  std::shared_ptr<const ReadPicture> picture;
  std::string name;      ///< of the picture
  BuildContext context;  ///< frame number, time, fps and position
};

/// What one frame was found to make. All is well where there are no passes and it is not `untraced`.
struct FiniteAnswer {
  std::string name;  ///< of the picture
  double frame = 0;
  std::vector<PassFinding> passes;  ///< in their order; places are pixels of the picture where it has that size
  bool untraced = false;            ///< something was not finite, but nothing is when every pass runs by itself
};

/// Thread-safe.
class FiniteWatch {
 public:
  /// `answered` is called on the thread after each answer; it must not call back.
  FiniteWatch(FiniteWatchOptions options, StackOptions stack, std::function<void()> answered);
  /// Waits for the frame that is being made.
  ~FiniteWatch();
  FiniteWatch(const FiniteWatch&) = delete;
  FiniteWatch& operator=(const FiniteWatch&) = delete;

  /// In place of a question that waits. It is begun once none has come for a moment: edits come in rows.
  void ask(FiniteQuestion question);
  /// Blocks until there is no question left.
  void finish();
  /// The newest answer, once. A frame that could not be made has none: the player says why.
  std::optional<FiniteAnswer> take();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace afterglow

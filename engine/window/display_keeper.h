// SPDX-License-Identifier: MIT
// The display that pictures are shown on: made anew when its files change or another one is chosen, beside the drawing
// thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "image/display_table.h"

namespace afterglow {

/// A display and a view of the configuration that was named; both are empty, and do not count, for a profile.
using MakeDisplay = std::function<Result<ShownDisplay>(const std::string& display, const std::string& view)>;

/// Functions are for one thread.
class DisplayKeeper {
 public:
  /// `shown`: what is on screen now. `make` is called on a thread of its own; `wake` too, when `take` has something.
  DisplayKeeper(const ShownDisplay& shown, MakeDisplay make, std::function<void()> wake);
  ~DisplayKeeper();

  /// An empty view is the display's first.
  void choose(const std::string& display, const std::string& view);
  /// What was made since the last call; errors are those of `make`, and then what is on screen stays. None: nothing.
  std::optional<Result<ShownDisplay>> take();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace afterglow

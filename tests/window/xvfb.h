// SPDX-License-Identifier: MIT
// A display of its own for each test.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace afterglow {

/// An X server without a screen, on a free display; ends with the object.
class Xvfb {
 public:
  explicit Xvfb(Size screen = {1280, 800});
  ~Xvfb();
  Xvfb(const Xvfb&) = delete;
  Xvfb& operator=(const Xvfb&) = delete;

  bool runs() const { return pid_ > 0; }
  const std::string& display() const { return display_; }  ///< ":7"
  /// Ends it at once, as when a connection breaks.
  void kill();

 private:
  pid_t pid_ = -1;
  std::string display_;
};

struct Screen {
  Size size;
  std::vector<std::uint8_t> rgb;
  const std::uint8_t* at(int x, int y) const { return &rgb[(static_cast<std::size_t>(y) * size.width + x) * 3]; }
};

/// What is on the screen now, through ImageMagick. Empty when that failed.
Screen screenshot(const std::string& display, const std::string& scratch_file);

/// Runs a shell command with DISPLAY set; its exit code and, in `output`, what it printed.
int run_on(const std::string& display, const std::string& command, std::string* output = nullptr);

}  // namespace afterglow

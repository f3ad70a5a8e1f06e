// SPDX-License-Identifier: MIT
#include "window/player_port.h"

#include <algorithm>

namespace afterglow {

const Preset* PlayerPort::preset() {
  Stack* stack = player_.live().stack();
  return stack ? &stack->preset() : nullptr;
}

const Build* PlayerPort::build() {
  Stack* stack = player_.live().stack();
  return stack ? stack->build().get() : nullptr;
}

/// What was built and is not taken yet is still being built for who looks at `build`.
LiveStatus PlayerPort::status() {
  LiveStatus status = player_.live().status();
  status.building = status.building || player_.live().building();
  return status;
}

Rect PlayerPort::middle_region() {
  const Size size = player_.images().picture;
  return {size.width / 3, size.height / 3, std::max(size.width / 3, 1), std::max(size.height / 3, 1)};
}

const std::vector<Skipped>& PlayerPort::skipped() {
  skipped_ = player_.session().skipped();
  return skipped_;
}

}  // namespace afterglow

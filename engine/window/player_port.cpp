// SPDX-License-Identifier: MIT
#include "window/player_port.h"

namespace afterglow {

const Preset* PlayerPort::preset() {
  Stack* stack = player_.live().stack();
  return stack ? &stack->preset() : nullptr;
}

const Build* PlayerPort::build() {
  Stack* stack = player_.live().stack();
  return stack ? stack->build().get() : nullptr;
}

const std::vector<Skipped>& PlayerPort::skipped() {
  skipped_ = player_.session().skipped();
  return skipped_;
}

}  // namespace afterglow

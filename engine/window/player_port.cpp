#include "window/player_port.h"

namespace afterglow {

const Preset* PlayerPort::preset() {
  Stack* stack = player_.live().stack();
  return stack ? &stack->preset() : nullptr;
}

const std::vector<Skipped>& PlayerPort::skipped() {
  static const std::vector<Skipped> kNone;
  Stack* stack = player_.live().stack();
  const Program* program = stack ? stack->program() : nullptr;
  return program ? program->graph().skipped : kNone;
}

}  // namespace afterglow

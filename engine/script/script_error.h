// SPDX-License-Identifier: MIT
// The one exception of the script room. It never leaves the room: `native<…>` (native.h) turns it into a Lua error, and
// Sandbox::run turns that into an Error.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/key_finder.h"
#include "core/printable.h"
#include "core/result.h"

namespace afterglow::script {

struct ScriptError {
  Error error;
  KeyPath key = {};  ///< where in the call's table; empty: the call itself
  /// Last identifier of the call, "glow" of `fx.glow{…}`; empty: the native function's name.
  std::string function = {};
};

/// A ScriptError from its parts; file and line are filled in at the boundary, from the caller.
inline ScriptError failure(std::string message, KeyPath key = {}, std::string allowed = {}, std::string nearest = {}) {
  return {
      {ErrorKind::script, std::move(message), "", 0, std::move(allowed), std::move(nearest), {}}, std::move(key), {}};
}

}  // namespace afterglow::script

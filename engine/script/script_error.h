// SPDX-License-Identifier: MIT
// The one exception of the script room. It never leaves the room: `native<…>` (native.h) turns it into a Lua error, and
// Sandbox::run turns that into an Error.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/result.h"

namespace afterglow::script {

/// Names the offending place inside the table constructor of a call: {"settings", "mode"} or {"#2"} (second positional
/// item).
using KeyPath = std::vector<std::string>;

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

/// One line of bounded length that a terminal can show: control characters replaced, long text cut (UTF-8 safe) with
/// "…".
std::string tidy_message(std::string text, std::size_t limit = 400);

}  // namespace afterglow::script

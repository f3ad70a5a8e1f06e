// SPDX-License-Identifier: MIT
// Values that presets give: fixed, curves over time, functions of time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "script/curve.h"
#include "script/function_ref.h"
#include "script/value.h"

namespace afterglow::script {

/// fx.curve{…} before a setting says what its values must be.
struct DeclaredCurve {
  struct Key {
    double at = 0;
    Value value;
  };
  std::vector<Key> keys;
  Ease ease = Ease::linear;
  bool in_seconds = false;
};

/// A value as the preset gave it, before anyone decided what it must be.
struct Given {
  Value value;
  int curve = -1;  ///< index in Runtime::curves, or -1
  FunctionRef function;
};

/// A value that was checked. At most one of `curve` and `function` is set.
struct Animated {
  SettingValue fixed;
  std::optional<Curve> curve;
  FunctionRef function;
  bool moves() const { return curve || function.set(); }
};

/// The number of a frame: an integer where it is whole, so that `"img." .. t.frame` is "img.7". Beyond 2^31 it stays a
/// float, for the square of an integer may not run over.
void push_frame(lua_State* lua, double frame);

/// Reads a value from the stack; functions are kept in the registry.
Given read_given(lua_State* lua, int index);

/// Like check_setting; each key of a curve is checked. What a function returns is checked when it is called. Errors
/// (script, without file and line): as check_setting, a curve of booleans or choices.
Result<Animated> check_animated(lua_State* lua, const std::string& full_name, const SettingSchema& schema,
                                const Given& given);

/// The value at a frame. A function is called twice and must give the same: pictures must not depend on what was played
/// before. Throws ScriptError, located at the function.
SettingValue evaluate(lua_State* lua, const Animated& given, const std::string& full_name, const SettingSchema& schema,
                      const BuildContext& context);

/// fx.curve.
int declare_curve(lua_State* lua);

}  // namespace afterglow::script

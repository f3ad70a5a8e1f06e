// SPDX-License-Identifier: MIT
// Small values that scripts hold and cannot look into: userdata with a protected metatable and no finalizer.
#pragma once

#include <type_traits>

#include "script/lua.h"

namespace afterglow::script {

/// Names of the kinds, as `tostring` and messages show them. A kind is the key of its metatable in the registry.
inline constexpr const char* kSettingKind = "setting type";
inline constexpr const char* kEffectKind = "effect";
inline constexpr const char* kEntryKind = "effect entry";
inline constexpr const char* kMaskKind = "mask";
inline constexpr const char* kGroupKind = "group of entries";
inline constexpr const char* kStackKind = "stack";
inline constexpr const char* kCurveKind = "curve";
inline constexpr const char* kVolumeKind = "volume";
inline constexpr const char* kImageKind = "image";
inline constexpr const char* kGraphKind = "graph";

/// Index of a thing in the Runtime.
struct Handle {
  int index;
};

/// Makes the metatable of a kind; fields are added to it with the table left on the stack.
inline void push_kind(lua_State* lua, const char* kind) {
  if (!luaL_newmetatable(lua, kind)) return;
  lua_pushboolean(lua, 0);
  lua_setfield(lua, -2, "__metatable");
}

template <class T>
T& push_object(lua_State* lua, const char* kind, const T& value) {
  static_assert(std::is_trivially_destructible_v<T>);
  T* object = new (lua_newuserdatauv(lua, sizeof(T), 0)) T(value);
  push_kind(lua, kind);
  lua_setmetatable(lua, -2);
  return *object;
}

/// Null when the value is not of that kind.
template <class T>
T* to_object(lua_State* lua, int index, const char* kind) {
  return static_cast<T*>(luaL_testudata(lua, index, kind));
}

}  // namespace afterglow::script

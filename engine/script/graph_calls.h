// SPDX-License-Identifier: MIT
// Methods of `g` that stand in files of their own. Internal to the room.
#pragma once

#include "script/graph_builder.h"
#include "script/lua.h"

namespace afterglow::script {

/// The builder behind argument 1. `call` is how it should have been written.
GraphBuilder& graph_of(lua_State* lua, const char* call);

int graph_image(lua_State* lua);
int graph_lookup(lua_State* lua);
int graph_ocio(lua_State* lua);
int graph_cryptomatte(lua_State* lua);

}  // namespace afterglow::script

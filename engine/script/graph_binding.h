// SPDX-License-Identifier: MIT
// The userdata `g` and images that `build` functions work with, over a GraphBuilder.
#pragma once

#include "script/graph_builder.h"
#include "script/lua.h"

namespace afterglow::script {

/// Makes the metatables of graphs and images.
void open_graph_binding(lua_State* lua);

void push_graph(lua_State* lua, const GraphBuilder& graph);
void push_image(lua_State* lua, const ImageRef& image);
/// Null when the value is no image.
const ImageRef* to_image(lua_State* lua, int index);

}  // namespace afterglow::script

// SPDX-License-Identifier: MIT
#include "script/graph_binding.h"

#include <fmt/format.h>

#include <cmath>

#include "core/text.h"
#include "script/animated.h"
#include "script/filter_reader.h"
#include "script/graph_calls.h"
#include "script/object.h"
#include "script/runtime.h"
#include "script/table_reader.h"

namespace afterglow::script {
namespace {

struct GraphHandle {
  std::uint64_t build;
};

CallPlace place_of(lua_State* lua) {
  const Sandbox& box = Sandbox::of(lua);
  Error place;
  box.locate(place, box.caller(lua));
  return {std::move(place.file), place.line};
}

std::optional<Size> read_size(TableReader& table, lua_State* lua) {
  table.push("size");
  const ImageRef* image = to_image(lua, -1);
  const Value value = read_value(lua, -1);
  const std::optional<Size> of_image = image ? std::optional(image->size) : std::nullopt;
  lua_pop(lua, 1);
  if (of_image || value.kind == Value::Kind::nothing) return of_image;
  constexpr double kFar = 1e9;  // further checks are the builder's
  const auto whole = [](double v) { return v == std::floor(v) && std::abs(v) <= kFar; };
  if (value.kind != Value::Kind::list || value.count != 2 || !whole(value.list[0]) || !whole(value.list[1])) {
    table.fail(failure(fmt::format("{}: size = {} is no size", table.what(), value.shown()), {"size"},
                       value.kind == Value::Kind::number
                           ? "an image, {width, height} in whole pixels; a uniform takes another name"
                           : "an image, {width, height} in whole pixels"));
    return {};
  }
  return Size{static_cast<int>(value.list[0]), static_cast<int>(value.list[1])};
}

// "g:pass", or with the effect and the name that the script gave.
std::string call_name(lua_State* lua, const GraphBuilder& graph, const char* call, const char* noun = "pass") {
  std::string what = fmt::format("effect '{}': {}", graph.entry().effect, call);
  if (!lua_istable(lua, 2)) return what;
  lua_pushliteral(lua, "name");
  lua_rawget(lua, 2);
  if (lua_type(lua, -1) == LUA_TSTRING)
    what = fmt::format("{} '{}.{}' of effect '{}'", noun, graph.entry().name, tidy_message(lua_tostring(lua, -1), 60),
                       graph.entry().effect);
  lua_pop(lua, 1);
  return what;
}

int graph_pass(lua_State* lua) {
  GraphBuilder& graph = graph_of(lua, "g:pass { … }");
  TableReader table(lua, 2, call_name(lua, graph, "g:pass"));
  PassRequest request;
  request.name = table.text("name", 80);
  request.shader = table.text("shader", 200).value_or("");
  request.by_workgroups = table.text("compute", 200).value_or("");
  request.size = read_size(table, lua);
  request.reach = table.number("reach");
  request.channels = table.number("channels");
  request.precise = table.boolean("precise").value_or(false);
  if (request.shader.empty() && !table.failed())
    table.fail(failure(fmt::format("{} needs 'shader', the name of a shader", table.what())));
  for (const auto& key : table.keys()) {
    if (std::ranges::find(pass_keys(), key.name) != pass_keys().end()) continue;
    if (key.position > 0) {
      table.fail(
          failure(fmt::format("{} has a value without a name at position {}", table.what(), key.position), {key.name}));
      continue;
    }
    table.push(key);
    Argument argument{key.name, {}, {}};
    if (const ImageRef* image = to_image(lua, -1)) {
      argument.image = *image;
    } else {
      argument.value = read_value(lua, -1);
      argument.numbers = read_numbers(lua, -1, kMostElements);
    }
    lua_pop(lua, 1);
    request.arguments.push_back(std::move(argument));
  }
  table.finish("pass");
  push_image(lua, graph.pass(request, place_of(lua)));
  return 1;
}

int graph_filter(lua_State* lua) {
  GraphBuilder& graph = graph_of(lua, "g:filter { … }");
  TableReader table(lua, 2, call_name(lua, graph, "g:filter"));
  table.allow({"channels", "filter", "name", "precise", "size", "source"}, false);
  FilterRequest request;
  request.name = table.text("name", 80);
  request.size = read_size(table, lua);
  request.channels = table.number("channels");
  request.precise = table.boolean("precise").value_or(false);
  table.push("source");
  if (const ImageRef* image = to_image(lua, -1))
    request.source = *image;
  else if (!lua_isnil(lua, -1))
    table.fail(
        failure(fmt::format("{}: source = {} is not an image", table.what(), read_value(lua, -1).shown()), {"source"}));
  lua_pop(lua, 1);
  table.push("filter");
  request.filter = read_filter(lua, table);
  lua_pop(lua, 1);
  table.finish("filter");
  push_image(lua, graph.filter(std::move(request), place_of(lua)));
  return 1;
}

/// `first` of a history: an image, or what every pixel is: up to four numbers, those that are missing 0.
void read_first(lua_State* lua, TableReader& table, HistoryRequest& request) {
  table.push("first");
  const Value value = read_value(lua, -1);
  if (const ImageRef* image = to_image(lua, -1))
    request.first = *image;
  else if (value.kind == Value::Kind::number)
    request.initial[0] = value.number;
  else if (value.kind == Value::Kind::list)
    request.initial = value.list;
  else if (value.kind != Value::Kind::nothing)
    table.fail(failure(fmt::format("{}: first = {} is neither an image nor numbers", table.what(), value.shown()),
                       {"first"}, "an image, a number, 1 to 4 numbers"));
  lua_pop(lua, 1);
}

int graph_history(lua_State* lua) {
  GraphBuilder& graph = graph_of(lua, "g:history { … }");
  TableReader table(lua, 2, call_name(lua, graph, "g:history", "history"));
  table.allow({"channels", "first", "name", "pre_roll", "precise", "size"}, false);
  HistoryRequest request;
  request.name = table.text("name", 80);
  request.size = read_size(table, lua);
  request.channels = table.number("channels");
  request.precise = table.boolean("precise").value_or(true);
  request.pre_roll = table.number("pre_roll");
  read_first(lua, table, request);
  table.finish("history");
  push_image(lua, graph.history(request, place_of(lua)));
  return 1;
}

int graph_keep(lua_State* lua) {
  GraphBuilder& graph = graph_of(lua, "g:keep(history, image)");
  const ImageRef *history = to_image(lua, 2), *next = to_image(lua, 3);
  if (!history || !next)
    throw failure(fmt::format("effect '{}': g:keep: {} is not an image", graph.entry().effect,
                              read_value(lua, history ? 3 : 2).shown()),
                  {}, "g:keep(history, image)");
  graph.keep(*history, *next, place_of(lua));
  return 0;
}

int graph_input(lua_State* lua) {
  GraphBuilder& graph = graph_of(lua, "g:input(\"depth\")");
  const Value name = read_value(lua, 2);
  if (name.kind != Value::Kind::text)
    throw failure(fmt::format("g:input: {} is not the name of an input", name.shown()));
  const auto image = graph.input(name.text);
  if (image)
    push_image(lua, *image);
  else
    lua_pushnil(lua);
  return 1;
}

int graph_skip(lua_State* lua) {
  GraphBuilder& graph = graph_of(lua, "g:skip(\"reason\")");
  const Value reason = read_value(lua, 2);
  if (reason.kind != Value::Kind::text || reason.text.empty())
    throw failure(fmt::format("g:skip: {} is not a reason", reason.shown()), {}, "a text");
  graph.skip(tidy_message(reason.text, 200));
  return 0;
}

int graph_index(lua_State* lua) {
  const GraphBuilder& graph = graph_of(lua, "g.NAME");
  const Value key = read_value(lua, 2);
  const std::string& name = key.text;
  lua_pushvalue(lua, 2);
  if (key.kind == Value::Kind::text && lua_rawget(lua, lua_upvalueindex(1)) != LUA_TNIL) return 1;
  const BuildContext& context = graph.context();
  if (name == "frame")
    push_frame(lua, context.frame);
  else if (name == "time")
    lua_pushnumber(lua, context.time);
  else if (name == "fps")
    lua_pushnumber(lua, context.fps);
  else if (name == "frame_time")
    lua_pushnumber(lua, context.step / context.fps);
  else if (name == "length_scale")
    lua_pushnumber(lua, graph.length_scale());
  else if (name == "preview_scale")
    lua_pushnumber(lua, context.length_scale);
  else {
    const std::vector<std::string> names{
        "cryptomatte", "filter",       "fps",    "frame", "frame_time", "history",       "image", "input",
        "keep",        "length_scale", "lookup", "ocio",  "pass",       "preview_scale", "skip",  "time"};
    throw failure(fmt::format("the graph has no {}", key.shown()), {}, join(names), nearest_name(name, names));
  }
  return 1;
}

int refuse_change(lua_State* lua) {
  const char* what = to_image(lua, 1) ? "an image" : "the graph";
  throw failure(
      fmt::format("{} cannot be changed: {} = {}", what, read_value(lua, 2).text, read_value(lua, 3).shown()));
}

int image_index(lua_State* lua) {
  const ImageRef* image = to_image(lua, 1);
  const Value key = read_value(lua, 2);
  if (image && key.text == "width")
    lua_pushinteger(lua, image->size.width);
  else if (image && key.text == "height")
    lua_pushinteger(lua, image->size.height);
  else {
    const std::vector<std::string> names{"width", "height"};
    throw failure(fmt::format("an image has no {}", key.shown()), {}, join(names), nearest_name(key.text, names));
  }
  return 1;
}

int image_equal(lua_State* lua) {
  const ImageRef *a = to_image(lua, 1), *b = to_image(lua, 2);
  lua_pushboolean(lua, a && b && a->build == b->build && a->id == b->id);
  return 1;
}

}  // namespace

GraphBuilder& graph_of(lua_State* lua, const char* call) {
  const GraphHandle* handle = to_object<GraphHandle>(lua, 1, kGraphKind);
  if (!handle)
    throw failure(fmt::format("the first argument is {}, not the graph", read_value(lua, 1).shown()), {}, call);
  GraphBuilder* graph = Runtime::of(lua).graph;
  if (!graph || graph->build() != handle->build) throw failure("the graph can only be used while its build runs");
  return *graph;
}

void open_graph_binding(lua_State* lua) {
  push_kind(lua, kGraphKind);
  const luaL_Reg methods[] = {
      {"pass", &native<graph_pass, "pass">},          {"filter", &native<graph_filter, "filter">},
      {"history", &native<graph_history, "history">}, {"keep", &native<graph_keep, "keep">},
      {"image", &native<graph_image, "image">},       {"lookup", &native<graph_lookup, "lookup">},
      {"ocio", &native<graph_ocio, "ocio">},          {"input", &native<graph_input, "input">},
      {"skip", &native<graph_skip, "skip">},          {"cryptomatte", &native<graph_cryptomatte, "cryptomatte">}};
  lua_createtable(lua, 0, static_cast<int>(std::size(methods)));
  for (const auto& [name, function] : methods) {
    lua_pushcfunction(lua, function);
    lua_setfield(lua, -2, name);
  }
  lua_pushcclosure(lua, (&native<graph_index, "">), 1);
  lua_setfield(lua, -2, "__index");
  lua_pushcfunction(lua, (&native<refuse_change, "">));
  lua_setfield(lua, -2, "__newindex");
  push_kind(lua, kImageKind);
  lua_pushcfunction(lua, (&native<image_index, "">));
  lua_setfield(lua, -2, "__index");
  lua_pushcfunction(lua, (&native<refuse_change, "">));
  lua_setfield(lua, -2, "__newindex");
  lua_pushcfunction(lua, (&native<image_equal, "">));
  lua_setfield(lua, -2, "__eq");
  lua_pop(lua, 2);
}

void push_graph(lua_State* lua, const GraphBuilder& graph) { push_object(lua, kGraphKind, GraphHandle{graph.build()}); }

void push_image(lua_State* lua, const ImageRef& image) { push_object(lua, kImageKind, image); }

const ImageRef* to_image(lua_State* lua, int index) { return to_object<ImageRef>(lua, index, kImageKind); }

}  // namespace afterglow::script

// SPDX-License-Identifier: MIT
#include "script/graph_binding.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <map>

#include "core/file.h"
#include "core/inside.h"
#include "core/pack.h"
#include "core/text.h"
#include "image/cryptomatte.h"
#include "script/filter_reader.h"
#include "script/object.h"
#include "script/ocio.h"
#include "script/runtime.h"
#include "script/table_reader.h"

namespace afterglow::script {
namespace {

struct GraphHandle {
  std::uint64_t build;
};

// The builder behind argument 1. `call` is how it should have been written.
GraphBuilder& graph_of(lua_State* lua, const char* call) {
  const GraphHandle* handle = to_object<GraphHandle>(lua, 1, kGraphKind);
  if (!handle)
    throw failure(fmt::format("the first argument is {}, not the graph", read_value(lua, 1).shown()), {}, call);
  GraphBuilder* graph = Runtime::of(lua).graph;
  if (!graph || graph->build() != handle->build) throw failure("the graph can only be used while its build runs");
  return *graph;
}

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
    if (const ImageRef* image = to_image(lua, -1))
      argument.image = *image;
    else
      argument.value = read_value(lua, -1);
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

// The file that g:lookup and g:image are given; a failure at the key of the call.
std::filesystem::path read_file_key(lua_State* lua, TableReader& table, const char* function) {
  const auto name = table.text("file");
  if ((!name || name->empty()) && !table.failed())
    table.fail(failure(fmt::format("{} needs 'file', the name of a file", table.what()), {"file"}));
  table.finish(function);
  return find_asset(lua, table.what(), *name);
}

int graph_lookup(lua_State* lua) {
  GraphBuilder& graph = graph_of(lua, "g:lookup { file = … }");
  TableReader table(lua, 2, fmt::format("effect '{}': g:lookup", graph.entry().effect));
  table.allow({"correction", "file"}, false);
  const auto correction = table.text("correction");
  const auto file = read_file_key(lua, table, "lookup");
  const LoadedLut& loaded = load_lut(lua, file, correction.value_or(""));
  lua_createtable(lua, 0, 3);
  lua_pushboolean(lua, loaded.unit);
  lua_setfield(lua, -2, "unit");
  push_image(lua, graph.data(file.filename().string(), loaded.table));
  lua_setfield(lua, -2, "table");
  lua_createtable(lua, static_cast<int>(loaded.steps.size()), 0);
  for (std::size_t i = 0; i < loaded.steps.size(); ++i) {
    const LutStep& step = loaded.steps[i];
    lua_createtable(lua, 0, 3);
    const std::pair<const char*, int> fields[] = {
        {"kind", static_cast<int>(step.kind)}, {"row", step.row}, {"size", step.size}};
    for (const auto& [name, value] : fields) {
      lua_pushinteger(lua, value);
      lua_setfield(lua, -2, name);
    }
    lua_rawseti(lua, -2, static_cast<lua_Integer>(i) + 1);
  }
  lua_setfield(lua, -2, "steps");
  return 1;
}

// { shader = name, table = image or nil }: the pass is the effect's.
int graph_ocio(lua_State* lua) {
  GraphBuilder& graph = graph_of(lua, "g:ocio { config = … }");
  TableReader table(lua, 2, fmt::format("effect '{}': g:ocio", graph.entry().effect));
  table.allow({"config", "display", "from", "inverse", "looks", "to", "view"}, false);
  const auto text = [&](const char* key) { return table.text(key).value_or(""); };
  const auto to = table.text("to");
  OcioRequest request{.config = {},
                      .from = text("from"),
                      .display = text("display"),
                      .view = text("view"),
                      .to = to.value_or(""),
                      .to_space = to.has_value(),
                      .looks = text("looks"),
                      .inverse = table.boolean("inverse").value_or(false)};
  const std::string config = text("config");
  table.finish("ocio");
  const LoadedOcio& loaded = load_ocio(lua, table.what(), config, std::move(request));
  lua_createtable(lua, 0, 2);
  lua_pushlstring(lua, loaded.shader.data(), loaded.shader.size());
  lua_setfield(lua, -2, "shader");
  if (loaded.table) {
    push_image(lua, graph.data(loaded.config.filename().string(), loaded.table));
    lua_setfield(lua, -2, "table");
  }
  return 1;
}

int graph_image(lua_State* lua) {
  GraphBuilder& graph = graph_of(lua, "g:image { file = … }");
  TableReader table(lua, 2, fmt::format("effect '{}': g:image", graph.entry().effect));
  table.allow({"alpha", "file", "raw"}, false);
  const bool alpha = table.boolean("alpha").value_or(false), raw = table.boolean("raw").value_or(false);
  const auto file = read_file_key(lua, table, "image");
  auto picture = load_picture(lua, file, raw);
  if (alpha && picture->opaque)
    Runtime::of(lua).box->diagnostics->warn_once(
        "no alpha " + file.string(),
        fmt::format("effect '{}': {} has no alpha; it counts as 1 everywhere", graph.entry().name, file.string()));
  push_image(lua, graph.data(file.filename().string(), std::move(picture)));
  return 1;
}

// The manifest of a cryptomatte in a file beside the picture; what cannot be read is warned about.
std::map<std::string, std::uint32_t> manifest_beside(lua_State* lua, const std::filesystem::path& picture,
                                                     const Cryptomatte& cryptomatte) {
  constexpr std::size_t kMost = 64u << 20;  // bytes
  if (cryptomatte.manifest_file.empty() || picture.empty()) return {};
  const auto warn = [&](const std::string& why) {
    Runtime::of(lua).box->diagnostics->warn_once(
        "manifest " + cryptomatte.layer,
        fmt::format("{}: the manifest '{}' of the cryptomatte '{}' {}; ids are made of "
                    "the names themselves",
                    picture.string(), tidy_message(cryptomatte.manifest_file, 100), cryptomatte.layer, why));
    return std::map<std::string, std::uint32_t>();
  };
  const std::filesystem::path folder = picture.has_parent_path() ? picture.parent_path() : ".";
  const std::filesystem::path file = folder / cryptomatte.manifest_file;
  if (!is_safe_entry(cryptomatte.manifest_file, 8) || !lies_in(file, folder)) return warn("lies outside of its folder");
  Runtime::of(lua).depends.beside.insert(file);
  FileRecord* record = Runtime::of(lua).path.record.get();
  if (!is_file(file, record)) return warn("is not there");
  const auto text = read_file(file, kMost, record);
  if (!text) return warn("cannot be read");
  auto manifest = read_manifest(*text, cryptomatte.layer);
  if (!manifest) throw failure(manifest.error().message);
  return std::move(*manifest);
}

// The ids of the objects that a cryptomatte's names stand for, as floats. Names that the picture's manifest lacks are
// warned about: they cover nothing. So are those that a picture without one has not, once its pixels are there.
int graph_cryptomatte(lua_State* lua) {
  constexpr std::size_t kMost = 8;
  GraphBuilder& graph = graph_of(lua, "g:cryptomatte { layer = …, names = … }");
  TableReader table(lua, 2, fmt::format("effect '{}': g:cryptomatte", graph.entry().effect));
  table.allow({"layer", "names"}, false);
  const std::string layer = table.text("layer").value_or(""), names = table.text("names").value_or("");
  table.finish("cryptomatte");
  const BuildContext& context = graph.context();
  std::map<std::string, std::uint32_t> manifest;
  for (const auto& [metadata, file] :
       {std::pair(context.metadata, context.picture), {context.matte_metadata, context.mattes}}) {
    if (!metadata) continue;
    auto found = find_cryptomatte(*metadata, layer);
    if (!found) throw failure(found.error().message);
    if (!*found) continue;
    const Sandbox::Pause pause(*Runtime::of(lua).box);
    manifest = (*found)->manifest.empty() ? manifest_beside(lua, file, **found) : std::move((*found)->manifest);
    break;
  }
  std::vector<std::string> known;
  for (const auto& [name, id] : manifest) known.push_back(name);
  lua_createtable(lua, kMost, 0);
  int count = 0;
  for (const auto& name : cryptomatte_names(names)) {
    if (count == static_cast<int>(kMost))
      throw failure(fmt::format("effect '{}': more than {} names of a cryptomatte", graph.entry().effect, kMost), {},
                    "further ones in a second mask, added by +");
    const auto given = manifest.find(name);
    if (given == manifest.end() && !manifest.empty()) {
      const std::string nearest = nearest_name(name, known);
      Runtime::of(lua).box->diagnostics->warn_once(
          "cryptomatte " + layer + " " + name,
          fmt::format("effect '{}': the cryptomatte '{}' has no '{}'{}", graph.entry().name, layer,
                      tidy_message(name, 100), nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
      continue;
    }
    const std::uint32_t id = given == manifest.end() ? cryptomatte_id(name) : given->second;
    if (given == manifest.end()) Runtime::of(lua).depends.objects.push_back({layer, name, id});
    lua_pushnumber(lua, std::bit_cast<float>(id));
    lua_rawseti(lua, -2, ++count);
  }
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
    lua_pushnumber(lua, context.frame);
  else if (name == "time")
    lua_pushnumber(lua, context.time);
  else if (name == "fps")
    lua_pushnumber(lua, context.fps);
  else if (name == "frame_time")
    lua_pushnumber(lua, context.step / context.fps);
  else if (name == "length_scale")
    lua_pushnumber(lua, graph.length_scale());
  else {
    const std::vector<std::string> names{"cryptomatte", "filter", "fps",   "frame", "frame_time",
                                         "history",     "image",  "input", "keep",  "length_scale",
                                         "lookup",      "ocio",   "pass",  "skip",  "time"};
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

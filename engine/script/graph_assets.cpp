// SPDX-License-Identifier: MIT
// g:image, g:lookup and g:ocio: images that a look brings along.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "core/text.h"
#include "script/assets.h"
#include "script/graph_binding.h"
#include "script/graph_calls.h"
#include "script/ocio.h"
#include "script/runtime.h"
#include "script/table_reader.h"

namespace afterglow::script {
namespace {

// The file that g:lookup and g:image are given; a failure at the key of the call.
std::filesystem::path read_file_key(lua_State* lua, TableReader& table, const char* function) {
  const auto name = table.text("file");
  if ((!name || name->empty()) && !table.failed())
    table.fail(failure(fmt::format("{} needs 'file', the name of a file", table.what()), {"file"}));
  table.finish(function);
  return find_asset(lua, table.what(), *name);
}

// One of `pixels`: a number is grey; of a list what is missing is 0, of alpha 1.
std::array<float, 4> pixel_of(TableReader& table, const Value& value, std::size_t number) {
  std::array<float, 4> pixel{0, 0, 0, 1};
  const auto put = [&](std::size_t channel, double wanted) {
    pixel[channel] = static_cast<float>(wanted);
    if (!std::isfinite(pixel[channel]))
      table.fail(failure(fmt::format("{}: pixel {} is not finite", table.what(), number), {"pixels"}));
  };
  if (value.kind == Value::Kind::number) {
    for (std::size_t c = 0; c < 3; ++c) put(c, value.number);
  } else if (value.kind == Value::Kind::list) {
    for (int c = 0; c < value.count; ++c) put(static_cast<std::size_t>(c), value.list[static_cast<std::size_t>(c)]);
  } else {
    table.fail(failure(fmt::format("{}: pixel {} is {}", table.what(), number, value.shown()), {"pixels"},
                       "a number, 1 to 4 numbers"));
  }
  return pixel;
}

// The image of g:image { pixels = …, width = … }; throws.
std::shared_ptr<const ImageData> pixels_of(lua_State* lua, TableReader& table) {
  constexpr std::size_t kMost = 65536, kLongestRow = 8192;
  constexpr std::uint64_t kCost = 16;  // instructions that a pixel counts as: it lives outside of Lua's memory
  const auto fail = [&](const char* key, const std::string& why, const std::string& allowed) {
    table.fail(failure(fmt::format("{}: {}", table.what(), why), {key}, allowed));
    table.finish("image");
  };
  for (const char* key : {"alpha", "file", "raw"})
    if (table.value(key).kind != Value::Kind::nothing)
      fail(key, fmt::format("'{}' does not go with 'pixels'", key), "pixels, width");
  table.push("pixels");
  const std::size_t count = lua_istable(lua, -1) ? lua_rawlen(lua, -1) : 0;
  if (count == 0 || count > kMost)
    fail("pixels", fmt::format("pixels = {} with {} pixels", read_value(lua, -1).shown(), count),
         fmt::format("a list of 1 to {} pixels", kMost));
  const std::size_t width =
      static_cast<std::size_t>(std::clamp(table.integer("width").value_or(static_cast<int>(count)), 0, 1 << 20));
  if (!table.failed() && (width == 0 || count % width != 0 || width > kLongestRow || count / width > kLongestRow))
    fail("width", fmt::format("{} pixels are no whole rows of {}", count, width),
         fmt::format("a width that divides their number; sides up to {}", kLongestRow));
  Sandbox::of(lua).charge(count * kCost);
  std::vector<float> pixels;
  pixels.reserve(count * 4);
  for (std::size_t i = 1; i <= count && !table.failed(); ++i) {
    lua_rawgeti(lua, -1, static_cast<lua_Integer>(i));
    const auto pixel = pixel_of(table, read_value(lua, -1), i);
    pixels.insert(pixels.end(), pixel.begin(), pixel.end());
    lua_pop(lua, 1);
  }
  lua_pop(lua, 1);
  table.finish("image");
  return make_data({static_cast<int>(width), static_cast<int>(count / width)}, std::move(pixels), {});
}

}  // namespace

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
  table.allow({"alpha", "file", "pixels", "raw", "width"}, false);
  table.push("pixels");
  const bool given = !lua_isnil(lua, -1);
  lua_pop(lua, 1);
  if (given) {
    push_image(lua, graph.data("pixels", pixels_of(lua, table)));
    return 1;
  }
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

}  // namespace afterglow::script

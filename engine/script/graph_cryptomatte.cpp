// SPDX-License-Identifier: MIT
// g:cryptomatte: ids of objects by their names.
#include <fmt/format.h>

#include <bit>
#include <map>
#include <utility>
#include <vector>

#include "core/file.h"
#include "core/inside.h"
#include "core/near_path.h"
#include "core/text.h"
#include "image/cryptomatte.h"
#include "script/graph_calls.h"
#include "script/runtime.h"
#include "script/table_reader.h"

namespace afterglow::script {
namespace {

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
  if (!is_tidy_path(cryptomatte.manifest_file) || !lies_in(file, folder)) return warn("lies outside of its folder");
  Runtime::of(lua).depends.beside.insert(file);
  FileRecord* record = Runtime::of(lua).path.record.get();
  if (!is_file(file, record)) return warn("is not there");
  const auto text = read_file(file, kMost, record);
  if (!text) return warn("cannot be read");
  auto manifest = read_manifest(*text, cryptomatte.layer);
  if (!manifest) throw failure(manifest.error().message);
  return std::move(*manifest);
}

}  // namespace

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

}  // namespace afterglow::script

// SPDX-License-Identifier: MIT
#include "script/ocio.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "core/environment.h"
#include "core/file.h"
#include "core/file_record.h"
#include "core/made_shaders.h"
#include "core/text.h"
#include "script/graph_builder.h"
#include "script/native.h"
#include "script/ocio_variables.h"
#include "script/runtime.h"

namespace afterglow::script {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kConfigCost = 1'000'000;                      // instructions that a configuration counts as
constexpr std::size_t kMaxConfig = 16u << 20, kMaxTable = 64u << 20;  // bytes

/// The file that is meant, and whether scripts chose it.
struct ChosenConfig {
  fs::path file;
  bool by_script = false;
  std::string name;  ///< as Dependencies::files has it
};

ChosenConfig choose_config(lua_State* lua, const std::string& what, const std::string& name) {
  if (!name.empty()) {
    const bool by_command = is_given_by_command(Runtime::of(lua), name);
    return {find_asset(lua, what, name), !by_command, by_command ? "" : name};
  }
  const char* named = std::getenv("OCIO");
  constexpr const char* kAllowed = "config = \"NAME.ocio\", a file beside the preset or on the search path";
  if (!named || !*named)
    fail_at(lua, what,
            {"config",
             "",
             "there is no configuration of OpenColorIO: none is given, and the variable OCIO of the "
             "environment is not set",
             kAllowed,
             {}});
  std::error_code ec;
  const fs::path file = fs::absolute(named, ec);
  if (!is_file(file, Runtime::of(lua).path.record.get()))
    fail_at(lua, what,
            {"config",
             "",
             fmt::format("the variable OCIO of the environment names {}, and there is no such file",
                         tidy_message(named, 200)),
             kAllowed,
             {}});
  return {file, false, kOcioVariable};
}

/// Where the configuration's text names it; 0: nowhere in so many words.
int line_of(const std::string& text, const std::string& name) {
  const auto at = text.find(name);
  return at == std::string::npos
             ? 0
             : 1 + static_cast<int>(std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n'));
}

/// A table may be read, and is what it seems to be.
void check_table(Runtime& runtime, const ChosenConfig& config, const std::string& text, const OcioSurvey::File& table) {
  const auto fail = [&](std::string why, std::string nearest = {}) {
    throw ScriptError{{ErrorKind::script,
                       fmt::format("'{}': {}", tidy_message(table.name, 100), why),
                       config.file.string(),
                       line_of(text, table.name),
                       {},
                       std::move(nearest)}};
  };
  // First of all: nothing is told of what lies outside, not even whether it is there.
  if (config.by_script && !may_read(runtime, table.path))
    fail(fmt::format("{} lies outside of the folders that scripts may read", table.path.string()));
  for (const fs::path& place : table.elsewhere)  // one that appears there is noticed
    if (!config.by_script || may_read(runtime, place)) is_file(place, runtime.path.record.get());
  const bool there = is_file(table.path, runtime.path.record.get());
  if (!there && table.optional) return;
  if (!there)
    fail(fmt::format("there is no such file along the search path of the configuration, like {}", table.path.string()),
         nearest_name(table.path.filename().string(), names_in(table.path.parent_path())));
  const auto content = read_file(table.path, kMaxTable, runtime.path.record.get());
  if (!content) fail(content.error().message);
  if (auto sound = check_table(*content, table.path, TableUse::of_config); !sound) throw ScriptError{sound.error()};
}

/// The request in words that are the same on every machine.
std::string request_text(const OcioRequest& request) {
  std::string text = request.config.filename().string();
  for (const auto& [what, name] :
       {std::pair("from", &request.from), std::pair("display", &request.display), std::pair("view", &request.view),
        std::pair("to", &request.to), std::pair("looks", &request.looks)})
    if (!name->empty()) text += fmt::format(", {} {}", what, *name);
  if (request.to_space && request.to.empty()) text += ", to the working space";
  return request.inverse ? text + ", inverse" : text;
}

Dependencies dependencies(const ChosenConfig& config, const std::string& text, const OcioSurvey& survey) {
  Dependencies out;
  out.files.emplace(config.file, config.name);
  for (const auto& table : survey.files)
    if (!table.optional) out.files.emplace(table.path, "");
  for (const auto& name : ocio_variables(text)) out.environment.emplace(name, environment(name));
  return out;
}

/// All that decides what becomes of a request.
Hash store_key(const Runtime& runtime, const std::string& request, const std::string& config, const OcioSurvey& survey,
               const Dependencies& depends) {
  Hasher hasher;
  hasher.add("ocio").add(request).add(hash_text(config).hex());
  for (const auto& table : survey.files) {
    const auto seen = content_seen(runtime, table.path, kMaxTable);
    hasher.add(table.path.string()).add(seen ? seen->hex() : "");
  }
  for (const auto& [name, value] : depends.environment) hasher.add(name).add(value);
  return hasher.finish();
}

}  // namespace

const LoadedOcio& load_ocio(lua_State* lua, const std::string& what, const std::string& name, OcioRequest request) {
  Runtime& runtime = Runtime::of(lua);
  const ChosenConfig config = choose_config(lua, what, name);
  request.config = config.file;
  const std::string key =
      fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}", config.file.string(), request.from, request.display, request.view,
                  request.to_space, request.to, request.looks, request.inverse);
  const auto known = runtime.assets.ocio.find(key);
  if (known != runtime.assets.ocio.end()) {
    runtime.depends.add(known->second->depends);
    return *known->second;
  }
  runtime.box->charge(kConfigCost);
  const Sandbox::Pause pause(*runtime.box);
  const auto text = read_file(config.file, kMaxConfig, runtime.path.record.get());
  if (!text) throw ScriptError{{ErrorKind::script, text.error().message, config.file.string()}};
  const auto survey = survey_ocio(request);
  if (!survey) throw ScriptError{survey.error()};
  if (const auto& fault = survey->fault) {
    const std::map<std::string, std::string> given{{"from", request.from},
                                                   {"to", request.to},
                                                   {"display", request.display},
                                                   {"view", request.view},
                                                   {"looks", request.looks}};
    const auto value = given.find(fault->key);
    fail_at(lua, what,
            {fault->key, value == given.end() ? "" : value->second,
             fmt::format("{} ({})", fault->what, config.file.filename().string()), fault->allowed, fault->nearest});
  }
  for (const auto& table : survey->files) check_table(runtime, config, *text, table);
  Dependencies depends = dependencies(config, *text, *survey);
  const Hash stored = store_key(runtime, key, *text, *survey, depends);
  auto loaded = runtime.assets.store->get<LoadedOcio>(stored, look_of(runtime), [&] {
    auto made = ocio_shader(request);
    if (!made) throw ScriptError{std::move(made).error()};
    std::string shader = "ocio/" + hash_text(made->text).hex();
    std::shared_ptr<const ImageData> table;
    if (!made->table.empty()) table = make_data(made->size, std::move(made->table), config.file);
    depends.generated[request_text(request)] = Hasher().add(made->text).add(table ? table->hash.hex() : "").finish();
    return std::make_shared<const LoadedOcio>(
        LoadedOcio{std::move(shader), std::move(made->text), std::move(table), config.file, std::move(depends)});
  });
  count_data(runtime, loaded->table.get());
  runtime.depends.add(loaded->depends);
  runtime.path.made->add(loaded->shader, {loaded->text, config.file});
  return *runtime.assets.ocio.emplace(key, std::move(loaded)).first->second;
}

}  // namespace afterglow::script

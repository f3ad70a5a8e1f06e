// SPDX-License-Identifier: MIT
#include "script/arguments.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "script/declare.h"
#include "script/object.h"
#include "script/overrides.h"
#include "script/runtime.h"
#include "script/setting.h"
#include "script/table_reader.h"

namespace afterglow {

Result<ArgumentValue> parse_argument(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string name = trim(text.substr(0, equals));
  if (equals == std::string::npos || !script::is_identifier(name))
    return Error{ErrorKind::usage, fmt::format("--arg '{}' gives no argument", tidy_message(text, 100)), "", 0,
                 "NAME=VALUE"};
  return ArgumentValue{name, text.substr(equals + 1)};
}

namespace script {
namespace {

constexpr std::size_t kMaxArguments = 256;

/// `given` is one of Runtime::given_arguments.
void fail_or_leave_out(const Runtime& runtime, const ArgumentValue& given, const Error& error) {
  const auto& all = runtime.given_arguments;
  const bool must_fit =
      all.data() + all.size() - &given <= static_cast<std::ptrdiff_t>(runtime.arguments_that_must_fit);
  if (!runtime.leave_out_unfit || must_fit || !runtime.box->diagnostics) throw ScriptError{error};
  warn_left_out(*runtime.box->diagnostics, error);
}

// An argument that several scripts of a preset declare (one that extends another) is one, with one type.
const PresetArgument& argument_of(Runtime& runtime, SettingSchema schema) {
  const auto known = std::ranges::find(runtime.arguments, schema.name,
                                       [](const PresetArgument& argument) { return argument.schema.name; });
  if (known != runtime.arguments.end()) {
    if (known->schema.type == schema.type && known->schema.choices == schema.choices) return *known;
    throw failure(fmt::format("fx.args: '{}' is declared twice, as {} and as {}", schema.name,
                              type_name(known->schema.type), type_name(schema.type)),
                  {schema.name});
  }
  if (runtime.arguments.size() >= kMaxArguments) throw failure(fmt::format("more than {} arguments", kMaxArguments));
  PresetArgument argument{.schema = std::move(schema), .value = {}, .given = false};
  argument.value = argument.schema.default_value;
  for (const auto& given : runtime.given_arguments) {
    if (given.name != argument.schema.name) continue;
    auto value = parse_value_of(given.value, argument.schema, "--arg " + given.name);
    if (!value) {
      fail_or_leave_out(runtime, given, value.error());
      continue;
    }
    argument.value = *value;
    argument.given = true;
  }
  runtime.arguments.push_back(std::move(argument));
  return runtime.arguments.back();
}

}  // namespace

int declare_arguments(lua_State* lua) {
  Runtime& runtime = Runtime::of(lua);
  if (!runtime.declaring) throw failure("fx.args can only be used while a script loads");
  TableReader table(lua, 1, "fx.args");
  std::vector<SettingSchema> declared = read_setting_types(lua, table, {});
  table.finish("args");
  lua_createtable(lua, 0, static_cast<int>(declared.size()));
  for (auto& schema : declared) {
    const std::string name = schema.name;
    push_setting(lua, argument_of(runtime, std::move(schema)).value);
    lua_setfield(lua, -2, name.c_str());
  }
  return 1;
}

void check_arguments(const Runtime& runtime) {
  std::vector<std::string> names;
  for (const auto& argument : runtime.arguments) names.push_back(argument.schema.name);
  for (const auto& given : runtime.given_arguments) {
    if (std::ranges::find(names, given.name) != names.end()) continue;
    const std::string what =
        names.empty() ? "the preset declares no arguments (fx.args)" : "the preset declares no argument of this name";
    fail_or_leave_out(runtime, given,
                      {ErrorKind::usage, fmt::format("--arg {}: {}", given.name, what), "", 0, join(names),
                       nearest_name(given.name, names)});
  }
}

}  // namespace script
}  // namespace afterglow

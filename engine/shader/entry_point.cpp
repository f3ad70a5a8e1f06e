// SPDX-License-Identifier: MIT
#include "shader/entry_point.h"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

namespace afterglow {
namespace {

struct Argument {
  const Token* type = nullptr;
  const Token* name = nullptr;
};

Result<std::vector<Argument>> split_arguments(std::span<const Token* const> tokens, const Token& function,
                                              const std::string& file) {
  const auto fail = [&](const Token& token, const char* message) { return shader_error(file, token.line, message); };
  std::vector<Argument> list;
  if (tokens.empty() || (tokens.size() == 1 && tokens[0]->is("void"))) return list;
  Argument argument;
  const auto finish = [&](const Token& at) -> Result<void> {
    if (!argument.type || !argument.name) return fail(at, "every argument needs a type and a name");
    list.push_back(std::exchange(argument, {}));
    return {};
  };
  for (const Token* token : tokens) {
    if (token->is(",")) {
      AFTERGLOW_CHECK(finish(*token));
      continue;
    }
    if (token->is("out") || token->is("inout"))
      return fail(*token, "arguments are read only: 'out' and 'inout' are not allowed here");
    if (token->is("in") || token->is("const") || token->is("highp") || token->is("mediump") || token->is("lowp"))
      continue;
    if (!token->is_identifier() || argument.name) return fail(*token, "an argument is written TYPE NAME");
    (argument.type ? argument.name : argument.type) = token;
  }
  AFTERGLOW_CHECK(finish(function));
  return list;
}

}  // namespace

Result<EntryPoint> parse_entry_point(PassKind kind, const Token& result, const Token& name,
                                     std::span<const Token* const> arguments, const std::string& file) {
  const auto wrong = [&](const Token& where, std::string what) {
    Error error = shader_error(file, where.line, std::move(what));
    error.allowed = info_of(kind).signature;
    return error;
  };
  if (!result.is("vec4")) return wrong(name, fmt::format("{} must return vec4, not {}", name.text, result.text));
  AFTERGLOW_TRY(const auto list, split_arguments(arguments, name, file));
  EntryPoint out;
  if (kind != PassKind::pixel) {
    if (list.size() != 1 || !list[0].type->is("ivec2"))
      return wrong(name, fmt::format("{} takes one argument, the target's pixel", name.text));
    return out;
  }
  if (list.empty()) return wrong(name, "apply takes the colour as its first argument");
  out.at_pixel = list.size() > 1 && list.back().type->is("ivec2");
  const std::size_t colors = list.size() - (out.at_pixel ? 1 : 0);
  for (std::size_t i = 0; i < colors; ++i)
    if (!list[i].type->is("vec4"))
      return wrong(*list[i].type, fmt::format("argument '{}' of apply must be a vec4", list[i].name->text));
  for (std::size_t i = 1; i < colors; ++i) out.inputs.push_back(*list[i].name);
  return out;
}

Result<void> check_done_function(const Token& result, const Token& name, std::span<const Token* const> arguments,
                                 const std::string& file) {
  constexpr std::array<std::string_view, 6> kWanted{"ivec2", "", ",", "out", "vec4", ""};  // "": any name
  bool fits = result.is("bool") && arguments.size() == kWanted.size();
  for (std::size_t i = 0; fits && i < kWanted.size(); ++i)
    fits = kWanted[i].empty() ? arguments[i]->is_identifier() : arguments[i]->is(kWanted[i]);
  if (fits) return {};
  Error error = shader_error(file, name.line, fmt::format("{} has other arguments or another result", kDoneFunction));
  error.allowed = kDoneSignature;
  return error;
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "shader/declared.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace afterglow {
namespace {

constexpr std::array<std::string_view, 4> kQualifiers = {"highp", "mediump", "lowp", "precise"};
/// Words that begin statements and may have a name behind them.
constexpr std::array<std::string_view, 14> kStatements = {"return",   "if",      "else",  "for",     "while",
                                                          "do",       "switch",  "case",  "default", "break",
                                                          "continue", "discard", "const", "struct"};

template <std::size_t kCount>
bool is_any(const Token& token, const std::array<std::string_view, kCount>& words) {
  return std::ranges::any_of(words, [&](std::string_view word) { return token.is(word); });
}

using Tokens = std::span<const Token* const>;

void skip_sizes(Tokens tokens, std::size_t& at) {
  while (at < tokens.size() && tokens[at]->is("[")) at = after_closing(tokens, at);
}

/// Takes out names from the `first` on that stand among the tokens: they may get their value there.
void remove_named(Tokens tokens, std::size_t first, std::vector<Unset>& out) {
  const auto is_there = [&](const Unset& unset) {
    return std::ranges::any_of(tokens, [&](const Token* token) { return token->is(unset.name); });
  };
  out.erase(std::remove_if(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(), is_there), out.end());
}

/// Adds the names without a value of `NAME [..], NAME = …, NAME;`, from the first name on. Returns the position behind
/// the semicolon, where their marks will stand: those that a value of the same declaration reads or gives (`float y, x
/// = f(y);`) are left out.
std::size_t declarators(Tokens tokens, std::size_t at, std::vector<Unset>& out) {
  const std::size_t first = out.size();
  while (at < tokens.size() && tokens[at]->is_identifier()) {
    const Token& name = *tokens[at++];
    skip_sizes(tokens, at);
    if (at < tokens.size() && tokens[at]->is("=")) {
      const std::size_t value = at;
      while (at < tokens.size() && !tokens[at]->is(",") && !tokens[at]->is(";"))
        at = opens(*tokens[at]) ? after_closing(tokens, at) : at + 1;
      remove_named(tokens.subspan(value, at - value), first, out);
    } else {
      out.push_back({std::string(name.text), name.line});
    }
    if (at >= tokens.size() || !tokens[at]->is(",")) break;
    ++at;
  }
  if (at >= tokens.size() || !tokens[at]->is(";")) {
    out.resize(first);  // no declaration after all
    return at;
  }
  for (std::size_t i = first; i < out.size(); ++i) out[i].at = tokens[at]->end();
  return at + 1;
}

/// The declaration that begins at `at`, if there is one. Returns the position behind it, or `at`.
std::size_t declaration(Tokens tokens, std::size_t at, std::vector<Unset>& out) {
  std::size_t next = at;
  while (next < tokens.size() && is_any(*tokens[next], kQualifiers)) ++next;
  if (next < tokens.size() && tokens[next]->is("struct")) {
    while (next < tokens.size() && !tokens[next]->is("{")) ++next;
    next = after_closing(tokens, next);
    return next < tokens.size() && tokens[next]->is_identifier() ? declarators(tokens, next, out) : next;
  }
  if (next >= tokens.size() || !tokens[next]->is_identifier() || is_any(*tokens[next], kStatements)) return at;
  ++next;
  skip_sizes(tokens, next);
  if (next + 1 >= tokens.size() || !tokens[next]->is_identifier()) return at;
  const Token& behind = *tokens[next + 1];
  const bool declares = behind.is(";") || behind.is(",") || behind.is("[") || behind.is("=");
  return declares ? declarators(tokens, next, out) : at;
}

void out_arguments(Tokens tokens, std::size_t at, std::vector<Unset>& out) {
  bool is_out = false;
  const Token* name = nullptr;
  int depth = 0;
  const auto end = [&] {
    if (is_out && name) out.push_back({std::string(name->text), name->line, Unset::Kind::argument, at});
    is_out = false;
    name = nullptr;
  };
  for (const Token* token : tokens) {
    if (opens(*token)) ++depth;
    if (closes(*token)) --depth;
    if (depth > 0 || token->is("]")) continue;
    if (token->is(",")) {
      end();
    } else if (token->is("out")) {
      is_out = true;
    } else if (token->is_identifier()) {
      name = token;
    }
  }
  end();
}

/// `body`: from the first brace to the last.
bool ends_with_return(Tokens body) {
  if (body.size() < 3 || !body[body.size() - 2]->is(";")) return false;
  std::size_t begin = body.size() - 2;
  for (int depth = 0; begin > 1; --begin) {
    const Token& before = *body[begin - 1];
    if (depth == 0 && (before.is(";") || before.is("{") || before.is("}"))) break;
    if (closes(before)) ++depth;
    if (opens(before)) --depth;
  }
  return body[begin]->is("return");
}

}  // namespace

void find_unset_result(const Token& type, const Token& name, Tokens body, std::vector<Unset>& out) {
  if (!type.is_identifier() || type.is("void") || body.size() < 2 || ends_with_return(body)) return;
  // A statement that has no end: the compiler says so of what the author wrote.
  const Token& last = *body[body.size() - 2];
  if (!last.is(";") && !last.is("{") && !last.is("}")) return;
  out.push_back({std::string(name.text), name.line, Unset::Kind::result, body.back()->offset, std::string(type.text)});
}

void find_unset(Tokens arguments, Tokens body, std::vector<Unset>& out) {
  if (body.empty()) return;
  out_arguments(arguments, body.front()->end(), out);
  for (std::size_t at = 1; at < body.size();) {
    const Token& before = *body[at - 1];
    const bool begins = before.is("{") || before.is("}") || before.is(";") || before.is(":");
    const std::size_t next = begins ? declaration(body, at, out) : at;
    if (next > at)
      at = next;
    else if (body[at]->is("("))
      at = after_closing(body, at);
    else
      ++at;
  }
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
// GLSL text cut into tokens: enough to find declarations and to rename identifiers, without a compiler. Internal to the
// room.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/result.h"

namespace afterglow {

enum class TokenKind { identifier, number, punctuation, quoted };

struct Token {
  TokenKind kind = TokenKind::punctuation;
  std::string_view text;   ///< a view of the scanned text; punctuation is one character, quoted is without its quotes
  std::size_t offset = 0;  ///< of the first character in the text
  int line = 1;            ///< 1-based
  int directive = -1;      ///< number of the preprocessor line it belongs to (the first token of which is '#'), or -1

  bool is(std::string_view other) const { return text == other && kind != TokenKind::quoted; }
  bool is_identifier() const { return kind == TokenKind::identifier; }
  std::size_t end() const { return offset + text.size(); }
};

/// Of brackets.
inline bool opens(const Token& token) { return token.is("(") || token.is("[") || token.is("{"); }
inline bool closes(const Token& token) { return token.is(")") || token.is("]") || token.is("}"); }

/// Position behind the bracket that closes the one at `at`, among tokens or pointers to them. `tokenize` has checked
/// the balance.
template <typename Tokens>
std::size_t after_closing(const Tokens& tokens, std::size_t at) {
  const auto token = [&](std::size_t i) -> const Token& {
    if constexpr (std::is_pointer_v<typename Tokens::value_type>)
      return *tokens[i];
    else
      return tokens[i];
  };
  int depth = 0;
  for (; at < tokens.size(); ++at) {
    if (opens(token(at))) ++depth;
    if (closes(token(at)) && --depth == 0) return at + 1;
  }
  return at;
}

/// What authors may write at most. The compiler recurses over the text, so nesting is what could crash it.
inline constexpr std::size_t kMaxShaderBytes = 256u << 10;  ///< one file
inline constexpr std::size_t kMaxTokens = 64u << 10;        ///< one file
inline constexpr int kMaxNesting = 64;                      ///< of (), [] and {} together
inline constexpr int kMaxStatementTokens = 8192;            ///< between semicolons and braces
inline constexpr int kMaxChain = 64;  ///< `else if` in a row; control words without braces in a row

struct TextTokens {
  std::vector<Token> tokens;
  std::vector<std::pair<std::size_t, std::size_t>> left_out;  ///< from byte to byte of the text, in order
};

/// Cuts `text` into tokens; comments and white space are dropped, line continuations joined. So are, as `left_out`,
/// branches that the file's own preprocessor lines leave out, with those lines (shader/conditions.h). `file` is for
/// messages.
/// Errors (script): unbalanced or too deeply nested brackets, unfinished comments, characters that GLSL does not have,
/// branches that do not end, limits.
Result<TextTokens> tokenize(std::string_view text, const std::string& file);

/// An error of kind script at a line of a file.
Error shader_error(const std::string& file, int line, std::string message);

}  // namespace afterglow

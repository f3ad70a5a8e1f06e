// SPDX-License-Identifier: MIT
// The text of a script as tokens, brackets and calls: as much of Lua's grammar as finding and changing what somebody
// wrote into a table takes. Never runs anything; text that is no Lua gives tokens all the same. Time and memory are
// linear in the text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace afterglow {

enum class TokenKind { name, word, text, number, symbol };  ///< a word is one that Lua keeps for itself: `end`

struct Token {
  TokenKind kind;
  std::string_view text;  ///< as written; of strings with their quotes
  std::size_t begin = 0;  ///< offset in the text
  int line = 0;           ///< of its first character, from 1, as Lua counts
  std::size_t end() const { return begin + text.size(); }
  /// Of strings: what stands between the quotes or long brackets, escapes as they are.
  std::string_view inside() const;
};

class LuaText {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// The text must outlive the object.
  explicit LuaText(std::string_view text);

  std::string_view text() const { return text_; }
  std::size_t size() const { return tokens_.size(); }
  const Token& operator[](std::size_t i) const { return tokens_[i]; }
  /// Is token i this name, word or symbol? False beyond the last one.
  bool is(std::size_t i, std::string_view what) const;

  /// The bracket that closes the one at i, or opens it; the `end` of a `function`, `if`, `do`; kNone when there is
  /// none.
  std::size_t partner(std::size_t i) const { return partner_[i]; }

  /// One item of a table constructor.
  struct Item {
    std::string key;    ///< "knee"; "#2" for the second without a key and for [2]; empty: a key that is an expression
    std::size_t first;  ///< token where it begins
    std::size_t value;  ///< first token of the value
    std::size_t end;    ///< the token behind the value: a separator or the closing bracket
  };
  /// Items of the constructor whose `{` is token `open`.
  std::vector<Item> items(std::size_t open) const;
  /// Is the value of the item a table constructor and nothing else?
  bool is_table(const Item& item) const;

  struct Call {
    std::string_view callee;  ///< last name of what is called: "glow" of `fx.glow{…}` and `fx["glow"]{…}`
    std::size_t open;         ///< token where the arguments begin: `(`, `{` or a string
    int first_line, line;     ///< where the called expression begins, and `open`
    bool at(int where) const { return where >= first_line && where <= line; }  ///< versions of Lua name either line
  };
  /// Every call, in the order of the text.
  std::vector<Call> calls() const;

  /// Offset of the first line break at or behind `offset` that is not in a comment; the text's size when there is none.
  /// `offset` must not lie in a token or comment, and no token may stand before that line break.
  std::size_t end_of_line(std::size_t offset) const;

 private:
  void match();
  void chain();
  bool ends_prefix(std::size_t i) const;

  std::string_view text_;
  std::vector<Token> tokens_;
  std::vector<std::size_t> partner_;
  std::vector<std::size_t> start_;  // first token of the called or indexed expression that a token belongs to
};

}  // namespace afterglow

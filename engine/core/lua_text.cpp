// SPDX-License-Identifier: MIT
#include "core/lua_text.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "core/ascii.h"

namespace afterglow {
namespace {

bool is_break(char c) { return c == '\n' || c == '\r'; }

bool is_word(std::string_view name) {
  static constexpr std::array<std::string_view, 22> kWords{
      "and", "break", "do",  "else", "elseif", "end",    "false",  "for",  "function", "goto",  "if",
      "in",  "local", "nil", "not",  "or",     "repeat", "return", "then", "true",     "until", "while"};
  return std::binary_search(kWords.begin(), kWords.end(), name);
}

// Length of the operator that begins here.
std::size_t symbol_length(std::string_view rest) {
  if (rest.starts_with("...")) return 3;
  for (const std::string_view two : {"==", "~=", "<=", ">=", "//", "::", "<<", ">>", ".."})
    if (rest.starts_with(two)) return 2;
  return 1;
}

// Number of '=' of a long bracket that opens at `at`, or -1.
int long_level(std::string_view text, std::size_t at) {
  if (at >= text.size() || text[at] != '[') return -1;
  std::size_t i = at + 1;
  while (i < text.size() && text[i] == '=') ++i;
  return i < text.size() && text[i] == '[' ? static_cast<int>(i - at - 1) : -1;
}

// Offset behind the long bracket of that level which opens at `at`.
std::size_t end_of_long(std::string_view text, std::size_t at, int level) {
  const std::string close = "]" + std::string(static_cast<std::size_t>(level), '=') + "]";
  const std::size_t end = text.find(close, at + close.size());
  return end == std::string_view::npos ? text.size() : end + close.size();
}

// Offset behind the comment that begins at `at`; a line comment ends before its line break.
std::size_t end_of_comment(std::string_view text, std::size_t at) {
  if (const int level = long_level(text, at + 2); level >= 0) return end_of_long(text, at + 2, level);
  while (at < text.size() && !is_break(text[at])) ++at;
  return at;
}

class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }

  std::vector<Token> tokens() {
    std::vector<Token> out;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      const char next = at_ + 1 < text_.size() ? text_[at_ + 1] : '\0';
      if (std::isspace(static_cast<unsigned char>(c)))
        advance(at_ + 1);
      else if (c == '-' && next == '-')
        advance(end_of_comment(text_, at_));
      else if (c == '"' || c == '\'')
        out.push_back(take(TokenKind::text, end_of_quoted(c)));
      else if (const int level = long_level(text_, at_); level >= 0)
        out.push_back(take(TokenKind::text, end_of_long(text_, at_, level)));
      else if (is_digit(c) || (c == '.' && is_digit(next)))
        out.push_back(take(TokenKind::number, end_of_number()));
      else if (is_name_char(c))
        out.push_back(name());
      else
        out.push_back(take(TokenKind::symbol, at_ + symbol_length(text_.substr(at_))));
    }
    return out;
  }

 private:
  // Lua counts "\n", "\r" and both together, in either order, as one line break.
  void advance(std::size_t end) {
    while (at_ < end) {
      const char c = text_[at_++];
      if (!is_break(c)) continue;
      ++line_;
      if (at_ < text_.size() && is_break(text_[at_]) && text_[at_] != c) ++at_;
    }
  }

  Token take(TokenKind kind, std::size_t end) {
    const Token token{kind, text_.substr(at_, end - at_), at_, line_};
    advance(end);
    at_ = end;  // a string that ends between "\r" and "\n" cannot be, but hostile text can look like it
    return token;
  }

  Token name() {
    std::size_t end = at_;
    while (end < text_.size() && is_name_char(text_[end])) ++end;
    return take(is_word(text_.substr(at_, end - at_)) ? TokenKind::word : TokenKind::name, end);
  }

  std::size_t end_of_quoted(char quote) const {
    std::size_t i = at_ + 1;
    while (i < text_.size() && text_[i] != quote) i += text_[i] == '\\' ? 2 : 1;
    return std::min(i + 1, text_.size());
  }

  // As Lua reads them: digits, letters and points, and a sign behind the letter of an exponent.
  std::size_t end_of_number() const {
    const bool hex = text_[at_] == '0' && at_ + 1 < text_.size() && (text_[at_ + 1] | 0x20) == 'x';
    const char exponent = hex ? 'p' : 'e';
    std::size_t i = at_;
    while (i < text_.size() && (is_name_char(text_[i]) || text_[i] == '.')) {
      const bool sign =
          (text_[i] | 0x20) == exponent && i + 1 < text_.size() && (text_[i + 1] == '+' || text_[i + 1] == '-');
      i += sign ? 2 : 1;
    }
    return i;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

std::string_view Token::inside() const {
  if (kind != TokenKind::text || text.size() < 2) return {};
  if (text[0] != '[') return text.substr(1, text.size() - 2);
  const auto level = static_cast<std::size_t>(long_level(text, 0)) + 2;
  return text.size() >= 2 * level ? text.substr(level, text.size() - 2 * level) : std::string_view{};
}

LuaText::LuaText(std::string_view text) : text_(text), tokens_(Lexer(text).tokens()) {
  match();
  chain();
}

bool LuaText::is(std::size_t i, std::string_view what) const {
  return i < tokens_.size() && tokens_[i].kind != TokenKind::text && tokens_[i].text == what;
}

void LuaText::match() {
  partner_.assign(tokens_.size(), kNone);
  std::vector<std::size_t> open;
  const auto closes = [&](std::size_t i, std::size_t opener) {
    if (is(i, ")")) return is(opener, "(");
    if (is(i, "}")) return is(opener, "{");
    if (is(i, "]")) return is(opener, "[");
    if (is(i, "until")) return is(opener, "repeat");
    return is(i, "end") && (is(opener, "function") || is(opener, "if") || is(opener, "do"));
  };
  for (std::size_t i = 0; i < tokens_.size(); ++i) {
    const TokenKind kind = tokens_[i].kind;
    if (kind != TokenKind::symbol && kind != TokenKind::word) continue;
    if (is(i, "(") || is(i, "{") || is(i, "[") || is(i, "function") || is(i, "if") || is(i, "do") || is(i, "repeat")) {
      open.push_back(i);
    } else if (!open.empty() && closes(i, open.back())) {
      partner_[i] = open.back();
      partner_[open.back()] = i;
      open.pop_back();
    }
  }
}

// May what ends with token i be called or indexed?
bool LuaText::ends_prefix(std::size_t i) const {
  if (tokens_[i].kind == TokenKind::name || is(i, ")") || is(i, "]")) return true;
  // Strings and tables only as arguments of a call before.
  if (tokens_[i].kind == TokenKind::text) return start_[i] != i;
  return is(i, "}") && partner_[i] != kNone && start_[i] != partner_[i];
}

void LuaText::chain() {
  start_.resize(tokens_.size());
  for (std::size_t i = 0; i < tokens_.size(); ++i) {
    start_[i] = i;
    if (i == 0) continue;
    const TokenKind kind = tokens_[i].kind;
    if (kind == TokenKind::name) {
      if (i > 1 && (is(i - 1, ".") || is(i - 1, ":")) && ends_prefix(i - 2)) start_[i] = start_[i - 2];
    } else if (kind == TokenKind::text || is(i, "(") || is(i, "{") || is(i, "[")) {
      if (ends_prefix(i - 1)) start_[i] = start_[i - 1];
    } else if ((is(i, ")") || is(i, "}") || is(i, "]")) && partner_[i] != kNone) {
      start_[i] = start_[partner_[i]];
    }
  }
}

std::vector<LuaText::Item> LuaText::items(std::size_t open) const {
  std::vector<Item> out;
  int position = 0;
  std::size_t i = open + 1;
  while (i < size() && !is(i, "}")) {
    Item item{{}, i, i, size()};
    if (tokens_[i].kind == TokenKind::name && is(i + 1, "=")) {
      item.key = tokens_[i].text;
      item.value = i + 2;
    } else if (is(i, "[") && partner_[i] != kNone && is(partner_[i] + 1, "=")) {
      const Token& key = tokens_[i + 1];
      if (partner_[i] == i + 2 && key.kind == TokenKind::text) item.key = key.inside();
      if (partner_[i] == i + 2 && key.kind == TokenKind::number) item.key = "#" + std::string(key.text);
      item.value = partner_[i] + 2;
    } else {
      item.key = "#" + std::to_string(++position);
    }
    std::size_t end = item.value;
    while (end < size() && !is(end, ",") && !is(end, ";") && !is(end, "}"))
      end = partner_[end] == kNone || partner_[end] < end ? end + 1 : partner_[end] + 1;
    item.end = std::min(end, size());
    i = is(end, ",") || is(end, ";") ? end + 1 : end;
    out.push_back(std::move(item));
  }
  return out;
}

bool LuaText::is_table(const Item& item) const {
  return is(item.value, "{") && partner_[item.value] != kNone && partner_[item.value] + 1 == item.end;
}

std::vector<LuaText::Call> LuaText::calls() const {
  std::vector<Call> out;
  for (std::size_t i = 1; i < size(); ++i) {
    if (start_[i] == i || is(i, "[") || is(i, "]") || is(i, ")") || is(i, "}")) continue;
    if (tokens_[i].kind == TokenKind::name) continue;
    Call call{{}, i, tokens_[start_[i]].line, tokens_[i].line};
    if (tokens_[i - 1].kind == TokenKind::name)
      call.callee = tokens_[i - 1].text;
    else if (i > 2 && is(i - 1, "]") && tokens_[i - 2].kind == TokenKind::text)
      call.callee = tokens_[i - 2].inside();
    out.push_back(call);
  }
  return out;
}

std::size_t LuaText::end_of_line(std::size_t offset) const {
  while (offset < text_.size() && !is_break(text_[offset]))
    offset = text_.substr(offset).starts_with("--") ? end_of_comment(text_, offset) : offset + 1;
  return std::min(offset, text_.size());
}

}  // namespace afterglow

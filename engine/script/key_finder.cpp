#include "script/key_finder.h"

#include <cctype>
#include <optional>
#include <vector>

namespace afterglow::script {
namespace {

enum class TokenKind { name, text, number, symbol };

struct Token {
  TokenKind kind;
  std::string_view text;  // of strings: without the quotes
  int line;
};

bool is_name_char(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {}

  std::vector<Token> tokens() {
    std::vector<Token> out;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '\n') ++line_;
      if (std::isspace(static_cast<unsigned char>(c))) {
        ++at_;
      } else if (text_.substr(at_, 2) == "--") {
        skip_comment();
      } else if (c == '"' || c == '\'') {
        out.push_back(quoted(c));
      } else if (c == '[' && long_level() >= 0) {
        const int line = line_;
        out.push_back({TokenKind::text, long_bracket(long_level()), line});
      } else if (std::isdigit(static_cast<unsigned char>(c))) {
        out.push_back(word(TokenKind::number));
      } else if (is_name_char(c)) {
        out.push_back(word(TokenKind::name));
      } else {
        // Of the longer operators only `==` matters: it must not look like the `=` of a key.
        const std::size_t length = text_.substr(at_, 2) == "==" ? 2 : 1;
        out.push_back({TokenKind::symbol, text_.substr(at_, length), line_});
        at_ += length;
      }
    }
    return out;
  }

 private:
  // Number of '=' of a long bracket that opens here, or -1.
  int long_level() const {
    std::size_t i = at_ + 1;
    while (i < text_.size() && text_[i] == '=') ++i;
    return i < text_.size() && text_[i] == '[' ? static_cast<int>(i - at_ - 1) : -1;
  }

  std::string_view long_bracket(int level) {
    const std::string close = "]" + std::string(static_cast<std::size_t>(level), '=') + "]";
    const std::size_t begin = at_ + close.size();
    std::size_t end = text_.find(close, begin);
    if (end == std::string_view::npos) end = text_.size();
    for (std::size_t i = at_; i < end; ++i) line_ += text_[i] == '\n';
    at_ = std::min(end + close.size(), text_.size());
    return begin <= end ? text_.substr(begin, end - begin) : std::string_view{};
  }

  void skip_comment() {
    at_ += 2;
    if (at_ < text_.size() && text_[at_] == '[' && long_level() >= 0) {
      long_bracket(long_level());
      return;
    }
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }

  Token quoted(char quote) {
    const int line = line_;
    const std::size_t begin = ++at_;
    while (at_ < text_.size() && text_[at_] != quote) {
      if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
      line_ += text_[at_] == '\n';
      ++at_;
    }
    const auto inside = text_.substr(begin, at_ - begin);
    if (at_ < text_.size()) ++at_;
    return {TokenKind::text, inside, line};
  }

  Token word(TokenKind kind) {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_name_char(text_[at_]) || (kind == TokenKind::number && text_[at_] == '.'))) ++at_;
    return {kind, text_.substr(begin, at_ - begin), line_};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

class Finder {
 public:
  Finder(std::string_view text, const KeyPath& key) : tokens_(Lexer(text).tokens()), key_(key) {}

  int find(int call_line, std::string_view function) const {
    int best = call_line;
    std::size_t best_depth = 0;
    // The named function's own brackets first; then any constructor on that line.
    for (const bool named : {true, false}) {
      for (std::size_t i = 0; i < tokens_.size(); ++i) {
        if (!is(i, "{") || !opens_call(i, call_line, named ? function : std::string_view{})) continue;
        int line = call_line;
        const std::size_t depth = descend(i, 0, line);
        if (depth > best_depth) {
          best = line;
          best_depth = depth;
        }
      }
      if (best_depth == key_.size()) break;
    }
    return best;
  }

 private:
  bool is(std::size_t i, std::string_view symbol) const {
    return i < tokens_.size() && tokens_[i].kind != TokenKind::text && tokens_[i].text == symbol;
  }

  // Does the `{` at i open the table of a call whose bracket stands on the line (of that name, unless the name is
  // empty)?
  bool opens_call(std::size_t i, int line, std::string_view function) const {
    if (function.empty()) return tokens_[i].line == line;
    std::size_t open = i;
    if (i > 0 && is(i - 1, "(")) open = i - 1;
    if (i > 2 && is(i - 1, ",") && is(i - 3, "(")) open = i - 3;  // a name before the table
    return tokens_[open].line == line && open > 0 && tokens_[open - 1].kind != TokenKind::symbol &&
           tokens_[open - 1].text == function;
  }

  // How many parts of the key path are found below the constructor at `open`; `line` becomes that of the deepest.
  std::size_t descend(std::size_t open, std::size_t depth, int& line) const {
    if (depth == key_.size()) return depth;
    std::size_t best = depth;
    int position = 0;
    std::size_t i = open + 1;
    while (i < tokens_.size() && !is(i, "}")) {
      const int item_line = tokens_[i].line;
      const std::size_t value = value_of(i);
      const std::string name = value == i ? "#" + std::to_string(++position) : key_text(i);
      if (name == key_[depth]) {
        // A key may be given twice: the last one counts for Lua, and here.
        line = item_line;
        best = depth + 1;
        if (is(value, "{")) best = descend(value, depth + 1, line);
      }
      i = skip_item(value);
      if (is(i, ",") || is(i, ";")) ++i;
    }
    return best;
  }

  // Index of the value of the item at i; i itself for positional items.
  std::size_t value_of(std::size_t i) const {
    if (tokens_[i].kind == TokenKind::name && is(i + 1, "=")) return i + 2;
    if (is(i, "[") && is(i + 2, "]") && is(i + 3, "=")) return i + 4;
    return i;
  }

  std::string key_text(std::size_t i) const {
    if (!is(i, "[")) return std::string(tokens_[i].text);
    const Token& token = tokens_[i + 1];
    return (token.kind == TokenKind::number ? "#" : "") + std::string(token.text);
  }

  // Index of the separator or bracket that ends the item which starts at i.
  std::size_t skip_item(std::size_t i) const {
    int depth = 0;
    for (; i < tokens_.size(); ++i) {
      if (depth == 0 && (is(i, ",") || is(i, ";") || is(i, "}"))) return i;
      if (is(i, "(") || is(i, "{") || is(i, "[") || is(i, "function") || is(i, "if") || is(i, "do") || is(i, "repeat"))
        ++depth;
      if (is(i, ")") || is(i, "}") || is(i, "]") || is(i, "end") || is(i, "until")) --depth;
    }
    return i;
  }

  std::vector<Token> tokens_;
  const KeyPath& key_;
};

}  // namespace

int line_of_key(std::string_view text, int call_line, std::string_view function, const KeyPath& key) {
  if (key.empty()) return call_line;
  return Finder(text, key).find(call_line, function);
}

}  // namespace afterglow::script

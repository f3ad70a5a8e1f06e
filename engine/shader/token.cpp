// SPDX-License-Identifier: MIT
#include "shader/token.h"

#include <fmt/format.h>

#include "core/ascii.h"
#include "core/utf8.h"
#include "shader/conditions.h"

namespace afterglow {
namespace {

/// Within a line.
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

class Tokenizer {
 public:
  Tokenizer(std::string_view text, const std::string& file) : text_(text), file_(file), conditions_(file) {}

  Result<TextTokens> run() {
    if (text_.size() > kMaxShaderBytes)
      return shader_error(file_, 0,
                          fmt::format("the shader has {} bytes; at most {} are read", text_.size(), kMaxShaderBytes));
    while (at_ < text_.size()) {
      AFTERGLOW_CHECK(step());
      if (tokens_.size() > kMaxTokens)
        return shader_error(file_, line_, fmt::format("the shader has more than {} tokens", kMaxTokens));
    }
    AFTERGLOW_CHECK(end_directive());
    AFTERGLOW_CHECK(conditions_.end());
    if (!open_.empty())
      return shader_error(file_, open_.back().line, fmt::format("'{}' is never closed", open_.back().character));
    return TextTokens{std::move(tokens_), std::move(left_out_)};
  }

 private:
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }

  /// Length of the line end at `position`: "\n", "\r\n" or "\r"; 0: none.
  std::size_t newline_at(std::size_t position) const {
    if (position >= text_.size()) return 0;
    if (text_[position] == '\n') return 1;
    if (text_[position] != '\r') return 0;
    return position + 1 < text_.size() && text_[position + 1] == '\n' ? 2 : 1;
  }

  Result<void> step() {
    if (const auto length = newline_at(at_)) {
      AFTERGLOW_CHECK(end_directive());
      if (conditions_.leaves_out()) return leave_out();
      at_ += length;
      ++line_;
      line_is_empty_ = true;
      return {};
    }
    const char c = peek();
    if (is_space(c)) {
      ++at_;
      return {};
    }
    if (c == '\\' && newline_at(at_ + 1)) {  // the line goes on
      at_ += 1 + newline_at(at_ + 1);
      ++line_;
      return {};
    }
    if (c == '/' && peek(1) == '/') return skip_line_comment();
    if (c == '/' && peek(1) == '*') return skip_block_comment();
    if (c == '#' && line_is_empty_) {
      in_directive_ = true;
      ++directive_;
      directive_begin_ = tokens_.size();
    }
    line_is_empty_ = false;
    if (is_digit(c) || (c == '.' && is_digit(peek(1)))) return number();
    if (is_name_char(c)) return word();
    if (c == '"') return quoted();
    return punctuation();
  }

  Result<void> end_directive() {
    if (!in_directive_) return {};
    in_directive_ = false;
    const auto first = tokens_.begin() + static_cast<std::ptrdiff_t>(directive_begin_);
    std::vector<Token> line(first, tokens_.end());
    const std::size_t begin = line.front().offset, end = line.back().end();
    const std::size_t word = line.size() > 1 ? line[1].offset : end;
    AFTERGLOW_TRY(const bool stays, conditions_.line(line));
    tokens_.erase(first, tokens_.end());
    if (!stays) {
      left_out_.emplace_back(begin, end);
      return {};
    }
    if (line.size() > 1 && line[1].offset > word) left_out_.emplace_back(word, line[1].offset);
    tokens_.insert(tokens_.end(), line.begin(), line.end());
    return {};
  }

  /// From the end of a line to the next one that begins, goes on with or ends a group of branches. What stands between
  /// need not be GLSL.
  Result<void> leave_out() {
    const std::size_t begin = at_;
    bool line_begins = true;
    while (at_ < text_.size() && !(line_begins && is_of_branches())) {
      const char c = peek();
      if (const auto length = newline_at(at_)) {
        at_ += length;
        ++line_;
        line_begins = true;
      } else if (c == '/' && peek(1) == '/') {
        AFTERGLOW_CHECK(skip_line_comment());
      } else if (c == '/' && peek(1) == '*') {
        AFTERGLOW_CHECK(skip_block_comment());
      } else if (c == '\\' && newline_at(at_ + 1)) {
        at_ += 1 + newline_at(at_ + 1);
        ++line_;
      } else {
        line_begins = line_begins && is_space(c);
        ++at_;
      }
    }
    left_out_.emplace_back(begin, at_);
    line_is_empty_ = true;
    return {};
  }

  bool is_of_branches() const {
    if (peek() != '#') return false;
    std::size_t begin = at_ + 1;
    while (begin < text_.size() && is_space(text_[begin])) ++begin;
    std::size_t end = begin;
    while (end < text_.size() && is_name_char(text_[end])) ++end;
    const std::string_view word = text_.substr(begin, end - begin);
    return word == "if" || word == "ifdef" || word == "ifndef" || word == "elif" || word == "else" || word == "endif";
  }

  Result<void> skip_line_comment() {
    while (at_ < text_.size() && !newline_at(at_)) {
      if (peek() == '\\' && newline_at(at_ + 1)) {
        at_ += newline_at(at_ + 1);
        ++line_;
      }
      ++at_;
    }
    return {};
  }

  Result<void> skip_block_comment() {
    const int begin = line_;
    at_ += 2;
    while (at_ < text_.size()) {
      if (peek() == '*' && peek(1) == '/') {
        at_ += 2;
        return {};
      }
      const auto length = newline_at(at_);
      line_ += length ? 1 : 0;
      at_ += length ? length : 1;
    }
    return shader_error(file_, begin, "the comment is never closed");
  }

  void push(TokenKind kind, std::size_t begin, std::size_t end) {
    tokens_.push_back({kind, text_.substr(begin, end - begin), begin, line_, in_directive_ ? directive_ : -1});
  }

  Result<void> word() {
    const auto begin = at_;
    while (is_name_char(peek())) ++at_;
    if (at_ - begin > 128) return shader_error(file_, line_, "the name is longer than 128 characters");
    push(TokenKind::identifier, begin, at_);
    return count(tokens_.back());
  }

  Result<void> number() {
    const auto begin = at_;
    const bool hexadecimal = peek() == '0' && (peek(1) == 'x' || peek(1) == 'X');
    while (is_name_char(peek()) || peek() == '.') {
      const bool exponent = !hexadecimal && (peek() == 'e' || peek() == 'E');
      ++at_;
      if (exponent && (peek() == '+' || peek() == '-')) ++at_;
    }
    push(TokenKind::number, begin, at_);
    return count(tokens_.back());
  }

  Result<void> quoted() {
    const auto begin = ++at_;
    while (at_ < text_.size() && peek() != '"' && !newline_at(at_)) ++at_;
    if (peek() != '"') return shader_error(file_, line_, "the text in quotes is never closed");
    if (!in_directive_) return shader_error(file_, line_, "GLSL has no text in quotes");
    push(TokenKind::quoted, begin, at_);
    ++at_;
    return {};
  }

  /// Beyond ASCII, as word processors and web pages put it in place of what was meant.
  Error foreign_character(unsigned char first) const {
    const std::size_t length = first < 0xc0 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    const std::string character(text_.substr(at_, length));
    if (first < 0x80 || length == 1 || utf8_text(character) != character)
      return shader_error(file_, line_, fmt::format("unexpected character (byte 0x{:02x})", first));
    if (character == "\xc2\xa0") return shader_error(file_, line_, "unexpected no-break space; write a plain one");
    Error error = shader_error(file_, line_, fmt::format("unexpected character '{}'", character));
    const bool dash = character == "\xe2\x80\x93" || character == "\xe2\x80\x94" || character == "\xe2\x88\x92";
    error.message += dash ? "; write -" : "; GLSL has letters of English alone outside of comments";
    return error;
  }

  Result<void> punctuation() {
    static constexpr std::string_view kKnown = "()[]{}.,;:?+-*/%<>=!&|^~#";
    const char c = peek();
    if (kKnown.find(c) == std::string_view::npos) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte > 0x20 && byte < 0x7f) return shader_error(file_, line_, fmt::format("unexpected character '{}'", c));
      return foreign_character(byte);
    }
    if (c == '#' && !in_directive_) return shader_error(file_, line_, "'#' must be the first character of its line");
    push(TokenKind::punctuation, at_, at_ + 1);
    ++at_;
    if (in_directive_) return nest_in_directive(c);
    AFTERGLOW_CHECK(nest(c));
    return count(tokens_.back());
  }

  Result<void> nest(char c) {
    if (c == '(' || c == '[' || c == '{') {
      if (open_.size() >= kMaxNesting)
        return shader_error(file_, line_, fmt::format("brackets are nested more than {} deep", kMaxNesting));
      open_.push_back({c, line_});
    } else if (c == ')' || c == ']' || c == '}') {
      const char opening = c == ')' ? '(' : c == ']' ? '[' : '{';
      if (open_.empty()) return shader_error(file_, line_, fmt::format("'{}' closes nothing", c));
      if (open_.back().character != opening)
        return shader_error(
            file_, line_,
            fmt::format("'{}' does not close the '{}' of line {}", c, open_.back().character, open_.back().line));
      open_.pop_back();
    }
    return {};
  }

  /// A macro may hold an unbalanced bracket; only the depth within one preprocessor line is limited.
  Result<void> nest_in_directive(char c) {
    if (directive_ != nested_directive_) {
      nested_directive_ = directive_;
      directive_depth_ = 0;
    }
    if (c == '(' || c == '[' || c == '{') ++directive_depth_;
    if (c == ')' || c == ']' || c == '}') --directive_depth_;
    if (directive_depth_ > kMaxNesting)
      return shader_error(file_, line_, fmt::format("brackets are nested more than {} deep", kMaxNesting));
    return {};
  }

  /// Limits of what the compiler handles by recursion without brackets: long statements, `else if` chains, `if(a) if(b)
  /// …`.
  Result<void> count(const Token& token) {
    if (in_directive_) return {};
    if (++statement_tokens_ > kMaxStatementTokens)
      return shader_error(file_, line_, fmt::format("the statement has more than {} tokens", kMaxStatementTokens));
    const bool in_parentheses = !open_.empty() && open_.back().character == '(';
    const bool ends = token.is("{") || token.is("}") || (token.is(";") && !in_parentheses);
    const bool continues = token.is("else");
    if (after_end_ && !continues) else_chains_.back() = 0;
    if (continues && ++else_chains_.back() > kMaxChain)
      return shader_error(file_, line_, fmt::format("more than {} 'else' in a row", kMaxChain));
    if (token.is("{")) else_chains_.push_back(0);
    if (token.is("}")) else_chains_.pop_back();
    after_end_ = ends;
    if (ends) {
      statement_tokens_ = 0;
      control_words_ = 0;
      return {};
    }
    const bool control = token.is("if") || token.is("for") || token.is("while") || token.is("do") || token.is("switch");
    if (control && ++control_words_ > kMaxChain)
      return shader_error(file_, line_,
                          fmt::format("more than {} control statements in one another without braces", kMaxChain));
    return {};
  }

  struct Open {
    char character;
    int line;
  };

  std::string_view text_;
  const std::string& file_;
  Conditions conditions_;
  std::vector<Token> tokens_;
  std::vector<std::pair<std::size_t, std::size_t>> left_out_;
  std::vector<Open> open_;
  std::size_t at_ = 0;
  int line_ = 1;
  int directive_ = -1;
  std::size_t directive_begin_ = 0;  ///< index of its '#'
  bool in_directive_ = false;
  bool line_is_empty_ = true;
  int nested_directive_ = -1;
  int directive_depth_ = 0;
  int statement_tokens_ = 0;
  int control_words_ = 0;
  std::vector<int> else_chains_{0};  ///< `else` in a row, for each level of braces
  bool after_end_ = false;
};

}  // namespace

Error shader_error(const std::string& file, int line, std::string message) {
  Error error;
  error.kind = ErrorKind::script;
  error.message = std::move(message);
  error.file = file;
  error.line = line;
  return error;
}

Result<TextTokens> tokenize(std::string_view text, const std::string& file) { return Tokenizer(text, file).run(); }

}  // namespace afterglow

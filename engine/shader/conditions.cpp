// SPDX-License-Identifier: MIT
#include "shader/conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "shader/literal.h"

namespace afterglow {
namespace {

using Number = std::optional<std::int64_t>;

constexpr std::size_t kMostTokens = 1024;  ///< of a condition, with those that its macros are expanded from
constexpr std::size_t kMostMacros = 64;    ///< that use one another
constexpr int kMostDepth = 256;            ///< of what stands within it

struct Operator {
  std::string_view text;
  int binds = 0;  ///< more tightly than those of smaller numbers
};
/// The longer ones first.
constexpr std::array kOperators{
    Operator{"||", 1}, Operator{"&&", 2}, Operator{"==", 6}, Operator{"!=", 6}, Operator{"<=", 7}, Operator{">=", 7},
    Operator{"<<", 8}, Operator{">>", 8}, Operator{"|", 3},  Operator{"^", 4},  Operator{"&", 5},  Operator{"<", 7},
    Operator{">", 7},  Operator{"+", 9},  Operator{"-", 9},  Operator{"*", 10}, Operator{"/", 10}, Operator{"%", 10}};

Number as_int(std::int64_t value) {
  using Limits = std::numeric_limits<std::int32_t>;
  return value < Limits::min() || value > Limits::max() ? Number() : Number(value);
}

Number apply(std::string_view op, std::int64_t a, std::int64_t b) {
  if (op == "==") return a == b;
  if (op == "!=") return a != b;
  if (op == "<=") return a <= b;
  if (op == ">=") return a >= b;
  if (op == "<") return a < b;
  if (op == ">") return a > b;
  if (op == "|") return a | b;
  if (op == "^") return a ^ b;
  if (op == "&") return a & b;
  if (op == "+") return as_int(a + b);
  if (op == "-") return as_int(a - b);
  if (op == "*") return as_int(a * b);
  if (op == "<<" || op == ">>") {
    if (a < 0 || b < 0 || b > 31) return std::nullopt;
    return op == "<<" ? as_int(a << b) : a >> b;
  }
  if (b == 0) return std::nullopt;
  return op == "/" ? as_int(a / b) : a % b;
}

/// A condition whose macros are expanded. Nothing where it is no sum of what is known.
class Condition {
 public:
  explicit Condition(std::span<const Token> tokens) : tokens_(tokens) {}

  Number value() {
    for (std::size_t i = 1; i < tokens_.size(); ++i)  // "++" is one word, and no operator of conditions
      if ((tokens_[i].is("+") || tokens_[i].is("-")) && tokens_[i].text == tokens_[i - 1].text && is_behind(i))
        return std::nullopt;
    const Number out = binary(1);
    return at_ == tokens_.size() && !broken_ ? out : std::nullopt;
  }

 private:
  /// Right behind the one before.
  bool is_behind(std::size_t i) const { return tokens_[i].offset == tokens_[i - 1].end(); }

  const Operator* operator_here() const {
    for (const Operator& one : kOperators) {
      if (at_ + one.text.size() > tokens_.size()) continue;
      bool same = true;
      for (std::size_t i = 0; i < one.text.size(); ++i)
        same = same && tokens_[at_ + i].is(one.text.substr(i, 1)) && (i == 0 || is_behind(at_ + i));
      if (same) return &one;
    }
    return nullptr;
  }

  Number binary(int least) {
    Number left = unary();
    for (const Operator* op = operator_here(); op && op->binds >= least && !broken_; op = operator_here()) {
      at_ += op->text.size();
      const Number right = binary(op->binds + 1);
      if (op->text == "&&" && left) {
        left = *left == 0 ? Number(0) : right ? Number(*right != 0) : right;
      } else if (op->text == "||" && left) {
        left = *left != 0 ? Number(1) : right ? Number(*right != 0) : right;
      } else {
        left = left && right ? apply(op->text, *left, *right) : std::nullopt;
      }
    }
    return left;
  }

  Number unary() {
    std::vector<char> signs;
    while (at_ < tokens_.size() &&
           (tokens_[at_].is("!") || tokens_[at_].is("-") || tokens_[at_].is("+") || tokens_[at_].is("~")))
      signs.push_back(tokens_[at_++].text[0]);
    Number out = primary();
    for (auto sign = signs.rbegin(); sign != signs.rend() && out; ++sign)
      out = *sign == '!' ? Number(*out == 0) : *sign == '~' ? Number(~*out) : *sign == '-' ? as_int(-*out) : out;
    return out;
  }

  Number primary() {
    if (at_ >= tokens_.size()) return broken_ = true, std::nullopt;
    const Token& token = tokens_[at_++];
    if (token.is("(")) {
      if (++depth_ > kMostDepth) return broken_ = true, std::nullopt;
      const Number out = binary(1);
      --depth_;
      broken_ = broken_ || at_ >= tokens_.size() || !tokens_[at_].is(")");
      ++at_;
      return out;
    }
    if (token.kind == TokenKind::number) {
      const auto value = literal_value(token, ParamType::int1);
      return value ? Number(static_cast<std::int64_t>(*value)) : std::nullopt;
    }
    broken_ = broken_ || !token.is_identifier();
    return std::nullopt;
  }

  std::span<const Token> tokens_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool broken_ = false;
};

}  // namespace

Result<bool> Conditions::line(std::vector<Token>& tokens) {
  if (tokens.size() < 2) return true;
  Token& word = tokens[1];
  if (word.is("if") || word.is("ifdef") || word.is("ifndef")) {
    const bool within = leaves_out();
    const Number value = within ? Number() : holds(tokens);
    Group group{word.line, within || value.has_value()};
    group.state = within ? State::over : value.value_or(0) != 0 ? State::holds : State::none_yet;
    groups_.push_back(group);
    return !group.decided;
  }
  if (groups_.empty()) {
    define(tokens);
    return true;
  }
  Group& group = groups_.back();
  if (word.is("endif")) {
    const bool decided = group.decided;
    groups_.pop_back();
    return !decided;
  }
  if (!word.is("elif") && !word.is("else")) {
    if (!leaves_out()) define(tokens);
    return true;
  }
  if (group.has_else) return shader_error(file_, word.line, fmt::format("#{} behind #else", word.text));
  group.has_else = word.is("else");
  if (!group.decided) return true;
  if (group.state == State::holds) group.state = State::over;
  if (group.state == State::over) return false;
  const Number value = group.has_else ? Number(1) : holds(tokens);
  if (value) {
    if (*value != 0) group.state = State::holds;
    return false;
  }
  // What was known of the group is gone: the first branch that is not known begins it.
  group.decided = false;
  word.text.remove_prefix(2);
  word.offset += 2;
  return true;
}

Result<void> Conditions::end() const {
  for (const Group& group : groups_)
    if (group.decided) return shader_error(file_, group.line, "#if is never closed by #endif");
  return {};
}

void Conditions::define(std::span<const Token> tokens) {
  if (tokens[1].is("include")) includes_ = true;
  if (tokens.size() < 3 || !(tokens[1].is("define") || tokens[1].is("undef"))) return;
  const bool has_arguments = tokens.size() > 3 && tokens[3].is("(") && tokens[3].offset == tokens[2].end();
  Macro& macro = macros_[tokens[2].text];
  macro.defined = tokens[1].is("define");
  macro.certain = std::ranges::all_of(groups_, &Group::decided);
  macro.plain = !has_arguments;
  macro.body.assign(tokens.begin() + 3, tokens.end());
}

Conditions::Number Conditions::is_defined(std::string_view name) const {
  if (const auto found = macros_.find(name); found != macros_.end())
    return found->second.certain ? Number(found->second.defined) : std::nullopt;
  constexpr std::string_view kOfGles = "GL_ES";
  const bool of_compiler = name.starts_with("GL_") || name.starts_with("__") || name == "VULKAN";
  if (includes_ || (of_compiler && name != kOfGles)) return std::nullopt;
  return 0;
}

bool Conditions::expand(std::span<const Token> tokens, Expansion& into) const {
  for (const Token& token : tokens) {
    if (++into.steps > kMostTokens) return false;
    const auto macro = token.is_identifier() ? macros_.find(token.text) : macros_.end();
    const bool stays = macro == macros_.end() || !macro->second.defined ||
                       std::ranges::find(into.active, token.text) != into.active.end();
    if (stays) {
      into.out.push_back(token);
      continue;
    }
    if (!macro->second.certain || !macro->second.plain || into.active.size() >= kMostMacros) return false;
    into.active.push_back(token.text);
    const bool good = expand(macro->second.body, into);
    into.active.pop_back();
    if (!good) return false;
  }
  return true;
}

Conditions::Number Conditions::holds(std::span<const Token> line) const {
  if (!line[1].is("if") && !line[1].is("elif")) {
    if (line.size() != 3 || !line[2].is_identifier()) return std::nullopt;
    const Number defined = is_defined(line[2].text);
    return defined && line[1].is("ifndef") ? Number(*defined == 0) : defined;
  }
  Expansion expansion;
  for (std::size_t i = 2; i < line.size(); ++i) {
    if (line[i].is("defined")) {
      const bool brackets = i + 3 < line.size() && line[i + 1].is("(") && line[i + 3].is(")");
      const std::size_t name = brackets ? i + 2 : i + 1;
      const Number defined =
          name < line.size() && line[name].is_identifier() ? is_defined(line[name].text) : std::nullopt;
      if (!defined) return std::nullopt;
      Token number = line[i];
      number.kind = TokenKind::number;
      number.text = *defined != 0 ? "1" : "0";
      expansion.out.push_back(number);
      i = brackets ? i + 3 : i + 1;
      continue;
    }
    if (!expand(line.subspan(i, 1), expansion)) return std::nullopt;
  }
  return Condition(expansion.out).value();
}

}  // namespace afterglow

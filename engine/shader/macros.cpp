// SPDX-License-Identifier: MIT
#include "shader/macros.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>

namespace afterglow {
namespace {

using Tokens = std::span<const Token* const>;

/// Tokens after expansion as a linear form: [0] of the text itself, [1 + k] for each token of argument k.
using Form = std::vector<double>;

struct Macro {
  std::size_t file = 0;
  int line = 0;
  bool function = false;
  std::vector<std::string_view> params;
  std::vector<const Token*> body;
  bool active = false;                   ///< being expanded: a macro is not expanded within itself
  Form form;                             ///< empty: not known yet
  std::optional<bool> keeps_apart = {};  ///< its arguments: see keeps_arguments_apart; none: not known yet
};

class MacroCheck {
 public:
  explicit MacroCheck(const std::vector<MacroFile>& files) : files_(files), macros_(files.size()) {}

  Result<void> run() {
    for (std::size_t i = 0; i < files_.size(); ++i) AFTERGLOW_CHECK(define(i));
    for (std::size_t i = 0; i < files_.size(); ++i) AFTERGLOW_CHECK(check_file(i));
    return {};
  }

 private:
  Error fail(std::size_t file, int line, std::string message) const {
    return shader_error(files_[file].file, line, std::move(message));
  }

  /// Preprocessor lines of a file as token lists, '#' first.
  std::vector<std::vector<const Token*>> directives(std::size_t file) const {
    std::vector<std::vector<const Token*>> lines;
    for (const auto& token : files_[file].scanned->tokens) {
      if (token.directive < 0) continue;
      if (lines.empty() || lines.back().front()->directive != token.directive) lines.emplace_back();
      lines.back().push_back(&token);
    }
    return lines;
  }

  Result<void> define(std::size_t file) {
    for (const auto& line : directives(file)) {
      if (line.size() < 3 || !line[1]->is("define")) continue;
      Macro macro{file, line[2]->line, false, {}, {}, false, {}};
      std::size_t at = 3;
      if (line.size() > 3 && line[3]->is("(") && line[3]->offset == line[2]->end()) {
        macro.function = true;
        for (at = 4; at < line.size() && !line[at]->is(")"); ++at)
          if (line[at]->is_identifier()) macro.params.push_back(line[at]->text);
        ++at;
      }
      int depth = 0;
      for (; at < line.size(); ++at) {
        const Token& token = *line[at];
        if (token.is("(") || token.is("[") || token.is("{")) ++depth;
        if (token.is(")") || token.is("]") || token.is("}")) --depth;
        if (depth < 0) break;
        macro.body.push_back(&token);
      }
      if (depth != 0)
        return fail(file, macro.line, fmt::format("the brackets in macro '{}' are not balanced", line[2]->text));
      macros_[file][line[2]->text].push_back(std::move(macro));
    }
    return {};
  }

  /// All definitions that `name` may have in a file; null: it is no macro there.
  std::vector<Macro>* find(std::size_t file, std::string_view name) {
    if (const auto own = macros_[file].find(name); own != macros_[file].end()) return &own->second;
    for (auto use = files_[file].uses.rbegin(); use != files_[file].uses.rend(); ++use)
      if (const auto seen = macros_[*use].find(name); seen != macros_[*use].end()) return &seen->second;
    return nullptr;
  }

  Result<void> check_file(std::size_t file) {
    std::vector<const Token*> statement;
    const auto check_statement = [&]() -> Result<void> {
      AFTERGLOW_TRY(const Form form, grow(file, statement, {}, 0));
      if (form[0] > kMaxExpandedTokens)
        return fail(file, statement.front()->line,
                    fmt::format("macros expand to more than {} tokens here", kMaxExpandedTokens));
      statement.clear();
      return {};
    };
    for (const auto& line : directives(file)) {
      if (line.size() < 3 || !(line[1]->is("if") || line[1]->is("elif"))) continue;
      statement.assign(line.begin() + 2, line.end());
      AFTERGLOW_CHECK(check_statement());
    }
    int parentheses = 0;
    for (const auto& token : files_[file].scanned->tokens) {
      if (token.directive >= 0) continue;
      statement.push_back(&token);
      if (token.is("(")) ++parentheses;
      if (token.is(")")) --parentheses;
      if (parentheses == 0 && (token.is(";") || token.is("{") || token.is("}"))) AFTERGLOW_CHECK(check_statement());
    }
    if (!statement.empty()) AFTERGLOW_CHECK(check_statement());
    return {};
  }

  /// Is it the name of `defined NAME` or `defined(NAME)` in a condition?
  static bool is_asked_for(Tokens tokens, std::size_t at) {
    if (tokens[at]->directive >= 0 && at > 0 && tokens[at - 1]->is("(")) --at;
    return tokens[at]->directive >= 0 && at > 0 && tokens[at - 1]->is("defined");
  }

  /// Is it the name of a macro with arguments that the preprocessor leaves alone? Something must stand behind it that
  /// is no bracket and becomes none: behind the last word of a macro or an argument stands what is not known here.
  bool is_plain_name(std::size_t file, const std::vector<Macro>& definitions, Tokens tokens, std::size_t at,
                     std::span<const std::string_view> params, bool stays_apart) {
    if (!definitions.front().function) return false;
    if (at + 1 >= tokens.size()) return stays_apart;
    const Token& behind = *tokens[at + 1];
    return !behind.is("(") && std::ranges::find(params, behind.text) == params.end() && !find(file, behind.text);
  }

  /// Does something that is no bracket stand behind each argument of a macro wherever it puts them? Not where other
  /// macros with arguments get them.
  bool keeps_arguments_apart(const Macro& macro) {
    const auto is_param = [&](std::string_view word) {
      return std::ranges::find(macro.params, word) != macro.params.end();
    };
    for (std::size_t i = 0; i < macro.body.size(); ++i) {
      if (!is_param(macro.body[i]->text)) {
        if (find(macro.file, macro.body[i]->text)) return false;
        continue;
      }
      if (i + 1 >= macro.body.size() || macro.body[i + 1]->is("(") || is_param(macro.body[i + 1]->text)) return false;
    }
    return true;
  }
  bool keep_arguments_apart(std::vector<Macro>& definitions) {
    return std::ranges::all_of(definitions, [&](Macro& macro) {
      if (!macro.keeps_apart) macro.keeps_apart = keeps_arguments_apart(macro);
      return *macro.keeps_apart;
    });
  }

  /// How `tokens` of `file` grow; `params` are those of the macro whose body they are. `stays_apart`: what stands
  /// behind them is known to be no bracket.
  Result<Form> grow(std::size_t file, Tokens tokens, std::span<const std::string_view> params, int depth,
                    bool stays_apart = false) {
    Form total(1 + params.size(), 0.0);
    if (depth > kMaxMacroDepth)
      return fail(file, tokens.empty() ? 0 : tokens[0]->line,
                  fmt::format("macros use macros more than {} deep", kMaxMacroDepth));
    for (std::size_t i = 0; i < tokens.size(); ++i) {
      const Token& token = *tokens[i];
      if (!token.is_identifier() || (depth == 0 && is_asked_for(tokens, i))) {
        total[0] += 1;
        continue;
      }
      if (const auto param = std::find(params.begin(), params.end(), token.text); param != params.end()) {
        total[1 + static_cast<std::size_t>(param - params.begin())] += 1;
        continue;
      }
      auto* definitions = find(file, token.text);
      total[0] += 1;
      if (!definitions || is_plain_name(file, *definitions, tokens, i, params, stays_apart)) continue;
      AFTERGLOW_TRY(const Form form, form_of(*definitions, depth));
      if (form.empty()) continue;
      total[0] += form[0];
      if (!definitions->front().function) continue;
      AFTERGLOW_TRY(i, add_arguments(file, tokens, i, params, depth, form, total));
    }
    return total;
  }

  /// Adds the arguments of the call at tokens[name], each as often as `form` says; gives the index of its ')'.
  Result<std::size_t> add_arguments(std::size_t file, Tokens tokens, std::size_t name,
                                    std::span<const std::string_view> params, int depth, const Form& form,
                                    Form& total) {
    const Token& token = *tokens[name];
    if (name + 1 >= tokens.size() || !tokens[name + 1]->is("("))
      return fail(file, token.line, fmt::format("macro '{}' needs its arguments behind it", token.text));
    const bool apart = keep_arguments_apart(*find(file, token.text));
    std::size_t begin = name + 2, argument = 1;
    int brackets = 1;
    for (std::size_t i = begin; i < tokens.size(); ++i) {
      const Token& t = *tokens[i];
      if (t.is("(") || t.is("[") || t.is("{")) ++brackets;
      if (t.is(")") || t.is("]") || t.is("}")) --brackets;
      if (brackets > 1 || (brackets == 1 && !t.is(","))) continue;
      AFTERGLOW_TRY(const Form grown, grow(file, tokens.subspan(begin, i - begin), params, depth + 1, apart));
      const double times = argument < form.size() ? std::max(form[argument], 1.0) : 1.0;
      for (std::size_t k = 0; k < total.size(); ++k) total[k] += times * grown[k];
      if (brackets == 0) return i;
      begin = i + 1;
      ++argument;
    }
    return fail(file, token.line, fmt::format("the arguments of macro '{}' are not closed", token.text));
  }

  /// The form of a macro, the largest over its definitions; empty while it is being expanded.
  Result<Form> form_of(std::vector<Macro>& definitions, int depth) {
    Form largest;
    for (auto& macro : definitions) {
      if (macro.active) return Form{};
      if (macro.function != definitions.front().function)
        return fail(macro.file, macro.line, "a macro is defined both with and without arguments");
      if (macro.form.empty()) {
        macro.active = true;
        auto form = grow(macro.file, macro.body, macro.params, depth + 1);
        macro.active = false;
        if (!form) return std::move(form).error();
        macro.form = std::move(form).value();
      }
      largest.resize(std::max(largest.size(), macro.form.size()), 0.0);
      for (std::size_t k = 0; k < macro.form.size(); ++k) largest[k] = std::max(largest[k], macro.form[k]);
    }
    return largest;
  }

  const std::vector<MacroFile>& files_;
  std::vector<std::map<std::string_view, std::vector<Macro>>> macros_;  ///< of each file
};

}  // namespace

Result<void> check_macros(const std::vector<MacroFile>& files) { return MacroCheck(files).run(); }

}  // namespace afterglow

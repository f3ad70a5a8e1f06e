// SPDX-License-Identifier: MIT
#include "shader/directives.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "core/text.h"

namespace afterglow {
namespace {

Error unknown_directive(const std::string& file, const Token& word) {
  static const std::vector<std::string> kAllowed = {"include", "define", "undef", "if",    "ifdef",
                                                    "ifndef",  "elif",   "else",  "endif", "error"};
  Error error = shader_error(file, word.line, fmt::format("#{} is not allowed in an effect's shader", word.text));
  if (word.is("version")) error.message = "#version is given by the engine (460); remove the line";
  error.allowed = "#" + join(kAllowed, ", #");
  error.nearest = nearest_name(word.text, kAllowed);
  if (!error.nearest.empty()) error.nearest.insert(0, "#");
  return error;
}

class DirectiveScanner {
 public:
  explicit DirectiveScanner(const std::string& file) : file_(file) {}

  Result<Directives> run(const std::vector<Token>& tokens) {
    for (std::size_t i = 0; i < tokens.size();) {
      if (tokens[i].directive < 0) {
        ++i;
        continue;
      }
      std::size_t end = i;
      while (end < tokens.size() && tokens[end].directive == tokens[i].directive) ++end;
      AFTERGLOW_CHECK(line(std::span(tokens).subspan(i, end - i)));
      i = end;
    }
    if (!conditions_.empty()) return shader_error(file_, conditions_.back(), "#if is never closed by #endif");
    for (const auto& name : undefined_) {
      const auto same = [&](const Token& macro) { return macro.text == name.text; };
      if (!std::any_of(out_.macros.begin(), out_.macros.end(), same))
        return fail(name, fmt::format("#undef {}: only macros of this file can be undefined", name.text));
    }
    return std::move(out_);
  }

 private:
  Error fail(const Token& token, std::string message) const {
    return shader_error(file_, token.line, std::move(message));
  }

  /// One preprocessor line, '#' first.
  Result<void> line(std::span<const Token> tokens) {
    if (tokens.size() < 2) return {};
    const Token& word = tokens[1];
    if (word.is("include")) {
      if (tokens.size() != 3 || tokens[2].kind != TokenKind::quoted)
        return fail(word, "an include is written #include \"lib/NAME.glsl\"");
      out_.includes.push_back({std::string(tokens[2].text), word.line});
      out_.edits.push_back({tokens[0].offset, tokens[2].end() + 1});
      return {};
    }
    for (std::size_t i = 1; i + 1 < tokens.size(); ++i)
      if (tokens[i].is("#") && tokens[i + 1].is("#")) return fail(tokens[i], "token pasting (##) is not supported");
    if (word.is("define") || word.is("undef")) {
      if (tokens.size() < 3 || !tokens[2].is_identifier())
        return fail(word, fmt::format("#{} needs a name", word.text));
      (word.is("define") ? out_.macros : undefined_).push_back(tokens[2]);
    } else if (word.is("if") || word.is("ifdef") || word.is("ifndef")) {
      conditions_.push_back(word.line);
    } else if (word.is("elif") || word.is("else") || word.is("endif")) {
      if (conditions_.empty()) return fail(word, fmt::format("#{} without #if", word.text));
      if (word.is("endif")) conditions_.pop_back();
    } else if (!word.is("error")) {
      return unknown_directive(file_, word);
    }
    return {};
  }

  const std::string& file_;
  Directives out_;
  std::vector<int> conditions_;   ///< lines of the #if that are open
  std::vector<Token> undefined_;  ///< names behind #undef
};

}  // namespace

Result<Directives> scan_directives(const std::vector<Token>& tokens, const std::string& file) {
  return DirectiveScanner(file).run(tokens);
}

}  // namespace afterglow

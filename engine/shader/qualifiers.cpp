// SPDX-License-Identifier: MIT
#include "shader/qualifiers.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <span>
#include <string_view>

namespace afterglow {
namespace {

constexpr std::array<std::string_view, 11> kQualifierWords = {
    "const", "uniform", "shared", "highp", "mediump", "lowp", "in", "out", "inout", "precise", "invariant"};

using QualifierWords = std::vector<std::string_view>;

bool has_word(const QualifierWords& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

class QualifierMacros {
 public:
  /// Notes one preprocessor line, '#' first.
  void line(std::span<const Token> tokens) {
    if (tokens.size() < 3) return;
    const Token& name = tokens[2];
    if (tokens[1].is("undef")) macros_.erase(name.text);
    if (!tokens[1].is("define")) return;
    std::optional<QualifierWords> words = words_of(name, tokens.subspan(3));
    const auto [known, fresh] = macros_.emplace(name.text, words);
    if (fresh) return;
    std::optional<QualifierWords>& both = known->second;  // one of the two, by a condition that is not known here
    if (!words) both.reset();
    if (both) std::erase_if(*both, [&](std::string_view word) { return !has_word(*words, word); });
  }

  /// Null: it stands for other things, or is no macro.
  const QualifierWords* find(std::string_view name) const {
    const auto known = macros_.find(name);
    return known != macros_.end() && known->second ? &*known->second : nullptr;
  }

 private:
  std::optional<QualifierWords> words_of(const Token& name, std::span<const Token> body) const {
    if (std::ranges::find(kQualifierWords, name.text) != kQualifierWords.end()) return std::nullopt;
    QualifierWords out;
    for (const Token& token : body) {
      const QualifierWords* macro = find(token.text);
      if (!macro && std::ranges::find(kQualifierWords, token.text) == kQualifierWords.end()) return std::nullopt;
      for (const std::string_view word : macro ? *macro : QualifierWords{token.text})
        if (!has_word(out, word)) out.push_back(word);
    }
    return out;
  }

  std::map<std::string_view, std::optional<QualifierWords>>
      macros_;  ///< no words: a macro that is more than qualifiers
};

}  // namespace

std::vector<Token> code_tokens(const std::vector<Token>& tokens) {
  std::vector<Token> out;
  out.reserve(tokens.size());
  QualifierMacros macros;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const Token& token = tokens[i];
    if (token.directive >= 0) {
      const std::size_t begin = i;
      while (i + 1 < tokens.size() && tokens[i + 1].directive == token.directive) ++i;
      macros.line(std::span(tokens).subspan(begin, i + 1 - begin));
    } else if (const QualifierWords* words = macros.find(token.text)) {
      for (const std::string_view word : *words) {
        out.push_back(token);
        out.back().text = word;
      }
    } else {
      out.push_back(token);
    }
  }
  return out;
}

}  // namespace afterglow

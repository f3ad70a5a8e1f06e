// SPDX-License-Identifier: MIT
#include "shader/rename.h"

#include <algorithm>
#include <array>
#include <utility>

#include "shader/give_values.h"
#include "shader/macro_arguments.h"

namespace afterglow {
namespace {

/// Tells which identifiers name fields in the declaration of a struct: those behind the type of a member.
class FieldFinder {
 public:
  /// Call for every token outside the preprocessor, in order; true when it is a field's name.
  bool next(const Token& token) {
    if (token.is("struct")) {
      state_ = State::name;
      return false;
    }
    switch (state_) {
      case State::outside:
        return false;
      case State::name:
        if (token.is("{")) state_ = State::type;
        if (token.is(";") || token.is("(")) state_ = State::outside;
        return false;
      case State::type:
        if (token.is("}")) state_ = State::outside;
        if (token.is_identifier() && !is_qualifier(token)) state_ = State::fields;
        return false;
      case State::fields:
        if (token.is("[") || token.is("(")) ++depth_;
        if (token.is("]") || token.is(")")) --depth_;
        if (token.is(";")) state_ = State::type;
        if (token.is("}")) state_ = State::outside;
        return depth_ == 0 && token.is_identifier();
    }
    return false;
  }

 private:
  static bool is_qualifier(const Token& token) {
    return token.is("highp") || token.is("mediump") || token.is("lowp") || token.is("const") || token.is("precise");
  }

  enum class State { outside, name, type, fields };
  State state_ = State::outside;
  int depth_ = 0;
};

/// The reader of `fetch ( image ,` or `fetch ( image )` at token i, or none.
StorageReaders::const_iterator reader_of(const std::vector<Token>& tokens, std::size_t i,
                                         const StorageReaders& readers) {
  if (readers.empty() || i + 3 >= tokens.size() || !is_reading_function(tokens[i].text) || !tokens[i + 1].is("("))
    return readers.end();
  // Of anything else the compiler says what is wrong with it.
  return tokens[i + 3].is(",") || tokens[i + 3].is(")") ? readers.find(tokens[i + 2].text) : readers.end();
}

/// Is tokens[i] given to a macro that makes the name of a field of it?
bool is_given_as_field(const std::vector<Token>& tokens, std::size_t i, const NameMap& names) {
  const auto place = argument_beginning_at(tokens, i);
  const auto macro = place ? names.find(place->name) : names.end();
  return macro != names.end() && place->number < macro->second.field_arguments.size() &&
         macro->second.field_arguments[place->number];
}

/// Does a word stay where a field's name stands? Macros are replaced there, but one that has arguments only with them.
bool stays_as_field(const NewName& name, const std::vector<Token>& tokens, std::size_t i) {
  const bool has_arguments = i + 1 < tokens.size() && tokens[i + 1].is("(");
  return !name.macro || (name.with_arguments && !has_arguments);
}

/// As many line ends as `text` has.
std::string only_newlines(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n' || (text[i] == '\r' && (i + 1 == text.size() || text[i + 1] != '\n'))) out += '\n';
  return out;
}

}  // namespace

std::string rewrite(std::string_view text, const ShaderScan& scanned, const NameMap& names,
                    const std::vector<std::string>& constants, std::size_t first_unset, const StorageReaders& readers) {
  std::string out;
  out.reserve(text.size() + text.size() / 4);
  std::size_t copied = 0;
  auto edit = scanned.edits.begin();
  const auto apply_edits_before = [&](std::size_t offset) {
    for (; edit != scanned.edits.end() && edit->begin <= offset; ++edit) {
      out += text.substr(copied, edit->begin - copied);
      if (edit->constant >= 0) out += constants[static_cast<std::size_t>(edit->constant)];
      if (edit->unset >= 0) {
        const auto index = static_cast<std::size_t>(edit->unset);
        const Unset& unset = scanned.unset[index];
        const auto renamed = [&](const std::string& name) {
          const auto known = names.find(name);
          return known == names.end() ? name : known->second.text;
        };
        out += unset.kind == Unset::Kind::result ? give_result_text(first_unset + index, renamed(unset.type))
                                                 : give_value_text(first_unset + index, renamed(unset.name));
      }
      out += only_newlines(text.substr(edit->begin, edit->end - edit->begin));
      copied = edit->end;
    }
  };
  FieldFinder fields;
  const Token* previous = nullptr;
  std::vector<std::string_view> parameters;  // of the macro in whose definition the token stands
  for (std::size_t i = 0; i < scanned.tokens.size(); ++i) {
    const Token& token = scanned.tokens[i];
    apply_edits_before(token.offset);
    if (!previous || previous->directive != token.directive)
      parameters = macro_parameters(scanned.tokens, i).value_or(std::vector<std::string_view>());
    const bool macro_name = token.directive >= 0 && i >= 2 && scanned.tokens[i - 1].is("define");
    const bool parameter = !macro_name && std::ranges::find(parameters, token.text) != parameters.end();
    const bool field = (token.directive < 0 && fields.next(token)) || (previous && previous->is("."));
    const bool directive_word =
        token.directive >= 0 && previous && previous->is("#") && previous->directive == token.directive;
    previous = &token;
    if (token.offset < copied || !token.is_identifier() || directive_word || parameter) continue;
    if (const auto reader = reader_of(scanned.tokens, i, readers); reader != readers.end()) {
      // `fetch(depth, p)` → `ag_r2_fetch(p)`: the image and the comma behind it go.
      const Token& bracket = scanned.tokens[i + 1];
      const bool comma = scanned.tokens[i + 3].is(",");
      out += text.substr(copied, token.offset - copied);
      out += reader->second;
      out += text.substr(token.offset, bracket.end() - token.offset);
      copied = scanned.tokens[i + (comma ? 3 : 2)].end();
      continue;
    }
    const auto name = names.find(token.text);
    if (name == names.end()) continue;
    if (stays_as_field(name->second, scanned.tokens, i) && (field || is_given_as_field(scanned.tokens, i, names)))
      continue;
    out += text.substr(copied, token.offset - copied);
    out += name->second.text;
    copied = token.end();
  }
  apply_edits_before(text.size());
  out += text.substr(copied);
  if (out.empty() || out.back() != '\n') out += '\n';
  return out;
}

std::string original_names(std::string_view message) {
  constexpr std::string_view kMarks = "slr";  // of a stage, a library, an input that is read as storage
  // What functions of GLSL become in kernels.
  using Names = std::pair<std::string_view, std::string_view>;
  constexpr std::array kOfPrelude{Names{"ag_texture", "texture"}, Names{"ag_unpack_half", "unpackHalf2x16"},
                                  Names{"ag_pack_snorm", "packSnorm4x8"}};
  std::string out;
  for (std::size_t i = 0; i < message.size();) {
    const auto known = std::ranges::find_if(
        kOfPrelude, [&](const Names& names) { return message.substr(i).starts_with(names.first); });
    if (known != kOfPrelude.end()) {
      out += known->second;
      i += known->first.size();
      continue;
    }
    if (message.substr(i, 3) == "ag_" && i + 4 < message.size() && kMarks.find(message[i + 3]) != kMarks.npos) {
      std::size_t end = i + 4;
      while (end < message.size() && message[end] >= '0' && message[end] <= '9') ++end;
      if (end > i + 4 && end < message.size() && message[end] == '_') {
        i = end + 1;
        continue;
      }
    }
    out += message[i++];
  }
  return out;
}

}  // namespace afterglow

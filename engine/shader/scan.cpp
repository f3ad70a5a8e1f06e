// SPDX-License-Identifier: MIT
#include "shader/scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <set>
#include <span>

#include "core/text.h"
#include "shader/array_size.h"
#include "shader/builtins.h"
#include "shader/directives.h"
#include "shader/entry_point.h"
#include "shader/foreign_words.h"
#include "shader/literal.h"
#include "shader/macro_arguments.h"
#include "shader/qualifiers.h"
#include "shader/records.h"
#include "shader/workgroup.h"

namespace afterglow {
namespace {

constexpr std::size_t kMaxParams = 256;
constexpr std::size_t kMaxInputs = 16;

class ShaderScanner {
 public:
  ShaderScanner(const std::string& file, ScanAs as) : file_(file), as_(as) {}

  Result<ShaderScan> run(TextTokens text) {
    out_.tokens = std::move(text.tokens);
    for (const auto& token : out_.tokens) {
      if (token.is_identifier() && token.text.starts_with("ag_"))
        return fail(token, fmt::format("'{}': names that begin with 'ag_' belong to the engine", token.text));
      if (token.is("discard"))
        return fail(token,
                    "'discard' is not allowed: every pixel of an image gets a value; return the colour that came in");
      if (const auto why = why_not(token.text); token.is_identifier() && !why.empty())
        return fail(token, fmt::format("'{}' is not allowed: {}", token.text, why));
    }
    code_tokens_ = code_tokens(out_.tokens);
    for (const auto& token : code_tokens_) code_.push_back(&token);
    if (const Token* record = record_with_too_many_members(code_))
      return fail(*record, fmt::format("'{}' has more than {} members, with those of the records that it is made of",
                                       record->text, kMostMembers));
    AFTERGLOW_TRY(Directives directives, scan_directives(out_.tokens, file_));
    for (const auto& macro : directives.macros) AFTERGLOW_CHECK(add_name(macro, true));
    const FieldArguments fields = field_arguments(out_.tokens);
    for (auto& name : out_.names) {
      const auto macro = fields.find(name.name);
      if (macro == fields.end()) continue;
      name.with_arguments = true;
      name.field_arguments = macro->second;
    }
    out_.includes = std::move(directives.includes);
    out_.edits = std::move(directives.edits);
    for (const auto& [begin, end] : text.left_out) out_.edits.push_back({begin, end});
    while (at_ < code_.size()) AFTERGLOW_CHECK(declaration());
    if (as_ == ScanAs::stage) AFTERGLOW_CHECK(entry_point());
    for (std::size_t i = 0; i < out_.unset.size(); ++i) {
      const Unset& unset = out_.unset[i];
      if (unset.kind != Unset::Kind::global) out_.edits.push_back({unset.at, unset.at, -1, static_cast<int>(i)});
    }
    std::ranges::stable_sort(out_.edits, {}, &Edit::begin);
    return std::move(out_);
  }

 private:
  Error fail(int line, std::string message) const { return shader_error(file_, line, std::move(message)); }
  Error fail(const Token& token, std::string message) const { return fail(token.line, std::move(message)); }

  // ---- Declarations at file scope
  // -------------------------------------------------------------------------------------

  const Token& token(std::size_t ahead = 0) const {
    static const Token kEnd;
    return at_ + ahead < code_.size() ? *code_[at_ + ahead] : kEnd;
  }
  int line() const { return at_ < code_.size() ? code_[at_]->line : code_.empty() ? 1 : code_.back()->line; }

  Result<void> declaration() {
    if (token().is(";")) {
      ++at_;
      return {};
    }
    begin_ = at_;
    if (token().is("precision")) return skip_to_semicolon();
    bool is_const = false, is_uniform = false, is_shared = false, has_layout = false;
    std::size_t layout = 0;
    for (;; ++at_) {
      const Token& t = token();
      if (t.is("layout")) {
        has_layout = true;
        layout = at_;
        if (!token(1).is("(")) return fail(t, "layout needs (…)");
        at_ = after_closing(code_, at_ + 1) - 1;
      } else if (t.is("const")) {
        is_const = true;
      } else if (t.is("uniform")) {
        is_uniform = true;
      } else if (t.is("shared")) {
        is_shared = true;
      } else if (t.is("in") && has_layout && token(1).is(";")) {
        return workgroup(layout);
      } else if (t.is("in") || t.is("out") || t.is("inout") || t.is("buffer") || t.is("attribute") || t.is("varying")) {
        return fail(t,
                    fmt::format("'{}' is not allowed at file scope: images come as sampler2D or as arguments of apply, "
                                "parameters as uniforms",
                                t.text));
      } else if (!t.is("highp") && !t.is("mediump") && !t.is("lowp") && !t.is("precise") && !t.is("invariant")) {
        break;
      }
    }
    if (has_layout && is_const) return constant(layout);
    if (has_layout)
      return fail(*code_[layout], "layout is only known as layout(constant_id = N) const TYPE NAME = VALUE;");
    if (is_shared) return shared_variables();
    if (is_uniform) return uniform();
    if (token().is("struct")) return structure();
    if (!token().is_identifier() || token(1).is("(")) {
      Error error = fail(line(), "a declaration was expected here");
      if (token().is_identifier()) error.message += " (macros that make declarations are not supported)";
      return error;
    }
    const Token type = token();
    ++at_;
    while (token().is("[")) at_ = after_closing(code_, at_);
    if (!token().is_identifier()) return fail(line(), "a declaration was expected here");
    if (token(1).is_identifier()) {  // "static float k"
      const std::string_view instead = in_glsl(type.text);
      return fail(type, fmt::format("'{}' is no word of GLSL before a declaration{}", type.text,
                                    instead.empty() ? "" : fmt::format("; write {}", instead)));
    }
    if (token(1).is("(")) return function();
    return variables(is_const);
  }

  Result<void> skip_to_semicolon() {
    const int begin = line();
    while (at_ < code_.size() && !token().is(";")) {
      if (token().is("(") || token().is("[") || token().is("{")) {
        at_ = after_closing(code_, at_);
      } else {
        ++at_;
      }
    }
    if (at_ >= code_.size()) return fail(begin, "';' is missing after the declaration");
    ++at_;
    return {};
  }

  /// `layout(constant_id = N) const TYPE NAME = VALUE;`, at the type.
  Result<void> constant(std::size_t layout) {
    const Token& head = *code_[layout];
    const bool well_formed = code_.size() > layout + 5 && code_[layout + 2]->is("constant_id") &&
                             code_[layout + 3]->is("=") && code_[layout + 4]->kind == TokenKind::number &&
                             code_[layout + 5]->is(")");
    if (!well_formed) return fail(head, "layout is only known as layout(constant_id = N) const TYPE NAME = VALUE;");
    if (as_ == ScanAs::library)
      return fail(head, "a library declares no parameters; declare it in the shader and pass it on");
    const std::string id(code_[layout + 4]->text);
    if (!constant_ids_.insert(id).second) return fail(head, fmt::format("constant_id {} is used twice", id));
    const auto type = param_type_of(token().text);
    if (!type || component_count(*type) != 1) {
      Error error = fail(line(), fmt::format("a specialised constant cannot be of type '{}'", token().text));
      error.allowed = "bool, int, float";
      return error;
    }
    ++at_;
    const Token name = token();
    if (!name.is_identifier()) return fail(line(), "the constant has no name");
    ++at_;
    if (token().is("[")) return fail(name, fmt::format("'{}': arrays of constants are not supported", name.text));
    if (!token().is("=")) return fail(name, fmt::format("'{}' needs a default value: = VALUE", name.text));
    ++at_;
    bool negative = false;
    if (token().is("-") || token().is("+")) {
      negative = token().is("-");
      ++at_;
    }
    const auto value = literal_value(token(), *type);
    if (!value)
      return fail(line(), fmt::format("the default of '{}' must be a literal of type {}", name.text, glsl_name(*type)));
    ++at_;
    if (!token().is(";"))
      return fail(line(), fmt::format("the default of '{}' must be one literal, then ';'", name.text));
    ++at_;
    AFTERGLOW_CHECK(add_param({std::string(name.text), *type, true, negative ? -*value : *value, name.line}, name));
    out_.edits.push_back(
        {code_[begin_]->offset, code_[at_ - 1]->end(), static_cast<int>(out_.interface.params.size()) - 1});
    return {};
  }

  /// `uniform TYPE NAME, NAME;`, at the type.
  Result<void> uniform() {
    const Token type = token();
    if (as_ == ScanAs::library)
      return fail(type, "a library declares no uniforms; declare it in the shader and pass it on");
    if (!type.is_identifier()) return fail(line(), "a type was expected after 'uniform'");
    if (token(1).is("{"))
      return fail(type, fmt::format("uniform blocks are not supported ('{}'); write uniform TYPE NAME;", type.text));
    const bool sampler = type.is("sampler2D");
    const auto param = param_type_of(type.text);
    if (!sampler && !param) {
      Error error = fail(type, fmt::format("a uniform cannot be of type '{}'", type.text));
      error.allowed = join(uniform_types());
      error.nearest = nearest_name(type.text, uniform_types());
      return error;
    }
    do {
      ++at_;
      const Token name = token();
      if (name.is("["))
        return fail(name, fmt::format("the number of elements stands behind the name: uniform {} NAME[N];", type.text));
      if (!name.is_identifier()) return fail(line(), "the uniform has no name");
      ++at_;
      AFTERGLOW_TRY(const int elements, elements_of(name, param));
      if (token().is("="))
        return fail(name, fmt::format("'{}': a uniform has no default value; the effect gives it", name.text));
      if (sampler) {
        AFTERGLOW_CHECK(add_input({std::string(name.text), false, name.line}, name));
        AFTERGLOW_CHECK(add_name(name, false));
      } else {
        AFTERGLOW_CHECK(add_param({std::string(name.text), *param, false, 0, name.line, elements}, name));
      }
    } while (token().is(","));
    if (!token().is(";")) return fail(*code_[at_ - 1], "';' is missing after the uniform");
    ++at_;
    out_.edits.push_back({code_[begin_]->offset, code_[at_ - 1]->end()});
    return {};
  }

  /// `[N]` behind the name of a uniform; 0 where there is none. Samplers have no `param`.
  Result<int> elements_of(const Token& name, std::optional<ParamType> param) {
    if (!token().is("[")) return 0;
    if (!param || matrix_side(*param) > 0 || *param == ParamType::bool1)
      return fail(name,
                  fmt::format("'{}': arrays of this type are not supported; declare each by its name", name.text));
    const auto elements = array_size(out_.tokens, token(1));
    if (!elements || *elements < 1 || *elements > kMostElements || !token(2).is("]") || token(3).is("[")) {
      Error error = fail(name, fmt::format("'{}': the number of elements is a whole number, or a name that #define or "
                                           "const int gives one",
                                           name.text));
      error.allowed = fmt::format("1 to {}", kMostElements);
      return error;
    }
    at_ += 3;
    return *elements;
  }

  /// `layout(local_size_x = N, …) in;`, at `in`.
  Result<void> workgroup(std::size_t layout) {
    const Token& head = *code_[layout];
    if (as_ == ScanAs::library) return fail(head, "the size of workgroups is declared in the shader, not in a library");
    if (out_.interface.workgroup) return fail(head, "the size of workgroups is declared twice");
    AFTERGLOW_TRY(out_.interface.workgroup,
                  parse_workgroup(head, std::span(code_).subspan(layout + 2, at_ - layout - 3), file_));
    at_ += 2;
    workgroup_line_ = head.line;
    out_.edits.push_back({code_[begin_]->offset, code_[at_ - 1]->end()});
    return {};
  }

  /// `shared TYPE NAME[N], NAME;`, at the type.
  Result<void> shared_variables() {
    const std::string type(token().text);
    AFTERGLOW_CHECK(check_shared_type(token(), file_));
    do {
      ++at_;
      const Token name = token();
      if (!name.is_identifier()) return fail(line(), "the shared variable has no name");
      AFTERGLOW_CHECK(add_name(name, false));
      ++at_;
      const bool array = token().is("[");
      if (array) at_ = after_closing(code_, at_);
      if (token().is("[")) return fail(name, fmt::format("'{}': shared arrays have one dimension", name.text));
      if (token().is("="))
        return fail(name, fmt::format("'{}': a shared variable begins as zeros and takes no other value", name.text));
      out_.shared.push_back({std::string(name.text), type, array, name.line});
    } while (token().is(","));
    if (!token().is(";")) return fail(line(), "';' is missing after the declaration");
    ++at_;
    return {};
  }

  Result<void> structure() {
    ++at_;
    if (token().is_identifier()) {
      AFTERGLOW_CHECK(add_name(token(), false));
      ++at_;
    }
    if (!token().is("{")) return fail(line(), "'{' was expected after 'struct'");
    at_ = after_closing(code_, at_);
    if (token().is(";")) {
      ++at_;
      return {};
    }
    return variables(false);
  }

  /// `NAME [..] = …, NAME …;`, at the first name.
  Result<void> variables(bool is_const) {
    bool expects_name = true, has_value = false;
    out_.keeps_state = out_.keeps_state || !is_const;
    const auto end = [&] {
      if (has_value) out_.unset.pop_back();
      has_value = false;
    };
    while (at_ < code_.size() && (expects_name || !token().is(";"))) {
      if (expects_name) {
        if (!token().is_identifier()) return fail(line(), "a name was expected in the declaration");
        AFTERGLOW_CHECK(add_name(token(), false));
        out_.unset.push_back({std::string(token().text), token().line, Unset::Kind::global});
        expects_name = false;
        ++at_;
      } else if (token().is("(") || token().is("[") || token().is("{")) {
        at_ = after_closing(code_, at_);
      } else {
        has_value = has_value || token().is("=");
        expects_name = token().is(",");
        if (expects_name) end();
        ++at_;
      }
    }
    end();
    if (at_ >= code_.size()) return fail(line(), "';' is missing after the declaration");
    ++at_;
    return {};
  }

  /// `NAME(…) { … }` or `NAME(…);`, at the name; the type is the token before.
  Result<void> function() {
    const Token name = token();
    const Token result = *code_[at_ - 1];
    const std::size_t arguments = at_ + 1;
    at_ = after_closing(code_, arguments);
    const bool body = token().is("{");
    if (!body && !token().is(";")) return fail(name, fmt::format("'{{' or ';' was expected after {}(…)", name.text));
    const std::size_t arguments_end = at_ - 1;
    const std::size_t begin = at_;
    at_ = body ? after_closing(code_, at_) : at_ + 1;
    if (body) {
      const auto statements = std::span(code_).subspan(begin, at_ - begin);
      find_unset(std::span(code_).subspan(arguments + 1, arguments_end - arguments - 1), statements, out_.unset);
      find_unset_result(result, name, statements, out_.unset);
    }
    if (name.is("main")) return fail(name, "main is made by the engine; define one of " + entry_signatures());
    if (is_builtin_function(name.text))
      return fail(name, fmt::format("'{}' is a built-in function of GLSL; choose another name", name.text));
    if (const auto kind = kind_of_entry(name.text)) {
      if (as_ == ScanAs::library)
        return fail(
            name, fmt::format("'{}' is defined in an included file; an include is a library of functions", name.text));
      if (body) AFTERGLOW_CHECK(entry(*kind, name, result, arguments, arguments_end));
    }
    if (name.is(kDoneFunction) && as_ == ScanAs::stage) {
      AFTERGLOW_CHECK(check_done_function(
          result, name, std::span(code_).subspan(arguments + 1, arguments_end - arguments - 1), file_));
      if (body) done_line_ = name.line;
    }
    return add_name(name, false);
  }

  // ---- The entry point ----------------------------------------------------------------------------------------------

  Result<void> entry(PassKind kind, const Token& name, const Token& result, std::size_t open, std::size_t close) {
    if (entry_line_ && out_.interface.kind != kind)
      return fail(name,
                  fmt::format("a shader defines one of {}; the other is at line {}", entry_names(), *entry_line_));
    if (entry_line_)
      return fail(name, fmt::format("'{}' is defined a second time; the first is at line {}", name.text, *entry_line_));
    entry_line_ = name.line;
    AFTERGLOW_TRY(const EntryPoint parsed,
                  parse_entry_point(kind, result, name, std::span(code_).subspan(open + 1, close - open - 1), file_));
    out_.interface.kind = kind;
    out_.interface.at_pixel = parsed.at_pixel;
    for (const auto& input : parsed.inputs)
      AFTERGLOW_CHECK(add_input({std::string(input.text), true, input.line}, input));
    return {};
  }

  /// Once everything is read: exactly one entry point, and names that a pass can give.
  Result<void> entry_point() {
    if (!entry_line_) {
      Error error = fail(0, fmt::format("the shader {} defines none of {}", file_, entry_names()));
      error.allowed = entry_signatures();
      std::vector<std::string> entries = split(entry_names(), ',');
      for (auto& entry : entries) entry = trim(entry);
      // Shadertoy's, mpv's and a whole shader's.
      static const std::set<std::string_view> kElsewhere{"mainImage", "hook", "main"};
      for (const auto& name : out_.names) {
        if (name.macro) continue;
        error.nearest = kElsewhere.contains(name.name) ? "sample_at" : nearest_name(name.name, entries);
        if (error.nearest.empty()) continue;
        error.line = name.line;
        break;
      }
      return error;
    }
    AFTERGLOW_CHECK(groups());
    out_.interface.done = done_line_.has_value();
    if (done_line_ && out_.interface.kind != PassKind::sample)
      return fail(*done_line_, fmt::format("{} stands beside sample_at alone", kDoneFunction));
    const bool pixel = out_.interface.kind == PassKind::pixel;
    for (const auto& input : out_.interface.inputs) AFTERGLOW_CHECK(pass_key(input.name, input.line, pixel));
    for (const auto& param : out_.interface.params) AFTERGLOW_CHECK(pass_key(param.name, param.line, true));
    return {};
  }

  /// Workgroups and what they share belong to compute shaders.
  Result<void> groups() const {
    if (out_.interface.kind == PassKind::compute) {
      if (out_.interface.workgroup) return {};
      Error error = fail(*entry_line_, "a compute shader declares the size of its workgroups");
      error.allowed = "layout(local_size_x = 16, local_size_y = 8) in;";
      return error;
    }
    if (workgroup_line_) return fail(*workgroup_line_, "workgroups are for compute shaders (compute_at)");
    if (!out_.shared.empty()) return fail(out_.shared.front().line, "'shared' is for compute shaders (compute_at)");
    return {};
  }

  /// Inputs and parameters are keys of g:pass{…}; its own keys cannot be their names.
  Result<void> pass_key(const std::string& name, int line, bool source_is_taken) const {
    if (name == "source" && source_is_taken)
      return fail(line,
                  "'source' is what apply gets as its first argument; leave the uniform out, or write sample_at, "
                  "which reads any pixel of it");
    if (std::ranges::find(pass_keys(), name) != pass_keys().end())
      return fail(line, fmt::format("'{}' is a key of g:pass itself; choose another name", name));
    if (kind_of_entry(name))
      return fail(line, fmt::format("'{}' is a function that the engine calls; choose another name", name));
    return {};
  }

  // ---- What was found -----------------------------------------------------------------------------------------------

  Result<void> add_param(ShaderParam param, const Token& name) {
    if (!input_names_.insert(param.name).second) return fail(name, fmt::format("'{}' is declared twice", name.text));
    if (out_.interface.params.size() >= kMaxParams)
      return fail(name, fmt::format("a shader has at most {} parameters", kMaxParams));
    param_bytes_ += param.specialised ? 0 : block_bytes(param.type, param.elements);
    if (param_bytes_ > kMostParamBytes)
      return fail(name, fmt::format("the parameters of a shader take more than {} bytes, of which each number, vector, "
                                    "column of a matrix and element takes 16",
                                    kMostParamBytes));
    out_.interface.params.push_back(std::move(param));
    return add_name(name, false);
  }

  Result<void> add_input(ShaderInput input, const Token& name) {
    if (!input_names_.insert(input.name).second) return fail(name, fmt::format("'{}' is declared twice", name.text));
    if (out_.interface.inputs.size() >= kMaxInputs)
      return fail(name, fmt::format("a shader reads at most {} images", kMaxInputs));
    out_.interface.inputs.push_back(std::move(input));
    return {};
  }

  Result<void> add_name(const Token& name, bool macro) {
    if (is_prelude_function(name.text))
      return fail(name, fmt::format("'{}' is a helper that every shader has; choose another name", name.text));
    if (seen_.insert(std::string(name.text)).second) out_.names.push_back({std::string(name.text), macro, name.line});
    return {};
  }

  const std::string& file_;
  const ScanAs as_;
  ShaderScan out_;
  std::vector<Token> code_tokens_;
  std::vector<const Token*> code_;  ///< tokens that are not of the preprocessor, with qualifiers as they are meant
  std::size_t at_ = 0;              ///< index into code_
  std::size_t begin_ = 0;           ///< where the declaration begins
  std::set<std::string> constant_ids_, input_names_, seen_;
  int param_bytes_ = 0;
  std::optional<int> entry_line_, workgroup_line_, done_line_;
};

}  // namespace

Result<ShaderScan> scan(std::string_view text, const std::string& file, ScanAs as) {
  AFTERGLOW_TRY(auto tokens, tokenize(text, file));
  return ShaderScanner(file, as).run(std::move(tokens));
}

Result<std::shared_ptr<const ShaderFile>> scan_file(std::string text, const std::string& file, ScanAs as) {
  auto scanned = std::make_shared<ShaderFile>();
  scanned->text = std::move(text);
  AFTERGLOW_TRY(scanned->scan, scan(scanned->text, file, as));
  return std::shared_ptr<const ShaderFile>(std::move(scanned));
}

}  // namespace afterglow

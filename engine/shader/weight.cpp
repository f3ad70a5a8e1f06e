// SPDX-License-Identifier: MIT
#include "shader/weight.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "core/saturated.h"
#include "shader/rename.h"
#include "shader/scan.h"
#include "shader/spirv_module.h"
#include "shader/token.h"
#include "shader/workgroup.h"

namespace afterglow {
namespace {

std::string bytes_of(std::uint64_t bytes) {
  return bytes >= 1ull << 40 ? "more than 1 TiB" : fmt::format("{} bytes", bytes);
}

struct Place {
  std::string file;
  int line = 0;
};

/// Where an author declares a name: where it stands behind a type. Nowhere when a macro hides it.
class Places {
 public:
  explicit Places(const KernelDesc& kernel) {
    if (kernel.sample) add(*kernel.sample->shader);
    for (const auto& stage : kernel.stages) add(*stage.shader);
  }
  Place of(const std::string& name) const {
    for (const auto& [path, text] : texts_) {
      const std::vector<Token> tokens = tokens_of(text, path);
      for (std::size_t i = 1; i < tokens.size(); ++i) {
        const Token &before = tokens[i - 1], &token = tokens[i];
        const bool declares = (before.is_identifier() && !before.is("return")) || before.is("]") || before.is(",");
        if (declares && token.is_identifier() && token.text == name) return {path, token.line};
      }
    }
    return nowhere();
  }
  /// Constants have no names behind the compiler. The constructor with the most elements: `float[3](1.0, 2.0, 3.0)`.
  Place of_constant() const {
    Place place = nowhere();
    std::size_t most = 0;
    for (const auto& [path, text] : texts_) {
      const std::vector<Token> tokens = tokens_of(text, path);
      for (std::size_t i = 1; i < tokens.size(); ++i) {
        if (!tokens[i].is("(") || !tokens[i - 1].is("]")) continue;
        const std::size_t count = elements(tokens, i);
        if (count > most) place = {path, tokens[i].line};
        most = std::max(most, count);
      }
    }
    return place;
  }

 private:
  Place nowhere() const { return {texts_.empty() ? std::string() : texts_.front().first, 0}; }
  static std::vector<Token> tokens_of(std::string_view text, const std::string& path) {
    auto out = tokenize(text, path);
    return out ? std::move(out->tokens) : std::vector<Token>();
  }
  /// How many stand between the parenthesis at `open` and its other one.
  static std::size_t elements(const std::vector<Token>& tokens, std::size_t open) {
    std::size_t count = 1;
    int depth = 0;
    for (std::size_t i = open; i < tokens.size(); ++i) {
      depth += tokens[i].is("(") ? 1 : tokens[i].is(")") ? -1 : 0;
      if (depth == 0) break;
      count += depth == 1 && tokens[i].is(",") ? 1 : 0;
    }
    return count;
  }
  void add(const ShaderSource& source) {
    texts_.emplace_back(source.path.string(), source.file->text);
    for (const auto& include : source.includes) texts_.emplace_back(include.path.string(), include.file->text);
  }
  std::vector<std::pair<std::string, std::string>> texts_;
};

struct Function {
  std::uint64_t held = 0, copied = 0, instructions = 0, loops = 0;  ///< bytes, bytes, count, count
  std::vector<std::uint32_t> calls;
};

class Scales {
 public:
  Scales(const Module& module, const KernelDesc& kernel) : kernel_(kernel) {
    for (const auto& i : module.code) read(i);
  }

  std::uint64_t shared() const { return shared_; }

  Result<void> check() {
    if (shared_ > kMaxSharedBytes)
      return fail(largest_shared_.second,
                  fmt::format("the workgroup shares {}, the largest of them '{{}}'", bytes_of(shared_)),
                  fmt::format("at most {} bytes", kMaxSharedBytes));
    if (largest_.first > kMaxVariableBytes) return too_large();
    Function all = with_calls(main_);
    for (auto* count : {&all.held, &all.copied, &all.instructions, &all.loops})
      *count /= static_cast<unsigned>(kernel_.config.rows);
    if (const std::uint64_t held = saturated_sum({file_scope_, all.held}); held > kMaxHeldBytes)
      return fail(largest_.second,
                  fmt::format("the shader holds {} in arrays, the largest of them '{{}}'", bytes_of(held)),
                  fmt::format("at most {} bytes; a function's count once for each call", kMaxHeldBytes));
    if (all.copied > kMaxCopiedBytes)
      return fail(copied_,
                  fmt::format("the shader copies arrays of {} as a whole, among them '{{}}'", bytes_of(all.copied)),
                  fmt::format("at most {} bytes; give each element by itself", kMaxCopiedBytes));
    if (all.instructions > kMaxInstructions) return too_long();
    const bool joined = kernel_.stages.size() + (kernel_.sample ? 1 : 0) > 1 && kernel_.config.fusion == Fusion::all;
    if (joined && all.loops > kMaxJoinedLoops)
      return fail(main_, fmt::format("passes that are joined in '{{}}' have {} loops", all.loops),
                  fmt::format("at most {}", kMaxJoinedLoops));
    return {};
  }

 private:
  void read(const Instruction& i) {
    const Words& w = i.words;
    switch (i.op) {
      case spv::OpName:
        names_[w[1]] = reinterpret_cast<const char*>(&w[2]);
        break;
      case spv::OpEntryPoint:
        main_ = w[2];
        break;
      case spv::OpConstant:
        if (w.size() == 4) numbers_[i.result] = w[3];
        break;
      case spv::OpTypeBool:
        bytes_[w[1]] = 4;
        break;
      case spv::OpTypeInt:
      case spv::OpTypeFloat:
        bytes_[w[1]] = w[2] / 8;
        break;
      case spv::OpTypeVector:
      case spv::OpTypeMatrix:
        bytes_[w[1]] = saturated_product({bytes_[w[2]], w[3]});
        break;
      case spv::OpTypeArray:
        bytes_[w[1]] = saturated_product({bytes_[w[2]], numbers_[w[3]]});
        arrays_.insert(w[1]);
        break;
      case spv::OpTypeStruct:
        bytes_[w[1]] = 0;
        for (std::size_t member = 2; member < w.size(); ++member) {
          bytes_[w[1]] = saturated_sum({bytes_[w[1]], bytes_[w[member]]});
          if (arrays_.contains(w[member])) arrays_.insert(w[1]);
        }
        break;
      case spv::OpTypePointer:
        pointees_[w[1]] = w[3];
        break;
      case spv::OpVariable:
        variable(i);
        break;
      case spv::OpFunction:
        function_ = &functions_[i.result];
        break;
      case spv::OpFunctionEnd:
        function_ = nullptr;
        break;
      default:
        if (i.type != 0) keep_largest(bytes_[i.type], i.result);
        if (function_) instruction(i);
    }
  }

  void variable(const Instruction& i) {
    const std::uint64_t bytes = bytes_[pointees_[i.type]];
    if (i.words[3] == spv::StorageClassWorkgroup) {
      shared_ = saturated_sum({shared_, bytes});
      if (bytes > largest_shared_.first) largest_shared_ = {bytes, i.result};
    }
    if (i.words[3] != spv::StorageClassFunction && i.words[3] != spv::StorageClassPrivate) return;
    keep_largest(bytes, i.result);
    if (!arrays_.contains(pointees_[i.type])) return;
    std::uint64_t& held = function_ ? function_->held : file_scope_;
    held = saturated_sum({held, bytes});
  }

  void instruction(const Instruction& i) {
    ++function_->instructions;
    if (i.op == spv::OpLoopMerge) ++function_->loops;
    if (i.op == spv::OpFunctionCall) function_->calls.push_back(i.words[3]);
    // What goes back to where it came from is the mark of a variable without a value (shader/give_values.h).
    const bool mark = load_ && i.op == spv::OpStore && i.words[1] == load_->words[3] && i.words[2] == load_->result;
    if (load_ && !mark) {
      function_->copied = saturated_sum({function_->copied, bytes_[load_->type]});
      copied_ = load_->words[3];
    }
    load_ = i.op == spv::OpLoad && arrays_.contains(i.type) ? &i : nullptr;
  }

  void keep_largest(std::uint64_t bytes, std::uint32_t id) {
    const bool better_known = bytes == largest_.first && !names_.contains(largest_.second) && names_.contains(id);
    if (bytes > largest_.first || better_known) largest_ = {bytes, id};
  }

  /// What a function and all that it calls come to. GLSL has no recursion.
  Function with_calls(std::uint32_t id) {
    if (const auto known = whole_.find(id); known != whole_.end()) return known->second;
    Function out = functions_[id];
    for (const auto call : out.calls) {
      const Function called = with_calls(call);
      out.held = saturated_sum({out.held, called.held});
      out.copied = saturated_sum({out.copied, called.copied});
      out.instructions = saturated_sum({out.instructions, called.instructions});
      out.loops = saturated_sum({out.loops, called.loops});
    }
    return whole_[id] = std::move(out);
  }

  Error too_large() const {
    return fail(largest_.second, fmt::format("'{{}}' takes {}", bytes_of(largest_.first)),
                fmt::format("at most {} bytes each", kMaxVariableBytes));
  }

  /// Names the smallest function that is too long by itself, else the longest.
  Error too_long() {
    std::uint32_t named = main_;
    std::uint64_t least = kSaturated, most = 0;
    for (const auto& [id, function] : functions_) {
      const std::uint64_t count = with_calls(id).instructions;
      if (id == main_ || (count <= kMaxInstructions ? least < kSaturated || count < most : count > least)) continue;
      (count <= kMaxInstructions ? most : least) = count;
      named = id;
    }
    const std::string count = least == kSaturated ? "too many" : fmt::format("{}", least);
    return fail(named, fmt::format("'{{}}' comes to {} instructions with all that it calls", count),
                fmt::format("at most {}; a function's count once for each call", kMaxInstructions));
  }

  /// `message` has a place for the name.
  Error fail(std::uint32_t id, const std::string& message, std::string allowed) const {
    const auto named = names_.find(id);
    std::string name = named == names_.end() ? std::string() : original_names(named->second);
    name = name.substr(0, name.find('('));  // functions bring the types of their arguments along
    Place place = Places(kernel_).of(name);
    if (name.empty() || (name == "indexable" && place.line == 0)) {  // the compiler's copy of a constant
      name.clear();
      place = Places(kernel_).of_constant();
    }
    Error error =
        shader_error(place.file, place.line, fmt::format(fmt::runtime(message), name.empty() ? "an array" : name));
    error.allowed = std::move(allowed);
    return error;
  }

  const KernelDesc& kernel_;
  std::map<std::uint32_t, std::string> names_;
  std::map<std::uint32_t, std::uint64_t> numbers_, bytes_;  ///< of constants; of types
  std::map<std::uint32_t, std::uint32_t> pointees_;
  std::set<std::uint32_t> arrays_;  ///< types with arrays in them
  std::map<std::uint32_t, Function> functions_, whole_;
  Function* function_ = nullptr;
  const Instruction* load_ = nullptr;  ///< of an array, just before
  std::uint64_t file_scope_ = 0;
  std::pair<std::uint64_t, std::uint32_t> largest_{0, 0}, largest_shared_{0, 0};
  std::uint64_t shared_ = 0;
  std::uint32_t main_ = 0, copied_ = 0;
};

}  // namespace

std::uint64_t shared_bytes(const std::vector<std::uint32_t>& spirv) {
  const auto module = parse(spirv);
  return module ? Scales(*module, {}).shared() : 0;
}

Result<void> check_weight(const std::vector<std::uint32_t>& spirv, const KernelDesc& kernel) {
  const auto module = parse(spirv);
  return module ? Scales(*module, kernel).check() : Result<void>();
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "shader/whole_numbers.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "shader/spirv_loops.h"

namespace afterglow {
namespace {

/// Of GLSL.std.450.
enum class Glsl : std::uint32_t {
  s_abs = 5,
  u_min = 38,
  s_min = 39,
  u_max = 41,
  s_max = 42,
  u_clamp = 44,
  s_clamp = 45
};

std::int32_t signed_of(std::uint32_t value) { return static_cast<std::int32_t>(value); }
std::uint32_t as_bits(std::int32_t value) { return static_cast<std::uint32_t>(value); }

using Value = std::optional<std::uint32_t>;

Value of_two(spv::Op op, std::uint32_t a, std::uint32_t b) {
  constexpr std::uint32_t kBits = 32;
  const bool positive = signed_of(a) >= 0 && signed_of(b) > 0;
  switch (op) {
    case spv::OpIAdd:
      return a + b;
    case spv::OpISub:
      return a - b;
    case spv::OpIMul:
      return a * b;
    case spv::OpSDiv:  // what becomes of others, devices choose
      return positive ? Value(a / b) : std::nullopt;
    case spv::OpSMod:
    case spv::OpSRem:
      return positive ? Value(a % b) : std::nullopt;
    case spv::OpUDiv:
      return b != 0 ? Value(a / b) : std::nullopt;
    case spv::OpUMod:
      return b != 0 ? Value(a % b) : std::nullopt;
    case spv::OpBitwiseAnd:
      return a & b;
    case spv::OpBitwiseOr:
      return a | b;
    case spv::OpBitwiseXor:
      return a ^ b;
    case spv::OpShiftLeftLogical:
      return b < kBits ? Value(a << b) : std::nullopt;
    case spv::OpShiftRightLogical:
      return b < kBits ? Value(a >> b) : std::nullopt;
    case spv::OpShiftRightArithmetic:
      return b < kBits ? Value(as_bits(signed_of(a) >> b)) : std::nullopt;
    default:
      return std::nullopt;
  }
}

Value compared(spv::Op op, std::uint32_t a, std::uint32_t b) {
  switch (op) {
    case spv::OpIEqual:
      return a == b;
    case spv::OpINotEqual:
      return a != b;
    case spv::OpSLessThan:
      return signed_of(a) < signed_of(b);
    case spv::OpSLessThanEqual:
      return signed_of(a) <= signed_of(b);
    case spv::OpSGreaterThan:
      return signed_of(a) > signed_of(b);
    case spv::OpSGreaterThanEqual:
      return signed_of(a) >= signed_of(b);
    case spv::OpULessThan:
      return a < b;
    case spv::OpULessThanEqual:
      return a <= b;
    case spv::OpUGreaterThan:
      return a > b;
    case spv::OpUGreaterThanEqual:
      return a >= b;
    case spv::OpLogicalAnd:
      return a & b;
    case spv::OpLogicalOr:
      return a | b;
    default:
      return std::nullopt;
  }
}

Value of_function(Glsl function, const Words& of) {
  if (of.size() == 1 && function == Glsl::s_abs) return signed_of(of[0]) < 0 ? 0 - of[0] : of[0];
  const auto least = [&](std::uint32_t a, std::uint32_t b) { return signed_of(a) < signed_of(b) ? a : b; };
  const auto most = [&](std::uint32_t a, std::uint32_t b) { return signed_of(a) < signed_of(b) ? b : a; };
  if (of.size() == 2) {
    if (function == Glsl::u_min) return std::min(of[0], of[1]);
    if (function == Glsl::u_max) return std::max(of[0], of[1]);
    if (function == Glsl::s_min) return least(of[0], of[1]);
    if (function == Glsl::s_max) return most(of[0], of[1]);
  }
  if (of.size() == 3) {
    if (function == Glsl::u_clamp && of[1] <= of[2]) return std::min(std::max(of[0], of[1]), of[2]);
    if (function == Glsl::s_clamp && signed_of(of[1]) <= signed_of(of[2])) return least(most(of[0], of[1]), of[2]);
  }
  return std::nullopt;
}

class Folder {
 public:
  Folder(Module& module, std::size_t function) : module_(module), begin_(function), end_(function) {
    for (const auto& i : module_.code) {
      if (i.op == spv::OpFunction) break;
      declaration(i);
    }
    for (; module_.code[end_].op != spv::OpFunctionEnd; ++end_) {
      const Instruction& i = module_.code[end_];
      if (i.op == spv::OpVariable && pointers_.contains(i.type)) variables_.insert(i.result);
    }
  }

  void run() {
    find_blocks();
    Known known;
    std::uint32_t label = 0;
    for (std::size_t at = begin_; at < end_; ++at) {
      Instruction& i = module_.code[at];
      i = renamed(std::move(i), names_);
      if (i.op == spv::OpLabel) {
        if (label != 0) known_behind_[label] = std::move(known);
        label = i.result;
        known = known_before(label);
      } else if (i.op == spv::OpPhi) {
        meet(i, label);
      } else {
        instruction(at, known);
      }
      for (const auto to : targets_of(i))
        if (never_entered(label) || !may_go(i, to)) closed_.insert({label, to});
    }
    // Where values meet, they may be used before they are made. What turned out to be a constant is used no more.
    const auto first_of = module_.code.begin() + static_cast<std::ptrdiff_t>(begin_);
    const auto end_of = module_.code.begin() + static_cast<std::ptrdiff_t>(end_);
    const auto is_known = [&](const Instruction& i) { return i.op == spv::OpPhi && names_.contains(i.result); };
    const auto end_left = std::remove_if(first_of, end_of, is_known);
    for (auto at = first_of; at != end_left; ++at)
      if (at->op == spv::OpPhi) *at = renamed(std::move(*at), names_);
    module_.code.erase(end_left, end_of);
    const auto first = std::ranges::find(module_.code, spv::OpFunction, &Instruction::op);
    module_.code.insert(first, declared_.begin(), declared_.end());
  }

 private:
  using Known = std::map<std::uint32_t, std::uint32_t>;  ///< variable → constant that it holds
  struct Number {
    std::uint32_t type = 0, value = 0;
    friend bool operator<(const Number& a, const Number& b) {
      return std::tie(a.type, a.value) < std::tie(b.type, b.value);
    }
  };

  void declaration(const Instruction& i) {
    if (i.op == spv::OpTypeInt && i.words[2] == 32) types_.insert(i.words[1]);
    if (i.op == spv::OpTypeBool) bool_ = i.words[1];
    if (i.op == spv::OpTypePointer && i.words[2] == spv::StorageClassFunction && types_.contains(i.words[3]))
      pointers_.insert(i.words[1]);
    if (i.op == spv::OpExtInstImport && std::string_view(reinterpret_cast<const char*>(&i.words[2])) == "GLSL.std.450")
      glsl_ = i.result;
    if (i.op == spv::OpConstant && types_.contains(i.type)) {
      numbers_[i.result] = i.words[3];
      constants_.emplace(Number{i.type, i.words[3]}, i.result);
    }
    if (i.op == spv::OpConstantTrue || i.op == spv::OpConstantFalse) {
      numbers_[i.result] = i.op == spv::OpConstantTrue;
      constants_.emplace(Number{i.type, i.op == spv::OpConstantTrue}, i.result);
    }
  }

  void find_blocks() {
    std::uint32_t label = 0;
    for (std::size_t at = begin_; at < end_; ++at) {
      const Instruction& i = module_.code[at];
      if (i.op == spv::OpLabel) label = i.result;
      for (const auto to : targets_of(i)) from_[to].push_back(label);
    }
    for (auto& loop : find_loops(module_))
      if (loop.function == begin_) loops_.emplace(loop.header, std::move(loop));
    for (std::size_t at = begin_; at < end_; ++at) {
      const Instruction& i = module_.code[at];
      if (i.op == spv::OpLabel) label = i.result;
      if (i.op == spv::OpVariable || i.op == spv::OpLoad) continue;
      for (const auto word : i.ids)
        if (variables_.contains(i.words[word])) written_[label].insert(i.words[word]);
    }
  }

  /// What all ways to a block agree on. Into a loop that is what was known before it and no turn writes.
  Known known_before(std::uint32_t label) const {
    const auto ways = from_.find(label);
    if (ways == from_.end()) return {};
    const auto loop = loops_.find(label);
    std::optional<Known> out;
    for (const auto way : ways->second) {
      if ((is_closed(way, label) && !never_entered(label)) ||
          (loop != loops_.end() && loop->second.blocks.contains(way)))
        continue;
      const auto known = known_behind_.find(way);
      if (known == known_behind_.end()) return {};
      if (!out)
        out = known->second;
      else
        std::erase_if(*out, [&](const auto& held) {
          const auto other = known->second.find(held.first);
          return other == known->second.end() || other->second != held.second;
        });
    }
    if (!out) return {};
    if (loop != loops_.end())
      for (const auto block : loop->second.blocks)
        if (const auto written = written_.find(block); written != written_.end())
          for (const auto variable : written->second) out->erase(variable);
    return std::move(*out);
  }

  /// A branch whose condition is known goes one way.
  bool may_go(const Instruction& i, std::uint32_t to) const {
    if (i.op != spv::OpBranchConditional) return true;
    const auto condition = numbers_.find(i.words[1]);
    return condition == numbers_.end() || to == i.words[condition->second != 0 ? 2 : 3];
  }
  bool is_closed(std::uint32_t way, std::uint32_t label) const { return closed_.contains({way, label}); }
  bool never_entered(std::uint32_t label) const {
    const auto ways = from_.find(label);
    return ways != from_.end() &&
           std::ranges::all_of(ways->second, [&](std::uint32_t way) { return is_closed(way, label); });
  }

  /// Where ways meet of which one alone can be gone, its value is known.
  void meet(const Instruction& phi, std::uint32_t label) {
    std::set<std::uint32_t> values;
    for (std::size_t word = 3; word + 1 < phi.words.size(); word += 2)
      if (!is_closed(phi.words[word + 1], label)) values.insert(phi.words[word]);
    if (values.size() == 1 && numbers_.contains(*values.begin())) names_[phi.result] = *values.begin();
  }

  void instruction(std::size_t at, Known& known) {
    const Instruction &i = module_.code[at], &next = module_.code[at + 1];
    if (i.op == spv::OpVariable) return;
    if (i.op == spv::OpLoad) {
      const bool goes_back = next.op == spv::OpStore && next.words[1] == i.words[3] && next.words[2] == i.result;
      const auto held = known.find(i.words[3]);
      if (held != known.end() && !goes_back) names_[i.result] = held->second;  // see shader/give_values.h
      return;
    }
    for (const auto word : i.ids)
      if (variables_.contains(i.words[word])) known.erase(i.words[word]);
    if (i.op == spv::OpStore) {
      if (variables_.contains(i.words[1]) && numbers_.contains(i.words[2])) known[i.words[1]] = i.words[2];
      return;
    }
    if (!types_.contains(i.type) && i.type != bool_) return;
    if (i.op == spv::OpSelect) {
      const auto condition = numbers_.find(i.words[3]);
      if (condition == numbers_.end()) return;
      const std::uint32_t chosen = i.words[condition->second != 0 ? 4 : 5];
      if (numbers_.contains(chosen)) names_[i.result] = chosen;
      return;
    }
    if (const Value value = value_of(i)) names_[i.result] = constant({i.type, *value});
  }

  Value value_of(const Instruction& i) const {
    const bool function = i.op == spv::OpExtInst && i.words[3] == glsl_;
    Words of;
    for (std::size_t word = function ? 5 : 3; word < i.words.size(); ++word) {
      const auto number = numbers_.find(i.words[word]);
      if (number == numbers_.end()) return std::nullopt;
      of.push_back(number->second);
    }
    if (function) return of_function(static_cast<Glsl>(i.words[4]), of);
    if (i.op == spv::OpBitcast && of.size() == 1) return of[0];
    if (i.op == spv::OpSNegate && of.size() == 1) return 0 - of[0];
    if (i.op == spv::OpLogicalNot && of.size() == 1) return 1 - of[0];
    if (of.size() != 2) return std::nullopt;
    return i.type == bool_ ? compared(i.op, of[0], of[1]) : of_two(i.op, of[0], of[1]);
  }

  std::uint32_t constant(Number number) {
    auto& id = constants_[number];
    if (id != 0) return id;
    id = module_.fresh();
    Instruction i =
        number.type != bool_
            ? Instruction::of_words(spv::OpConstant, {number.type, id, number.value})
            : Instruction::of_words(number.value != 0 ? spv::OpConstantTrue : spv::OpConstantFalse, {number.type, id});
    i.type = number.type;
    i.result = id;
    i.ids = {1, 2};
    declared_.push_back(std::move(i));
    numbers_[id] = number.value;
    return id;
  }

  Module& module_;
  std::size_t begin_, end_;
  std::uint32_t glsl_ = 0, bool_ = 0;
  std::set<std::uint32_t> types_, pointers_, variables_;  ///< of whole numbers
  std::map<std::uint32_t, std::uint32_t> numbers_;        ///< constant → value; of truth 0 or 1
  std::map<Number, std::uint32_t> constants_;
  std::vector<Instruction> declared_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> from_;  ///< block → those that go to it
  std::map<std::uint32_t, Loop> loops_;                       ///< by header
  std::map<std::uint32_t, std::set<std::uint32_t>> written_;  ///< block → variables
  std::map<std::uint32_t, Known> known_behind_;               ///< block → what holds at its end
  std::set<std::pair<std::uint32_t, std::uint32_t>> closed_;  ///< ways from block to block that are never gone
  Renaming names_;
};

}  // namespace

void know_whole_numbers(Module& module, std::size_t function) { Folder(module, function).run(); }

}  // namespace afterglow

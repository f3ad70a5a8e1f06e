// SPDX-License-Identifier: MIT
#include "shader/held_divisors.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace afterglow {
namespace {

bool divides(spv::Op op) {
  return op == spv::OpSDiv || op == spv::OpUDiv || op == spv::OpSRem || op == spv::OpSMod || op == spv::OpUMod;
}

class Divisors {
 public:
  explicit Divisors(Module& module) : module_(module), zeros_(module) {
    for (const auto& i : module_.code) {
      if (i.op == spv::OpTypeBool) bools_[1] = i.words[1];
      if (i.op == spv::OpTypeVector) vectors_[i.words[1]] = {i.words[2], i.words[3]};
      if (i.op == spv::OpConstant && i.words.size() == 4 && i.words[3] != 0) never_zero_.insert(i.result);
      if (i.op == spv::OpConstantComposite &&
          std::all_of(i.words.begin() + 3, i.words.end(), [&](auto id) { return never_zero_.contains(id); }))
        never_zero_.insert(i.result);
    }
    for (const auto& [id, vector] : vectors_)
      if (vector.first == bools_[1]) bools_[vector.second] = id;
  }

  void hold() {
    std::vector<Instruction> code;
    for (Instruction& i : module_.code) {
      constexpr std::size_t kDivisor = 4;
      if (divides(i.op) && !never_zero_.contains(i.words[kDivisor])) {
        const std::uint32_t divisor = i.words[kDivisor];
        const std::uint32_t is_zero = module_.fresh(), held = module_.fresh();
        code.push_back(Instruction::of_ids(spv::OpIEqual, bool_of(i.type), is_zero, {divisor, zeros_.of(i.type)}));
        code.push_back(Instruction::of_ids(spv::OpSelect, i.type, held, {is_zero, one_of(i.type), divisor}));
        i.words[kDivisor] = held;
      }
      code.push_back(std::move(i));
    }
    module_.code = std::move(code);
    declare(module_, zeros_.declarations);
    declare(module_, declared_);
  }

 private:
  std::uint32_t bool_of(std::uint32_t type) {
    const auto vector = vectors_.find(type);
    const std::uint32_t count = vector == vectors_.end() ? 1 : vector->second.second;
    std::uint32_t& found = bools_[count];
    if (found != 0) return found;
    found = module_.fresh();
    if (count == 1)
      declared_.push_back(Instruction::of_words(spv::OpTypeBool, {found}));
    else
      declared_.push_back(Instruction::of_words(spv::OpTypeVector, {found, bool_of(vector->second.first), count}));
    return found;
  }
  std::uint32_t one_of(std::uint32_t type) {
    if (const auto known = ones_.find(type); known != ones_.end()) return known->second;
    const auto vector = vectors_.find(type);
    std::uint32_t one = 0;
    if (vector == vectors_.end()) {
      one = module_.fresh();
      Instruction constant = Instruction::of_words(spv::OpConstant, {type, one, 1});
      constant.type = type;
      constant.result = one;
      constant.ids = {1, 2};
      declared_.push_back(std::move(constant));
    } else {
      const Words parts(vector->second.second, one_of(vector->second.first));
      one = module_.fresh();
      declared_.push_back(Instruction::of_ids(spv::OpConstantComposite, type, one, parts));
    }
    return ones_[type] = one;
  }

  Module& module_;
  std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> vectors_;  ///< id → type of its parts, their number
  std::map<std::uint32_t, std::uint32_t> bools_;                              ///< number of parts → type
  std::map<std::uint32_t, std::uint32_t> ones_;                               ///< type → constant
  Zeros zeros_;
  std::set<std::uint32_t> never_zero_;  ///< constants
  std::vector<Instruction> declared_;
};

}  // namespace

Words with_held_divisors(Words spirv) {
  constexpr std::size_t kHeader = 5;
  bool any = false;
  for (std::size_t at = kHeader; at < spirv.size() && !any; at += std::max(spirv[at] >> spv::WordCountShift, 1u))
    any = divides(static_cast<spv::Op>(spirv[at] & spv::OpCodeMask));
  auto module = any ? parse(spirv) : std::nullopt;
  if (!module) return spirv;
  Divisors(*module).hold();
  return module->join();
}

}  // namespace afterglow

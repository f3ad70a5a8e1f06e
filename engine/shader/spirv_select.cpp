// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <set>

#include "shader/spirv_module.h"
#include "shader/spirv_passes.h"

namespace afterglow {
namespace {

/// Whether an operation may be computed where its value is not needed.
bool is_harmless(spv::Op op) {
  const bool arithmetic = (op >= spv::OpVectorExtractDynamic && op <= spv::OpTranspose) ||
                          (op >= spv::OpConvertFToU && op <= spv::OpFUnordGreaterThanEqual) ||
                          (op >= spv::OpShiftRightLogical && op <= spv::OpBitCount);
  return arithmetic || op == spv::OpLine || op == spv::OpNoLine || op == spv::OpLoad;
}

/// A side of a branch: the block that starts at `label`, or nothing of its own when that is the merge block.
struct Side {
  std::uint32_t label = 0;  ///< from which the merge block is reached
  std::size_t begin = 0, end = 0;
  std::size_t block_length() const { return begin == 0 ? 0 : end - begin + 2; }  ///< with label and branch
};

constexpr std::uint32_t kOneConditionForAll = 0x00010400;  // from here on one bool selects whole vectors and records

/// The types of a module that selections need.
struct Types {
  std::uint32_t boolean = 0;
  std::map<std::uint32_t, std::uint32_t> counts;        ///< type → components: 1 of scalars, 2 to 4 of vectors
  std::map<std::uint32_t, std::uint32_t> bool_vectors;  ///< components → type

  explicit Types(const Module& module) {
    for (const auto& i : module.code) {
      if (i.op == spv::OpTypeBool) boolean = i.words[1];
      if (i.op == spv::OpTypeBool || i.op == spv::OpTypeInt || i.op == spv::OpTypeFloat) counts[i.words[1]] = 1;
      if (i.op == spv::OpTypeVector) counts[i.words[1]] = i.words[3];
      if (i.op == spv::OpTypeVector && i.words[2] == boolean) bool_vectors[i.words[3]] = i.words[1];
    }
  }
};

class Selector {
 public:
  Selector(Module& module, std::size_t begin, std::size_t end)
      : module_(module),
        code_(module.code),
        begin_(begin),
        end_(end),
        one_for_all_(module.header[1] >= kOneConditionForAll),
        types_(module) {
    for (const auto& instruction : code_)
      if (instruction.op == spv::OpConstant) constants_.insert(instruction.result);
  }

  std::size_t run() {
    bool changed = true;
    while (changed) {
      changed = false;
      for (std::size_t i = begin_; i + 1 < end_ && !changed; ++i)
        changed = code_[i].op == spv::OpSelectionMerge && code_[i + 1].op == spv::OpBranchConditional && convert(i);
    }
    return end_;
  }

 private:
  std::size_t label_at(std::uint32_t label) const {
    std::size_t i = begin_;
    while (i < end_ && !(code_[i].op == spv::OpLabel && code_[i].result == label)) ++i;
    return i;
  }

  /// An index that is no constant could lead outside an array where the branch keeps it from being used.
  bool is_harmless(const Instruction& instruction) const {
    if (instruction.op == spv::OpExtInst) return is_pure_function(instruction);
    if (instruction.op != spv::OpAccessChain) return afterglow::is_harmless(instruction.op);
    return std::all_of(instruction.words.begin() + 4, instruction.words.end(),
                       [this](std::uint32_t index) { return constants_.contains(index); });
  }

  /// The side that begins at `label`, when it is harmless and leads straight to `merge`.
  std::optional<Side> side(std::uint32_t label, std::uint32_t merge, std::uint32_t from) const {
    if (label == merge) return Side{from, 0, 0};
    const std::size_t begin = label_at(label) + 1;
    std::size_t i = begin;
    while (i < end_ && is_harmless(code_[i])) ++i;
    if (i >= end_ || code_[i].op != spv::OpBranch || code_[i].words[1] != merge) return std::nullopt;
    return Side{label, begin, i};
  }

  /// What selects values of this type; 0: nothing can.
  std::uint32_t condition_for(std::uint32_t type, std::uint32_t condition, std::vector<Instruction>& code) {
    const auto count = types_.counts.find(type);
    if (one_for_all_ || (count != types_.counts.end() && count->second == 1)) return condition;
    if (count == types_.counts.end() || !types_.bool_vectors.contains(count->second)) return 0;
    const std::uint32_t all = module_.fresh();
    code.push_back(Instruction::of_ids(spv::OpCompositeConstruct, types_.bool_vectors.at(count->second), all,
                                       Words(count->second, condition)));
    return all;
  }

  /// The selection whose OpSelectionMerge is at `at`.
  bool convert(std::size_t at) {
    const std::uint32_t merge = code_[at].words[1], condition = code_[at + 1].words[1];
    std::size_t header = at;
    while (code_[header].op != spv::OpLabel) --header;
    const std::uint32_t from = code_[header].result;
    const auto yes = side(code_[at + 1].words[2], merge, from), no = side(code_[at + 1].words[3], merge, from);
    if (!yes || !no) return false;
    std::size_t behind = label_at(merge) + 1;
    // Nothing else stands between: header, sides, merge block.
    if (behind - at != 2 + yes->block_length() + no->block_length() + 1) return false;
    std::vector<Instruction> straight(code_.begin() + static_cast<std::ptrdiff_t>(yes->begin),
                                      code_.begin() + static_cast<std::ptrdiff_t>(yes->end));
    straight.insert(straight.end(), code_.begin() + static_cast<std::ptrdiff_t>(no->begin),
                    code_.begin() + static_cast<std::ptrdiff_t>(no->end));
    for (; code_[behind].op == spv::OpPhi; ++behind) {
      const Words& phi = code_[behind].words;  // type, result, then (value, from) twice
      if (phi.size() != 7) return false;
      const bool yes_first = phi[4] == yes->label && phi[6] == no->label;
      const std::uint32_t chooses = condition_for(phi[1], condition, straight);
      if (chooses == 0) return false;
      straight.push_back(Instruction::of_ids(spv::OpSelect, phi[1], phi[2],
                                             {chooses, yes_first ? phi[3] : phi[5], yes_first ? phi[5] : phi[3]}));
    }
    const auto first = code_.begin() + static_cast<std::ptrdiff_t>(at);
    const auto last = code_.begin() + static_cast<std::ptrdiff_t>(behind);
    end_ -= static_cast<std::size_t>(last - first);
    end_ += straight.size();
    const auto place = code_.erase(first, last);
    code_.insert(place, straight.begin(), straight.end());
    for (std::size_t i = begin_; i < end_; ++i)
      if (code_[i].op == spv::OpPhi) code_[i] = renamed(code_[i], {{merge, from}});
    return true;
  }

  Module& module_;
  std::vector<Instruction>& code_;
  std::size_t begin_, end_;
  bool one_for_all_;
  Types types_;
  std::set<std::uint32_t> constants_;
};

}  // namespace

void declare_bool_vectors(Module& module) {
  const Types types(module);
  if (module.header[1] >= kOneConditionForAll || types.boolean == 0) return;
  std::vector<Instruction> missing;
  for (std::uint32_t n = 2; n <= 4; ++n)
    if (!types.bool_vectors.contains(n))
      missing.push_back(Instruction::of_words(spv::OpTypeVector, {module.fresh(), types.boolean, n}));
  declare(module, missing);
}

std::size_t select_instead_of_branching(Module& module, std::size_t begin, std::size_t end) {
  return Selector(module, begin, end).run();
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "shader/cpu/merge_equal.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "shader/spirv_passes.h"

namespace afterglow {
namespace {

bool reads_image(spv::Op op) { return op == spv::OpImageRead || op == spv::OpImageFetch; }

/// Whether a step's result depends on its operands alone; of loads and library functions that is asked elsewhere.
bool is_pure(spv::Op op) {
  switch (op) {
    case spv::OpAccessChain:
    case spv::OpVectorExtractDynamic:
    case spv::OpVectorShuffle:
    case spv::OpCompositeConstruct:
    case spv::OpCompositeExtract:
    case spv::OpCopyObject:
    case spv::OpImage:
    case spv::OpImageQuerySize:
    case spv::OpImageQuerySizeLod:
      return true;
    default:
      return reads_image(op) || (op >= spv::OpConvertFToU && op <= spv::OpConvertUToF) || op == spv::OpBitcast ||
             (op >= spv::OpSNegate && op <= spv::OpDot) || (op >= spv::OpAny && op <= spv::OpFUnordGreaterThanEqual) ||
             (op >= spv::OpShiftRightLogical && op <= spv::OpBitCount);
  }
}

class Merger {
 public:
  explicit Merger(Module& module) : module_(module) {}

  void run(MergedRows& counts) {
    look();
    const auto first = std::ranges::find(module_.code, spv::OpFunction, &Instruction::op);
    for (auto at = first; at != module_.code.end(); ++at) {
      if (at->op == spv::OpLabel) known_.clear();
      counts.reads_before += reads_image(at->op) ? 1 : 0;
      copy(renamed(*at, names_));
    }
    std::vector<Instruction> code;
    for (auto at = module_.code.begin(); at != first; ++at)
      if (!is_about_merged(*at)) code.push_back(*at);
    code.insert(code.end(), constants_made_.begin(), constants_made_.end());
    code.insert(code.end(), body_.begin(), body_.end());
    module_.code = std::move(code);
    counts.loops = std::ranges::find(module_.code, spv::OpLoopMerge, &Instruction::op) != module_.code.end();
    counts.reads = static_cast<std::size_t>(
        std::ranges::count_if(module_.code, [](const Instruction& i) { return reads_image(i.op); }));
  }

 private:
  using Numbers = std::vector<std::uint32_t>;  ///< one for each component
  struct Sum {
    std::uint32_t base = 0;
    Numbers added;
  };

  void look() {
    for (const auto& i : module_.code) {
      const Words& w = i.words;
      if (i.op == spv::OpDecorate && w[2] == spv::DecorationNoContraction) precise_.insert(w[1]);
      if (i.op == spv::OpTypeInt && w[2] == 32) whole_[w[1]] = w[1];
      if (i.op == spv::OpTypeVector && whole_.contains(w[2])) whole_[w[1]] = w[2];
      if (i.op == spv::OpTypePointer) classes_[w[1]] = w[2];
      if (i.op == spv::OpConstant && whole_.contains(i.type)) numbers_[i.result] = {w[3]};
      if (i.op == spv::OpConstantComposite && whole_.contains(i.type) &&
          std::all_of(w.begin() + 3, w.end(), [&](std::uint32_t id) { return numbers_.contains(id); }))
        for (auto part = w.begin() + 3; part != w.end(); ++part) numbers_[i.result].push_back(numbers_[*part].front());
      if (const auto known = numbers_.find(i.result); i.result != 0 && known != numbers_.end())
        constants_.emplace(std::pair(i.type, known->second), i.result);
      types_[i.result] = i.type;
    }
  }

  bool can_merge(const Instruction& i) const {
    if (i.result == 0) return false;
    if (i.op == spv::OpExtInst) return is_pure_function(i);
    if (i.op != spv::OpLoad) return is_pure(i.op);
    const auto type = types_.find(i.words[3]);
    const auto pointer = type == types_.end() ? classes_.end() : classes_.find(type->second);
    if (i.words.size() != 4 || pointer == classes_.end()) return false;
    const std::uint32_t from = pointer->second;  // what nothing writes to
    return from == spv::StorageClassUniformConstant || from == spv::StorageClassUniform ||
           from == spv::StorageClassPushConstant || from == spv::StorageClassInput;
  }

  void copy(Instruction i) {
    if (whole_.contains(i.type)) {
      if (const auto numbers = number_of(i)) {
        names_[i.result] = constant_of(i.type, *numbers);
        return;
      }
      if ((i.op == spv::OpIAdd || i.op == spv::OpISub) && !add_up(i)) return;
    }
    if (can_merge(i)) {
      Words key = i.words;
      key[2] = precise_.contains(i.result) ? 1 : 0;
      const auto [known, is_new] = known_.emplace(std::move(key), i.result);
      if (!is_new) {
        names_[i.result] = known->second;
        return;
      }
    }
    body_.push_back(std::move(i));
  }

  /// What a step on constants makes, of those that authors write offsets by: `2 * ivec2(apart, 0)`.
  std::optional<Numbers> number_of(const Instruction& i) const {
    const bool adds = i.op == spv::OpIAdd || i.op == spv::OpISub || i.op == spv::OpIMul;
    if (!adds && i.op != spv::OpSNegate && i.op != spv::OpCompositeConstruct) return std::nullopt;
    std::vector<const Numbers*> operands;
    for (auto id = i.words.begin() + 3; id != i.words.end(); ++id) {
      const auto known = numbers_.find(*id);
      if (known == numbers_.end()) return std::nullopt;
      operands.push_back(&known->second);
    }
    Numbers out = *operands.front();
    if (i.op == spv::OpCompositeConstruct)
      for (std::size_t k = 1; k < operands.size(); ++k) out.insert(out.end(), operands[k]->begin(), operands[k]->end());
    if (i.op == spv::OpSNegate)
      for (auto& n : out) n = 0 - n;
    if (adds)
      for (std::size_t k = 0; k < out.size(); ++k) {
        const std::uint32_t other = (*operands[1])[k];
        out[k] = i.op == spv::OpIAdd ? out[k] + other : i.op == spv::OpISub ? out[k] - other : out[k] * other;
      }
    return out;
  }

  /// Makes a sum with constants one of a value and one constant. False: it is that value.
  bool add_up(Instruction& i) {
    std::uint32_t value = i.words[3], constant = i.words[4];
    if (i.op == spv::OpIAdd && numbers_.contains(value)) std::swap(value, constant);
    const auto number = numbers_.find(constant);
    if (number == numbers_.end() || numbers_.contains(value)) return true;
    Sum sum{value, number->second};
    if (i.op == spv::OpISub)
      for (auto& n : sum.added) n = 0 - n;
    // The constants must be of the type of the result: signs may differ.
    const auto before = sums_.find(value);
    if (before != sums_.end() && types_[before->second.base] == i.type) {
      sum.base = before->second.base;
      for (std::size_t k = 0; k < sum.added.size(); ++k) sum.added[k] += before->second.added[k];
    } else if (types_[value] != i.type) {
      return true;
    }
    if (std::ranges::all_of(sum.added, [](std::uint32_t n) { return n == 0; })) {
      names_[i.result] = sum.base;
      return false;
    }
    i = Instruction::of_ids(spv::OpIAdd, i.type, i.result, {sum.base, constant_of(i.type, sum.added)});
    sums_.emplace(i.result, std::move(sum));
    return true;
  }

  std::uint32_t constant_of(std::uint32_t type, const Numbers& numbers) {
    const auto known = constants_.find({type, numbers});
    if (known != constants_.end()) return known->second;
    Words operands{type, module_.fresh()};
    if (numbers.size() == 1) {
      operands.push_back(numbers.front());
      constants_made_.push_back(Instruction::of_words(spv::OpConstant, operands));
    } else {
      for (const std::uint32_t n : numbers) operands.push_back(constant_of(whole_[type], {n}));
      constants_made_.push_back(Instruction::of_words(spv::OpConstantComposite, operands));
    }
    numbers_[operands[1]] = numbers;
    return constants_[{type, numbers}] = operands[1];
  }

  /// Names and decorations of what is gone.
  bool is_about_merged(const Instruction& i) const {
    return (i.op == spv::OpName || i.op == spv::OpDecorate) && names_.contains(i.words[1]);
  }

  Module& module_;
  std::set<std::uint32_t> precise_;
  std::map<std::uint32_t, std::uint32_t> whole_;    ///< type of whole numbers → of its components
  std::map<std::uint32_t, std::uint32_t> classes_;  ///< pointer type → storage class
  std::map<std::uint32_t, std::uint32_t> types_;    ///< of results
  std::map<std::uint32_t, Numbers> numbers_;        ///< constant → what it is
  std::map<std::pair<std::uint32_t, Numbers>, std::uint32_t> constants_;
  std::map<std::uint32_t, Sum> sums_;
  std::map<Words, std::uint32_t> known_;  ///< step, without its result → result
  Renaming names_;                        ///< what is merged → what stands for it
  std::vector<Instruction> constants_made_, body_;
};

}  // namespace

MergedRows merge_equal(std::vector<std::uint32_t> spirv) {
  MergedRows out;
  auto module = parse(spirv);
  if (module) module = without_variables(*module);
  if (!module) {
    out.spirv = std::move(spirv);
    return out;
  }
  Merger(*module).run(out);
  out.spirv = module->join();
  return out;
}

}  // namespace afterglow

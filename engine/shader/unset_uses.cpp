// SPDX-License-Identifier: MIT
#include "shader/unset_uses.h"

#include <algorithm>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "shader/spirv_loops.h"
#include "shader/spirv_passes.h"

namespace afterglow {
namespace {

/// Of each of the numbers that a value is made of, in order: as bits, which of up to 64 inputs it may come from.
using Leaves = std::vector<std::uint64_t>;
constexpr std::size_t kAtOnce = 64;

/// Values of more numbers are not followed. (Variables of shaders have 1024 bytes at most: see check_usable.)
constexpr std::size_t kMostLeaves = 256;

/// What each type is made of.
class LeafTypes {
 public:
  explicit LeafTypes(const Module& module) {
    std::map<std::uint32_t, std::uint32_t> numbers;
    for (const auto& i : module.code) {
      Words elements;
      if (i.op == spv::OpConstant) numbers[i.result] = i.words[3];
      if (i.op == spv::OpTypeVector || i.op == spv::OpTypeMatrix)
        elements.assign(i.words[3], i.words[2]);
      else if (i.op == spv::OpTypeArray)
        elements.assign(std::min<std::size_t>(numbers[i.words[3]], kMostLeaves + 1), i.words[2]);
      else if (i.op == spv::OpTypeStruct)
        elements.assign(i.words.begin() + 2, i.words.end());
      if (elements.empty()) continue;
      std::size_t size = 0;
      for (const auto element : elements) size = std::min(size + size_of(element), kMostLeaves + 1);
      types_[i.result] = {std::move(elements), size};
    }
  }

  std::size_t size_of(std::uint32_t type) const {
    const auto found = types_.find(type);
    return found == types_.end() ? 1 : found->second.size;
  }

  /// Where the numbers begin of the part at the end of the path.
  std::size_t offset(std::uint32_t type, std::span<const std::uint32_t> path) const {
    std::size_t out = 0;
    for (const auto step : path) {
      const Words& elements = types_.at(type).elements;
      for (std::uint32_t before = 0; before < step; ++before) out += size_of(elements[before]);
      type = elements[step];
    }
    return out;
  }

 private:
  struct Type {
    Words elements;
    std::size_t size = 0;
  };
  std::map<std::uint32_t, Type> types_;
};

class Uses {
 public:
  Uses(const Module& module, const std::set<std::uint32_t>& turning) : code_(module.code), types_(module) {
    for (Loop& loop : find_loops(module))
      if (turning.contains(loop.header)) turns_[loop.header] = std::move(loop.blocks);
    std::uint32_t block = 0;
    for (std::size_t at = 0; at < code_.size(); ++at) {
      const Instruction& i = code_[at];
      if (i.op == spv::OpLabel) block = i.result;
      if (i.result != 0) types_of_[i.result] = i.type;
      if (i.op == spv::OpPhi && turns_.contains(block)) carried_[i.result] = at;
      homes_.push_back(block);
    }
  }

  /// As bits: of which of these (kAtOnce at most) something is used of the value that they begin with.
  std::uint64_t of(std::span<const std::uint32_t> inputs) {
    leaves_.clear();
    std::uint64_t used = 0;
    for (const Instruction& i : code_) {
      if (i.op != spv::OpLoad && i.op != spv::OpAccessChain) continue;
      const auto found = std::ranges::find(inputs, i.words[3]);
      if (found == inputs.end()) continue;
      const std::uint64_t bit = std::uint64_t{1} << (found - inputs.begin());
      if (i.op == spv::OpAccessChain)
        used |= bit;
      else if (types_.size_of(i.type) <= kMostLeaves)
        leaves_[i.result] = Leaves(types_.size_of(i.type), bit);
    }
    if (leaves_.empty()) return used;
    while (carry_along()) {
    }
    for (std::size_t at = 0; at < code_.size(); ++at) {
      if (!carries(code_[at]))
        for_each_known(at, [&](std::uint32_t id) {
          for (const auto leaf : leaves_of(id, at)) used |= leaf;
        });
    }
    return used;
  }

 private:
  static bool carries(const Instruction& i) {
    return i.op == spv::OpCopyObject || i.op == spv::OpPhi || i.op == spv::OpCompositeConstruct ||
           i.op == spv::OpCompositeExtract || i.op == spv::OpCompositeInsert || i.op == spv::OpVectorShuffle;
  }

  template <class Visit>
  void for_each_known(std::size_t at, const Visit& visit) {
    const Instruction& i = code_[at];
    if (i.op == spv::OpName || i.op == spv::OpDecorate) return;
    for (const auto word : i.ids)
      if (i.words[word] != i.result && leaves_.contains(i.words[word])) visit(i.words[word]);
  }

  /// Once through the code. False: nothing is new.
  bool carry_along() {
    bool any_new = false;
    for (std::size_t at = 0; at < code_.size(); ++at) {
      if (!carries(code_[at]) || types_.size_of(code_[at].type) > kMostLeaves) continue;
      bool any_known = false;
      for_each_known(at, [&](std::uint32_t) { any_known = true; });
      if (!any_known) continue;
      Leaves now = carried_along(code_[at], at);
      Leaves& known = leaves_[code_[at].result];
      any_new |= known != now;
      known = std::move(now);
    }
    return any_new;
  }

  /// What is known of `id` where instruction `at` stands. What a loop carries along has been given its value by a turn
  /// of it, for those behind.
  const Leaves& leaves_of(std::uint32_t id, std::size_t at) {
    const auto found = leaves_.find(id);
    if (found == leaves_.end()) {
      Leaves& set = set_[id];
      if (set.empty()) set.resize(types_.size_of(types_of_[id]));
      return set;
    }
    const auto carried = carried_.find(id);
    if (carried == carried_.end()) return found->second;
    const Instruction& phi = code_[carried->second];
    const auto& blocks = turns_.at(homes_[carried->second]);
    if (blocks.contains(homes_[at])) return found->second;
    for (std::size_t word = 3; word + 1 < phi.words.size(); word += 2)
      if (blocks.contains(phi.words[word + 1]) && phi.words[word] != id)
        return leaves_of(phi.words[word], carried->second);
    return found->second;
  }

  /// What the instruction makes of them.
  Leaves carried_along(const Instruction& i, std::size_t at) {
    Leaves out(types_.size_of(i.type));
    const auto all_of = [&](std::uint32_t id) -> const Leaves& { return leaves_of(id, at); };
    switch (i.op) {
      case spv::OpPhi:
        for (std::size_t word = 3; word + 1 < i.words.size(); word += 2) {
          const Leaves& one = all_of(i.words[word]);
          for (std::size_t n = 0; n < out.size(); ++n) out[n] |= one[n];
        }
        return out;
      case spv::OpCompositeConstruct: {
        std::size_t n = 0;
        for (std::size_t word = 3; word < i.words.size(); ++word)
          for (const auto leaf : all_of(i.words[word])) out[n++] = leaf;
        return out;
      }
      case spv::OpCompositeExtract: {
        const Leaves& whole = all_of(i.words[3]);
        const std::size_t first = types_.offset(types_of_[i.words[3]], std::span(i.words).subspan(4));
        for (std::size_t n = 0; n < out.size(); ++n) out[n] = whole[first + n];
        return out;
      }
      case spv::OpCompositeInsert: {
        const Leaves& part = all_of(i.words[3]);
        const std::size_t first = types_.offset(i.type, std::span(i.words).subspan(5));
        out = all_of(i.words[4]);
        std::copy(part.begin(), part.end(), out.begin() + static_cast<std::ptrdiff_t>(first));
        return out;
      }
      case spv::OpVectorShuffle: {
        Leaves both = all_of(i.words[3]);
        const Leaves& second = all_of(i.words[4]);
        both.insert(both.end(), second.begin(), second.end());
        for (std::size_t n = 0; n < out.size(); ++n) out[n] = i.words[5 + n] < both.size() ? both[i.words[5 + n]] : 0;
        return out;
      }
      default:  // a copy
        return all_of(i.words[3]);
    }
  }

  const std::vector<Instruction>& code_;
  LeafTypes types_;
  std::map<std::uint32_t, std::uint32_t> types_of_;         ///< id → its type
  std::vector<std::uint32_t> homes_;                        ///< the block of each instruction
  std::map<std::uint32_t, std::set<std::uint32_t>> turns_;  ///< header of a loop that turns → its blocks
  std::map<std::uint32_t, std::size_t> carried_;            ///< id of an OpPhi in one of those headers → where it is
  std::map<std::uint32_t, Leaves> set_;                     ///< of what is known to have its value
  std::map<std::uint32_t, Leaves> leaves_;                  ///< of what may lack it
};

/// Values in place of variables, and straight code in place of short loops. `turning`: the headers of those that stay,
/// turn at least once and are left by their test alone.
std::optional<Module> in_values(const Module& module, std::set<std::uint32_t>& turning) {
  if (!inlines_quickly(module)) return std::nullopt;
  spvtools::Optimizer inlining(kSpirvEnvironment);
  // Functions with several returns are not inlined; what they write is not seen then.
  inlining.RegisterPass(spvtools::CreateDeadBranchElimPass()).RegisterPass(spvtools::CreateMergeReturnPass());
  add_inlining_passes(inlining);
  // A variable whose parts were pointed at is followed once those pointers, unused by now, are gone.
  inlining.RegisterPass(spvtools::CreateAggressiveDCEPass());
  auto inlined = run_passes(inlining, module);
  if (!inlined || !rewrites_quickly(*inlined)) return std::nullopt;
  for (const Loop& loop : find_loops(*inlined))
    if (loop.counting && loop.counting->turns.value_or(0) > 0) turning.insert(loop.header);
  spvtools::Optimizer optimizer(kSpirvEnvironment);
  add_rewriting_passes(optimizer, *inlined);
  optimizer.RegisterPass(spvtools::CreateCCPPass())
      .RegisterPass(spvtools::CreateDeadBranchElimPass())
      .RegisterPass(spvtools::CreateAggressiveDCEPass());
  return run_passes(optimizer, *inlined);
}

}  // namespace

std::vector<std::uint32_t> unset_uses(const Module& module, const std::map<std::uint32_t, std::uint32_t>& unset) {
  std::set<std::uint32_t> turning;
  const auto values = in_values(module, turning);
  std::vector<std::uint32_t> out;
  if (!values) return out;
  Uses uses(*values, turning);
  std::vector<std::uint32_t> inputs;
  for (const auto& [input, number] : unset) inputs.push_back(input);
  for (std::size_t first = 0; first < inputs.size(); first += kAtOnce) {
    const auto some = std::span(inputs).subspan(first, std::min(kAtOnce, inputs.size() - first));
    const std::uint64_t used = uses.of(some);
    for (std::size_t n = 0; n < some.size(); ++n)
      if ((used >> n & 1) != 0) out.push_back(unset.at(some[n]));
  }
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace afterglow

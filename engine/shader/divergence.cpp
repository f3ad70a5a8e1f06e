// SPDX-License-Identifier: MIT
#include "shader/divergence.h"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

namespace afterglow {
namespace {

using Id = std::uint32_t;

/// A stretch of instructions without a branch but its last.
struct BasicBlock {
  std::size_t begin = 0, end = 0;  ///< the label, and behind the terminator
  Id function = 0;
  std::vector<Id> next;
  Id merge = 0, continues = 0;  ///< of the construct whose header it is
  bool is_loop = false, returns = false;
  Id selector = 0;          ///< that decides which of `next` it is; 0: nothing does
  std::vector<Id> loops{};  ///< headers of those around it
};

bool varies_by_invocation(spv::BuiltIn builtin) {
  return builtin != spv::BuiltInWorkgroupSize && builtin != spv::BuiltInWorkgroupId &&
         builtin != spv::BuiltInNumWorkgroups;
}

/// What differs between the invocations of a workgroup grows until nothing more follows from it.
class Divergence {
 public:
  explicit Divergence(const Module& module) : module_(module) {
    find_blocks();
    find_loops();
    find_variables();
    settle();
    // That was with arguments that are the same for all: what varies now does so whatever a function is given.
    by_itself_ = varying_;
    by_itself_.insert(dirty_.begin(), dirty_.end());
    takes_arguments_ = true;
    settle();
  }

  std::optional<std::size_t> barrier() const {
    std::optional<std::size_t> first;
    for (const auto& [label, block] : blocks_) {
      if (!divergent_.contains(label)) continue;
      for (std::size_t i = block.begin; i < block.end; ++i) {
        const Instruction& at = module_.code[i];
        const bool waits =
            at.op == spv::OpControlBarrier || (at.op == spv::OpFunctionCall && waiting_.contains(at.words[3]));
        if (waits) first = std::min(first.value_or(i), i);
      }
    }
    return first;
  }

 private:
  void settle() {
    const auto known = [&] {
      return varying_.size() + dirty_.size() + divergent_.size() + called_.size() + written_.size();
    };
    std::size_t before = 0;
    do {
      before = known();
      for (const auto& [label, block] : blocks_) flow(block);
      for (const auto& [label, block] : blocks_)
        for (std::size_t i = block.begin; i < block.end; ++i) follow(module_.code[i], label, block);
    } while (known() != before);
  }

  // ---- what there is

  void find_blocks() {
    Id function = 0, label = 0;
    for (std::size_t i = 0; i < module_.code.size(); ++i) {
      const Instruction& at = module_.code[i];
      if (at.op == spv::OpFunction) function = at.result, label = 0;
      if (at.op == spv::OpFunctionParameter) parameters_[function].push_back(at.result);
      if (at.op == spv::OpLabel) {
        label = at.result;
        blocks_[label] = {.begin = i, .end = i, .function = function, .next = {}};
      }
      if (label == 0) continue;
      BasicBlock& block = blocks_[label];
      block.end = i + 1;
      switch (at.op) {
        case spv::OpSelectionMerge:
          block.merge = at.words[1];
          break;
        case spv::OpLoopMerge:
          block.merge = at.words[1];
          block.continues = at.words[2];
          block.is_loop = true;
          break;
        case spv::OpBranch:
          block.next = {at.words[1]};
          break;
        case spv::OpBranchConditional:
          block.next = {at.words[2], at.words[3]};
          block.selector = at.words[1];
          break;
        case spv::OpSwitch:
          block.next = {at.words[2]};
          for (std::size_t word = 4; word < at.words.size(); word += 2) block.next.push_back(at.words[word]);
          block.selector = at.words[1];
          break;
        case spv::OpReturn:
        case spv::OpReturnValue:
          block.returns = true;
          break;
        case spv::OpControlBarrier:
          waiting_.insert(function);
          break;
        default:
          break;
      }
    }
    // Functions that call one that waits wait themselves.
    for (std::size_t before = 0; before != waiting_.size();) {
      before = waiting_.size();
      for (const auto& [of, block] : blocks_)
        for (std::size_t i = block.begin; i < block.end; ++i)
          if (module_.code[i].op == spv::OpFunctionCall && waiting_.contains(module_.code[i].words[3]))
            waiting_.insert(block.function);
    }
  }

  /// What is reached from `from` without going through `stop`.
  std::set<Id> reached(const std::vector<Id>& from, const std::set<Id>& stop) const {
    std::set<Id> seen;
    std::vector<Id> open = from;
    while (!open.empty()) {
      const Id label = open.back();
      open.pop_back();
      if (stop.contains(label) || !seen.insert(label).second) continue;
      const auto& next = blocks_.at(label).next;
      open.insert(open.end(), next.begin(), next.end());
    }
    return seen;
  }

  void find_loops() {
    for (const auto& [header, block] : blocks_)
      if (block.is_loop)
        for (const Id label : reached({header}, {block.merge})) blocks_.at(label).loops.push_back(header);
  }

  void find_variables() {
    Id function = 0;
    for (const auto& at : module_.code) {
      if (at.op == spv::OpFunction) function = at.result;
      if (at.op == spv::OpVariable) owner_[at.result] = function;
      if (at.op == spv::OpVariable && at.words[3] == spv::StorageClassWorkgroup) shared_.insert(at.result);
      if (at.op == spv::OpDecorate && at.words[2] == spv::DecorationBuiltIn &&
          varies_by_invocation(static_cast<spv::BuiltIn>(at.words[3])))
        dirty_.insert(at.words[1]);
    }
  }

  // ---- values

  Id root(Id pointer) const {
    const auto found = roots_.find(pointer);
    return found == roots_.end() ? pointer : found->second;
  }
  bool any_varying(const Instruction& at) const {
    return std::ranges::any_of(at.ids, [&](std::uint16_t word) { return varying_.contains(at.words[word]); });
  }
  /// What all share is the same for all who read the same place of it.
  bool holds_varying(Id pointer) const { return dirty_.contains(root(pointer)) && !shared_.contains(root(pointer)); }
  /// `apart`: not all invocations that are in the function store.
  void store(Id pointer, bool varying, bool apart, Id function) {
    const Id variable = root(pointer);
    written_.insert(variable);
    const auto owner = owner_.find(variable);
    const bool own = owner != owner_.end() && owner->second == function;  // begins anew with each call
    if (varying || apart || varying_.contains(pointer) || (!own && called_.contains(function))) dirty_.insert(variable);
  }

  void follow(const Instruction& at, Id label, const BasicBlock& block) {
    const bool apart = divergent_.contains(label);
    switch (at.op) {
      case spv::OpAccessChain:
      case spv::OpInBoundsAccessChain:
      case spv::OpCopyObject:
        roots_[at.result] = root(at.words[3]);
        break;
      case spv::OpLoad:
        if (holds_varying(at.words[3])) varying_.insert(at.result);
        break;
      case spv::OpStore:
        store(at.words[1], varying_.contains(at.words[2]), apart, block.function);
        return;
      case spv::OpCopyMemory:
        store(at.words[1], varying_.contains(at.words[2]) || holds_varying(at.words[2]), apart, block.function);
        return;
      case spv::OpPhi:
        for (std::size_t word = 4; word < at.words.size(); word += 2)
          if (divergent_.contains(at.words[word])) varying_.insert(at.result);
        break;
      case spv::OpFunctionCall:
        call(at, apart || called_.contains(block.function), block.function);
        return;
      case spv::OpReturnValue:
        if (apart || varying_.contains(at.words[1])) varying_.insert(block.function);
        return;
      case spv::OpExtInst:  // some write through a pointer: modf, frexp
        for (std::size_t word = 5; word < at.words.size(); ++word)
          if (owner_.contains(root(at.words[word]))) store(at.words[word], any_varying(at), apart, block.function);
        break;
      default:
        if (at.op >= spv::OpAtomicLoad && at.op <= spv::OpAtomicXor && at.result != 0) varying_.insert(at.result);
        break;
    }
    if (at.result != 0 && any_varying(at)) varying_.insert(at.result);
  }

  /// A result varies when an argument does, or when the function makes it so by itself: not because of what another
  /// call gives it.
  void call(const Instruction& at, bool apart, Id caller) {
    constexpr std::size_t kFirst = 4;
    const Id callee = at.words[3];
    if (apart) called_.insert(callee);
    const auto& parameters = parameters_[callee];
    const std::size_t count = std::min(parameters.size(), at.words.size() - kFirst);
    bool varies = false;
    for (std::size_t i = 0; i < count; ++i) {
      const Id given = at.words[i + kFirst];
      if (takes_arguments_ && varying_.contains(given)) varying_.insert(parameters[i]);
      if (takes_arguments_ && holds_varying(given)) dirty_.insert(parameters[i]);
      varies = varies || varying_.contains(given) || holds_varying(given);
    }
    const std::set<Id>& by_itself = takes_arguments_ ? by_itself_ : varying_;
    if (varies || by_itself.contains(callee)) varying_.insert(at.result);
    for (std::size_t i = 0; i < count; ++i) {
      if (!written_.contains(parameters[i])) continue;
      const bool dirtied = takes_arguments_ ? by_itself_.contains(parameters[i]) : dirty_.contains(parameters[i]);
      store(at.words[i + kFirst], varies || dirtied, apart, caller);
    }
  }

  // ---- ways

  void diverge(const std::set<Id>& labels) { divergent_.insert(labels.begin(), labels.end()); }
  void diverge_loop(Id header) { diverge(reached({header}, {blocks_.at(header).merge})); }

  /// What follows from invocations going different ways behind this block.
  void flow(const BasicBlock& block) {
    if (block.selector == 0 || !varying_.contains(block.selector)) return;
    if (block.merge == 0 || block.is_loop) {  // it decides whether the loop around it goes on
      if (!block.loops.empty()) diverge_loop(innermost(block));
      return;
    }
    // Each way ends at the merge, or leaves a construct around it.
    std::set<Id> stop{block.merge};
    for (const Id header : block.loops) {
      const BasicBlock& loop = blocks_.at(header);
      stop.insert({header, loop.merge, loop.continues});
    }
    const std::set<Id> ways = reached(block.next, stop);
    diverge(ways);
    const auto leaves_to = [&](Id target) {
      if (target == block.merge) return false;
      return std::ranges::count(block.next, target) > 0 ||
             std::ranges::any_of(ways, [&](Id way) { return std::ranges::count(blocks_.at(way).next, target) > 0; });
    };
    for (const Id header : block.loops) {
      const BasicBlock& loop = blocks_.at(header);
      if (leaves_to(loop.merge)) diverge_loop(header);
      if (leaves_to(loop.continues)) diverge(reached({block.merge}, {loop.continues, loop.merge}));
    }
    if (std::ranges::any_of(ways, [&](Id way) { return blocks_.at(way).returns; }))
      diverge(reached({block.merge}, std::set<Id>()));
  }

  Id innermost(const BasicBlock& block) const {
    return *std::ranges::max_element(block.loops, {}, [&](Id header) { return blocks_.at(header).loops.size(); });
  }

  const Module& module_;
  std::map<Id, BasicBlock> blocks_;
  std::map<Id, std::vector<Id>> parameters_;  ///< by function
  std::map<Id, Id> roots_;                    ///< pointer into a variable → the variable
  std::set<Id> waiting_;                      ///< functions with a barrier, by themselves or by what they call
  std::set<Id> varying_;                      ///< values; functions whose result is one
  std::set<Id> dirty_;                        ///< variables and parameters that hold some
  std::set<Id> divergent_;                    ///< blocks
  std::set<Id> called_;                       ///< functions that some invocations call and others do not
  std::map<Id, Id> owner_;                    ///< variable → the function that it is of; 0: none
  std::set<Id> shared_;                       ///< variables of the workgroup
  std::set<Id> written_;                      ///< variables and parameters that something is stored in
  std::set<Id> by_itself_;                    ///< what varies when no argument does
  bool takes_arguments_ = false;
};

}  // namespace

std::optional<std::size_t> divergent_barrier(const Module& module) {
  const bool waits = std::ranges::find(module.code, spv::OpControlBarrier, &Instruction::op) != module.code.end();
  return waits ? Divergence(module).barrier() : std::nullopt;
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "shader/spirv_loops.h"

#include <algorithm>
#include <array>
#include <functional>
#include <map>

#include "shader/spirv_passes.h"

namespace afterglow {
namespace {

bool ends_block(spv::Op op) {
  return op == spv::OpBranch || op == spv::OpBranchConditional || op == spv::OpSwitch || op == spv::OpReturn ||
         op == spv::OpReturnValue || op == spv::OpKill || op == spv::OpTerminateInvocation || op == spv::OpUnreachable;
}

/// What an instruction of a bound may be: it gives the same whenever what it reads is the same.
bool is_pure(const Instruction& i) {
  constexpr std::array kPure{spv::OpLoad,
                             spv::OpAccessChain,
                             spv::OpIAdd,
                             spv::OpISub,
                             spv::OpIMul,
                             spv::OpSNegate,
                             spv::OpCompositeExtract,
                             spv::OpBitcast,
                             spv::OpCompositeConstruct};
  if (i.op == spv::OpExtInst) return is_pure_function(i);
  return std::ranges::find(kPure, i.op) != kPure.end();
}

struct Block {
  std::size_t begin = 0, end = 0;  ///< of OpLabel; of the instruction that ends it
  std::vector<std::uint32_t> from;
};

class Finder {
 public:
  explicit Finder(const Module& module) : code_(module.code) {
    for (const auto& i : code_) {
      if (i.op == spv::OpTypeInt && i.words[2] == 32 && i.words[3] == 1) int_ = i.words[1];
      if (i.op == spv::OpConstant && int_ != 0 && i.type == int_)
        numbers_[i.result] = static_cast<std::int32_t>(i.words[3]);
      if (i.op == spv::OpVariable) storage_[i.result] = static_cast<spv::StorageClass>(i.words[3]);
      if (i.op == spv::OpFunctionParameter) storage_[i.result] = spv::StorageClassFunction;
    }
  }

  std::vector<Loop> run() {
    for (std::size_t at = 0; at < code_.size(); ++at)
      if (code_[at].op == spv::OpFunction) function(at);
    return std::move(loops_);
  }

 private:
  void function(std::size_t begin) {
    blocks_.clear();
    defined_.clear();
    home_.clear();
    uses_.clear();
    std::size_t end = begin;
    for (std::size_t label = 0; code_[end].op != spv::OpFunctionEnd; ++end) {
      if (code_[end].result != 0) defined_[code_[end].result] = end;
      if (code_[end].op == spv::OpLabel) label = end;
      if (code_[end].result != 0) home_[code_[end].result] = code_[label].result;
      if (code_[end].op != spv::OpVariable && code_[end].op != spv::OpLoad)
        for (const auto word : code_[end].ids)
          if (storage_.contains(code_[end].words[word]))
            uses_[code_[end].words[word]].push_back({end, code_[label].result});
      if (ends_block(code_[end].op)) blocks_[code_[label].result] = {label, end, {}};
    }
    for (const auto& [label, block] : std::map(blocks_))
      for (const auto to : targets_of(code_[block.end])) blocks_[to].from.push_back(label);
    const std::size_t first = loops_.size();
    for (std::size_t at = begin, label = 0; at < end; ++at) {
      if (code_[at].op == spv::OpLabel) label = at;
      if (code_[at].op == spv::OpLoopMerge) add(begin, code_[label].result, at);
    }
    for (std::size_t inner = first; inner < loops_.size(); ++inner) {
      for (std::size_t outer = first; outer < loops_.size(); ++outer) {
        Loop& loop = loops_[inner];
        if (outer == inner || !loops_[outer].blocks.contains(loop.header)) continue;
        if (loop.parent < 0 ||
            loops_[outer].blocks.size() < loops_[static_cast<std::size_t>(loop.parent)].blocks.size())
          loop.parent = static_cast<int>(outer);
      }
      loops_[inner].counting = counting(loops_[inner]);
      loops_[inner].most_turns = most_turns(loops_[inner]);
    }
  }

  void add(std::size_t function, std::uint32_t header, std::size_t head) {
    Loop loop{.ordinal = static_cast<std::uint32_t>(loops_.size()),
              .function = function,
              .header = header,
              .merge = code_[head].words[1],
              .head = head,
              .blocks = {header},
              .counting = {},
              .most_turns = {}};
    std::vector<std::uint32_t> open{header};
    while (!open.empty()) {
      const Block& block = blocks_.at(open.back());
      open.pop_back();
      for (const auto to : targets_of(code_[block.end]))
        if (to != loop.merge && loop.blocks.insert(to).second) open.push_back(to);
    }
    loops_.push_back(std::move(loop));
  }

  std::optional<Counting> counting(const Loop& loop) const {
    Counting out;
    if (code_[loop.head + 1].op != spv::OpBranch) return std::nullopt;
    const Block& header = blocks_.at(loop.header);
    std::vector<std::uint32_t> outside;
    for (const auto label : header.from)
      if (!loop.blocks.contains(label)) outside.push_back(label);
    if (outside.size() != 1 || code_[header.begin + 1].op == spv::OpPhi) return std::nullopt;
    out.entry = blocks_.at(outside[0]).end;
    if (code_[out.entry].op != spv::OpBranch) return std::nullopt;
    const std::uint32_t test_label = code_[loop.head + 1].words[1], next_label = code_[loop.head].words[2];
    const Block &test = blocks_.at(test_label), &next = blocks_.at(next_label);
    out.test = test.end;
    const Words& leave = code_[test.end].words;
    if (test_label == next_label || code_[test.end].op != spv::OpBranchConditional || leave[3] != loop.merge ||
        leave[2] == loop.merge || test.from != std::vector{loop.header} || !left_by_test_alone(loop, test_label))
      return std::nullopt;
    if (!compares(leave[1], test, out) || !steps(loop, next, out) || !bound_stays(loop, test, out)) return std::nullopt;
    count(blocks_.at(outside[0]), out);
    return out;
  }

  /// Of a loop that also ends when a variable that counts from a constant reaches another: `i < 9 && more`, with
  /// breaks.
  std::optional<std::uint64_t> most_turns(const Loop& loop) const {
    const Block* before = nullptr;
    for (const auto label : blocks_.at(loop.header).from) {
      if (loop.blocks.contains(label)) continue;
      if (before) return std::nullopt;
      before = &blocks_.at(label);
    }
    if (!before || code_[before->end].op != spv::OpBranch) return std::nullopt;
    const Find find = [&](std::uint32_t id) {
      const auto home = home_.find(id);
      return home != home_.end() && loop.blocks.contains(home->second) ? &code_[defined_.at(id)] : nullptr;
    };
    std::optional<std::uint64_t> most;
    for (const auto label : loop.blocks) {
      const Instruction& leave = code_[blocks_.at(label).end];
      if (leave.op != spv::OpBranchConditional || leave.words[3] != loop.merge || leave.words[2] == loop.merge ||
          comes_past(loop, label, loop.header))
        continue;
      for (const auto condition : all_true(loop, leave.words[1])) {
        Counting counting;
        if (!compares(condition, find, counting) || !steps(loop, blocks_.at(code_[loop.head].words[2]), counting))
          continue;
        count(*before, counting);
        if (counting.turns) most = std::min(most.value_or(*counting.turns), *counting.turns);
      }
    }
    return most;
  }

  /// Whether a turn may come from the head to `block` (the head itself: to the next turn) past another one.
  bool comes_past(const Loop& loop, std::uint32_t without, std::uint32_t block) const {
    std::set<std::uint32_t> seen{without, loop.merge};
    std::vector<std::uint32_t> open{loop.header};
    if (without == loop.header) return false;
    while (!open.empty()) {
      const Block& at = blocks_.at(open.back());
      open.pop_back();
      for (const auto to : targets_of(code_[at.end])) {
        if (to == block && to != without) return true;
        if (to != loop.header && seen.insert(to).second) open.push_back(to);
      }
    }
    return false;
  }

  /// Conditions that hold when this one does: the sides of &&, which may be a branch around the second.
  std::vector<std::uint32_t> all_true(const Loop& loop, std::uint32_t condition, int depth = 0) const {
    std::vector<std::uint32_t> out{condition};
    const auto found = defined_.find(condition);
    if (found == defined_.end() || depth > kMostSides) return out;
    const Instruction& i = code_[found->second];
    std::vector<std::uint32_t> sides;
    if (i.op == spv::OpLogicalAnd) sides = {i.words[3], i.words[4]};
    if (i.op == spv::OpPhi && i.words.size() == 7)
      for (const std::size_t first : {std::size_t{3}, std::size_t{5}}) {
        const Instruction& branch = code_[blocks_.at(i.words[first + 1]).end];
        const std::uint32_t other = i.words[first == 3 ? 6 : 4];
        if (branch.op == spv::OpBranchConditional && branch.words[1] == i.words[first] &&
            branch.words[3] == home_.at(condition) && branch.words[2] != branch.words[3] &&
            !comes_past(loop, i.words[first + 1], other) && !comes_past(loop, branch.words[2], other))
          sides = {i.words[3], i.words[5]};
      }
    for (const auto side : sides) {
      const auto more = all_true(loop, side, depth + 1);
      out.insert(out.end(), more.begin(), more.end());
    }
    return out;
  }

  bool left_by_test_alone(const Loop& loop, std::uint32_t test) const {
    return std::ranges::all_of(loop.blocks, [&](std::uint32_t label) {
      const auto targets = targets_of(code_[blocks_.at(label).end]);
      return !targets.empty() && (label == test || std::ranges::find(targets, loop.merge) == targets.end());
    });
  }

  /// The test: variable, type, bound and which comparison; the step's sign for now.
  bool compares(std::uint32_t condition, const Block& test, Counting& out) const {
    return compares(
        condition, [&](std::uint32_t id) { return within(id, test); }, out);
  }
  using Find = std::function<const Instruction*(std::uint32_t)>;
  bool compares(std::uint32_t condition, const Find& find, Counting& out) const {
    const Instruction* compare = find(condition);
    if (!compare) return false;
    const spv::Op op = compare->op;
    const bool up = op == spv::OpSLessThan || op == spv::OpSLessThanEqual;
    if (!up && op != spv::OpSGreaterThan && op != spv::OpSGreaterThanEqual) return false;
    const Instruction* counter = find(compare->words[3]);
    if (!counter || counter->op != spv::OpLoad || counter->type != int_ || counter->words.size() != 4) return false;
    out.step = up ? 1 : -1;
    out.inclusive = op == spv::OpSLessThanEqual || op == spv::OpSGreaterThanEqual;
    out.variable = counter->words[3];
    out.type = counter->type;
    out.bound = compare->words[4];
    const auto variable = defined_.find(out.variable);
    return variable != defined_.end() && code_[variable->second].op == spv::OpVariable;
  }

  /// The one place in the loop that writes the variable adds a constant to it, in the last block.
  bool steps(const Loop& loop, const Block& next, Counting& out) const {
    if (targets_of(code_[next.end]) != std::vector{loop.header}) return false;
    const auto uses = uses_.find(out.variable);
    if (uses == uses_.end()) return false;
    int stores = 0;
    for (const auto& [at, label] : uses->second) {
      const Instruction& i = code_[at];
      if (i.op != spv::OpStore || i.words[1] != out.variable || i.words[2] == out.variable) return false;
      if (!loop.blocks.contains(label)) continue;
      const Instruction* sum = within(i.words[2], next);
      if (++stores > 1 || at < next.begin || at > next.end || !sum ||
          (sum->op != spv::OpIAdd && sum->op != spv::OpISub))
        return false;
      const Instruction* before = within(sum->words[3], next);
      const auto step = numbers_.find(sum->words[4]);
      if (!before || before->op != spv::OpLoad || before->words[3] != out.variable || step == numbers_.end())
        return false;
      const std::int64_t by = sum->op == spv::OpIAdd ? step->second : -static_cast<std::int64_t>(step->second);
      if (by == 0 || (by > 0) != (out.step > 0) || std::abs(by) > kMostStep) return false;
      out.step = static_cast<std::int32_t>(by);
    }
    return stores == 1;
  }

  /// Nothing in the loop writes what the bound is computed of.
  bool bound_stays(const Loop& loop, const Block& test, Counting& out) const {
    std::set<std::uint32_t> written;
    bool calls = false;
    for (const auto label : loop.blocks) {
      const Block& block = blocks_.at(label);
      for (std::size_t at = block.begin; at <= block.end; ++at) {
        const Instruction& i = code_[at];
        if (i.op == spv::OpFunctionCall) {
          calls = true;
          for (const auto word : i.ids) written.insert(i.words[word]);
        } else if (i.op != spv::OpLoad && i.op != spv::OpAccessChain) {
          for (const auto word : i.ids) written.insert(root(i.words[word]));
        }
      }
    }
    std::set<std::size_t> needed;
    std::vector<std::uint32_t> open{out.bound};
    while (!open.empty()) {
      const auto found = defined_.find(open.back());
      open.pop_back();
      if (found == defined_.end() || found->second < test.begin || found->second > test.end) {
        // A constant, a variable, or a value made before the loop.
        if (found != defined_.end() && found->second > code_index(loop.header)) return false;
        continue;
      }
      const Instruction& i = code_[found->second];
      if (!is_pure(i) || (i.op == spv::OpLoad && i.words.size() != 4)) return false;
      if (i.op == spv::OpLoad && !stays(root(i.words[3]), written, calls)) return false;
      needed.insert(found->second);
      for (std::size_t word = 3; word < i.words.size(); ++word)
        if (std::ranges::find(i.ids, word) != i.ids.end()) open.push_back(i.words[word]);
    }
    out.bound_code.assign(needed.begin(), needed.end());
    return true;
  }

  bool stays(std::uint32_t variable, const std::set<std::uint32_t>& written, bool calls) const {
    const auto storage = storage_.find(variable);
    if (storage == storage_.end()) return false;
    switch (storage->second) {
      case spv::StorageClassUniform:
      case spv::StorageClassUniformConstant:
      case spv::StorageClassPushConstant:
      case spv::StorageClassInput:
        return true;
      case spv::StorageClassFunction:
        return !written.contains(variable);
      case spv::StorageClassPrivate:
        return !calls && !written.contains(variable);
      default:
        return false;
    }
  }

  /// How often it turns, when it begins and ends with constants.
  void count(const Block& before, Counting& out) const {
    const auto bound = numbers_.find(out.bound);
    if (bound == numbers_.end()) return;
    for (std::size_t at = before.end; at-- > before.begin;) {
      const Instruction& i = code_[at];
      if (i.op != spv::OpStore || i.words[1] != out.variable) continue;
      const auto first = numbers_.find(i.words[2]);
      if (first == numbers_.end()) return;
      const std::int64_t way =
          out.step > 0 ? std::int64_t{bound->second} - first->second : std::int64_t{first->second} - bound->second;
      const std::int64_t by = std::abs(std::int64_t{out.step});
      // The last step must not run over the end of the numbers.
      if (out.step > 0 ? bound->second > INT32_MAX - by : bound->second < INT32_MIN + by) return;
      out.turns = static_cast<std::uint64_t>(way < 0 ? 0 : out.inclusive ? way / by + 1 : (way + by - 1) / by);
      return;
    }
  }

  /// The variable behind a chain of accesses.
  std::uint32_t root(std::uint32_t id) const {
    for (auto found = defined_.find(id); found != defined_.end() && code_[found->second].op == spv::OpAccessChain;
         found = defined_.find(id))
      id = code_[found->second].words[3];
    return id;
  }
  std::size_t code_index(std::uint32_t label) const { return blocks_.at(label).begin; }
  const Instruction* within(std::uint32_t id, const Block& block) const {
    const auto found = defined_.find(id);
    return found == defined_.end() || found->second < block.begin || found->second > block.end ? nullptr
                                                                                               : &code_[found->second];
  }

  static constexpr std::int64_t kMostStep = 1 << 20;
  static constexpr int kMostSides = 8;
  const std::vector<Instruction>& code_;
  std::vector<Loop> loops_;
  std::uint32_t int_ = 0;
  std::map<std::uint32_t, std::int32_t> numbers_;
  std::map<std::uint32_t, spv::StorageClass> storage_;
  std::map<std::uint32_t, Block> blocks_;         ///< of the function, by label
  std::map<std::uint32_t, std::uint32_t> home_;   ///< in the function: id → label of its block
  std::map<std::uint32_t, std::size_t> defined_;  ///< in the function: id → where
  struct Use {
    std::size_t at = 0;
    std::uint32_t block = 0;
  };
  std::map<std::uint32_t, std::vector<Use>> uses_;  ///< in the function: variable → whatever does more than load it
};

}  // namespace

std::vector<std::uint32_t> targets_of(const Instruction& branch) {
  const Words& w = branch.words;
  switch (branch.op) {
    case spv::OpBranch:
      return {w[1]};
    case spv::OpBranchConditional:
      return {w[2], w[3]};
    case spv::OpSwitch: {
      std::vector<std::uint32_t> out{w[2]};
      for (std::size_t word = 4; word < w.size(); word += 2) out.push_back(w[word]);
      return out;
    }
    default:
      return {};
  }
}

std::vector<Loop> find_loops(const Module& module) { return Finder(module).run(); }

}  // namespace afterglow

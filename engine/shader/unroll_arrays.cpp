// SPDX-License-Identifier: MIT
#include "shader/unroll_arrays.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "core/saturated.h"
#include "shader/filter_anchor.h"
#include "shader/function_weights.h"
#include "shader/spirv_loops.h"
#include "shader/spirv_module.h"
#include "shader/spirv_passes.h"
#include "shader/whole_numbers.h"

namespace afterglow {
namespace {

constexpr std::uint64_t kMostTurns = 64;
constexpr std::size_t kMostTrials = 16, kMostLoops = 48;  ///< of a kernel: to find out takes time itself
constexpr std::uint64_t kMostMore = 8192;      ///< operations that a kernel has more than before, for each row
constexpr std::uint64_t kMostTried = 32768;    ///< of a loop, before anything is known of its turns
constexpr std::uint64_t kWorthOfAccess = 256;  ///< operations beside which memory does not count

using Labels = std::set<std::uint32_t>;

/// Arrays, vectors and matrices, and at how many places they are stepped through.
using Arrays = std::map<std::uint32_t, std::uint64_t>;

/// Where a shader steps through arrays, vectors and matrices of its own: by an index that is no constant.
class Steps {
 public:
  explicit Steps(const Module& module) {
    std::set<std::uint32_t> own, constants;
    std::uint32_t label = 0;
    for (const auto& i : module.code) {
      if (i.op == spv::OpConstant) constants.insert(i.result);
      const bool variable = i.op == spv::OpVariable &&
                            (i.words[3] == spv::StorageClassFunction || i.words[3] == spv::StorageClassPrivate);
      if (variable || i.op == spv::OpFunctionParameter) own.insert(i.result);
      if (i.op == spv::OpLabel) label = i.result;
      if (i.op != spv::OpAccessChain || !own.contains(i.words[3])) continue;
      if (std::any_of(i.words.begin() + 4, i.words.end(), [&](auto index) { return !constants.contains(index); }))
        ++by_block_[label][i.words[3]];
    }
  }
  bool none() const { return by_block_.empty(); }
  Arrays within(const Labels& blocks) const {
    Arrays out;
    for (const auto& [block, arrays] : by_block_)
      if (blocks.contains(block))
        for (const auto& [array, count] : arrays) out[array] += count;
    return out;
  }

 private:
  std::map<std::uint32_t, Arrays> by_block_;
};

/// Where the blocks of a loop stand, one behind the other.
struct Range {
  std::size_t begin = 0, end = 0;  ///< of the header's OpLabel; behind the last branch
  bool continues = false;          ///< turns may end by `continue`
};

/// Its blocks, when they stand one behind the other, and it has the form that for statements take.
std::optional<Range> blocks_of(const Module& module, const Loop& loop) {
  const auto& code = module.code;
  Range out{loop.head - 1, loop.head, false};
  if (code[out.begin].op != spv::OpLabel || code[loop.head + 1].op != spv::OpBranch) return std::nullopt;
  const std::uint32_t next = code[loop.head].words[2];
  std::size_t blocks = 0;
  int ways_to_next = 0;
  bool chooses = false;
  for (out.end = out.begin; code[out.end].op != spv::OpFunctionEnd; ++out.end) {
    const Instruction& i = code[out.end];
    if (i.op == spv::OpLabel && !loop.blocks.contains(i.result)) break;
    blocks += i.op == spv::OpLabel ? 1 : 0;
    chooses |= i.op == spv::OpSwitch;
    ways_to_next += static_cast<int>(std::ranges::count(targets_of(i), next));
  }
  out.continues = ways_to_next > 1;
  return blocks != loop.blocks.size() || (out.continues && chooses) ? std::nullopt : std::optional(out);
}

/// Of loops of one function, none within another: nothing for those whose turns cannot simply stand one behind the
/// other.
std::vector<std::optional<Range>> ranges_of(const Module& module, const std::vector<Loop>& loops) {
  const auto& code = module.code;
  std::vector<std::optional<Range>> out;
  std::map<std::uint32_t, std::size_t> made;                // id → index of the loop that makes it
  std::map<std::size_t, std::optional<std::size_t>> edges;  // from where on code is inside of which loop
  for (std::size_t n = 0; n < loops.size(); ++n) {
    out.push_back(blocks_of(module, loops[n]));
    if (!out[n]) continue;
    edges.try_emplace(out[n]->end);
    edges[out[n]->begin] = n;
    for (std::size_t at = out[n]->begin; at < out[n]->end; ++at)
      if (code[at].result != 0) made[code[at].result] = n;
  }
  if (made.empty()) return out;
  std::optional<std::size_t> inside;
  for (std::size_t at = loops.front().function; code[at].op != spv::OpFunctionEnd; ++at) {
    if (const auto edge = edges.find(at); edge != edges.end()) inside = edge->second;
    if (code[at].op == spv::OpLabel) continue;
    for (const auto word : code[at].ids) {
      const auto owner = made.find(code[at].words[word]);
      // The way into the loop is the one thing outside that may name something of it.
      if (owner == made.end() || owner->second == inside || at == loops[owner->second].counting->entry) continue;
      out[owner->second].reset();
    }
  }
  return out;
}

class Unroller {
 public:
  Unroller(Module module, int rows)
      : module_(std::move(module)),
        functions_(module_),
        most_(kMostMore * static_cast<std::uint64_t>(std::max(rows, 1))),
        filters_{function_named(module_, "main"), function_named(module_, kFilterFunction)} {
    for (const auto& loop : find_loops(module_)) origins_[loop.header] = loop.ordinal;
  }

  ArraysUnrolled run() {
    while (origins_.size() <= kMostLoops && try_one()) functions_ = FunctionWeights(module_);
    ArraysUnrolled out{module_.join(), {}};
    for_each_loop(module_, [&](std::uint32_t header) { out.loops.push_back(origins_.at(header)); });
    return out;
  }

 private:
  static bool is_short(const Loop& loop) {
    return loop.counting && loop.counting->turns && *loop.counting->turns > 0 && *loop.counting->turns <= kMostTurns;
  }

  template <class Do>
  static void for_each_loop(const Module& module, const Do& what) {
    std::uint32_t label = 0;
    for (const auto& i : module.code) {
      if (i.op == spv::OpLabel) label = i.result;
      if (i.op == spv::OpLoopMerge) what(label);
    }
  }

  /// Those that a turn was left by, and others that its number decides.
  void drop_dead_branches() {
    spvtools::Optimizer optimizer(kSpirvEnvironment);
    be_quiet(optimizer);
    // Twice: what could be left from within goes once what is within it has gone.
    optimizer.RegisterPass(spvtools::CreateDeadBranchElimPass()).RegisterPass(spvtools::CreateDeadBranchElimPass());
    auto left = run_passes(optimizer, module_);
    if (!left) return;
    bool known = true;
    for_each_loop(*left, [&](std::uint32_t header) { known &= origins_.contains(header); });
    if (known) module_ = std::move(*left);
  }

  /// Unrolls one of the loops, with all that is within it. False: there is none left to be tried.
  bool try_one() {
    const Steps steps(module_);
    if (steps.none()) return false;
    for (const auto& loop : find_loops(module_)) {
      if (!is_short(loop) || tried_.contains(loop.header) || filters_.contains(module_.code[loop.function].result))
        continue;
      const Arrays arrays = steps.within(loop.blocks);
      if (arrays.empty()) continue;
      if (tried_.size() == kMostTrials) return false;
      tried_.insert(loop.header);
      Unroller trial = *this;
      if (!trial.unrolls(loop, arrays)) continue;
      *this = std::move(trial);
      return true;
    }
    return false;
  }

  /// False: that is not possible, or does not pay; it is left in some state then.
  bool unrolls(const Loop& loop, const Arrays& arrays) {
    const std::uint32_t function = module_.code[loop.function].result;
    if (copies_of_all_within(loop) > kMostTried || !unroll_all_within(loop, function)) return false;
    decorate_copies();
    drop_dead_branches();
    // Copies of loops are more for a driver than an array in memory.
    if (std::ranges::any_of(find_loops(module_), [&](const Loop& l) { return made_.contains(l.header); })) return false;
    const Arrays left = Steps(module_).within(made_);
    const auto is_left = [&](const auto& array) { return left.contains(array.first); };
    return !std::ranges::all_of(arrays, is_left) && pay(function);
  }

  /// What the copies of one body come to, that of the loop or of one within it: turns are multiplied.
  std::uint64_t copies_of_all_within(const Loop& outermost) {
    const Steps steps(module_);
    std::vector<Loop> nest;
    for (auto& loop : find_loops(module_))
      if (outermost.blocks.contains(loop.header) && is_short(loop) && !steps.within(loop.blocks).empty())
        nest.push_back(std::move(loop));
    std::map<std::uint32_t, std::uint64_t> turns;  // header of a loop → how often its body stands there
    for (const Loop& loop : nest) {
      std::uint64_t& all = turns[loop.header] = 1;
      for (const Loop& around : nest)
        if (around.blocks.contains(loop.header)) all = saturated_product({all, *around.counting->turns});
    }
    std::map<std::uint32_t, std::uint64_t> weights;
    std::uint32_t label = 0;
    for (const auto& i : module_.code) {
      if (i.op == spv::OpLabel) label = i.result;
      for (const Loop& loop : nest)
        if (loop.blocks.contains(label))
          weights[loop.header] = saturated_sum({weights[loop.header], functions_.weight(i)});
    }
    std::uint64_t most = 0;
    for (const auto& [header, weight] : weights) most = std::max(most, saturated_product({weight, turns[header]}));
    return most;
  }

  bool unroll_all_within(const Loop& outermost, std::uint32_t function) {
    made_ = {outermost.header};
    made_weight_ = 0;
    for (bool any = true; any;) {
      any = false;
      const Steps steps(module_);
      std::vector<Loop> now;  // none within another
      for (auto& loop : find_loops(module_)) {
        const bool within = std::ranges::any_of(now, [&](const Loop& o) { return o.blocks.contains(loop.header); });
        if (!within && made_.contains(loop.header) && is_short(loop) && !steps.within(loop.blocks).empty())
          now.push_back(std::move(loop));
      }
      const auto ranges = ranges_of(module_, now);
      for (std::size_t n = now.size(); n-- > 0;) {  // what stands before keeps its place
        if (!ranges[n] || !is_light(now[n], *ranges[n], steps.within(now[n].blocks))) return false;
        unroll(now[n], *ranges[n]);
        any = true;
      }
      if (any) know_whole_numbers(module_, place_of(function));
    }
    return true;
  }

  std::size_t place_of(std::uint32_t function) const {
    const auto is_it = [&](const Instruction& i) { return i.op == spv::OpFunction && i.result == function; };
    return static_cast<std::size_t>(std::ranges::find_if(module_.code, is_it) - module_.code.begin());
  }

  /// Before it is tried: a body that is not much beside the memory that goes, not too often.
  bool is_light(const Loop& loop, const Range& range, const Arrays& arrays) {
    std::uint64_t weight = 0, accesses = 0;
    for (std::size_t at = range.begin; at < range.end; ++at) {
      if (functions_.turns(module_.code[at])) return false;
      weight = saturated_sum({weight, functions_.weight(module_.code[at])});
    }
    for (const auto& [array, count] : arrays) accesses += count;
    // Inner loops that begin at an outer one's number are counted here alone: as often as they stand there by now.
    made_weight_ = saturated_sum({made_weight_, saturated_product({weight, *loop.counting->turns})});
    return weight / kWorthOfAccess < accesses && made_weight_ <= kMostTried;
  }

  /// Behind it: what is left once the numbers of turns are known.
  bool pay(std::uint32_t function) {
    std::uint64_t weight = 0;
    std::uint32_t label = 0;
    for (const auto& i : module_.code) {
      if (i.op == spv::OpLabel) label = i.result;
      if (i.op == spv::OpFunctionEnd) label = 0;
      if (made_.contains(label)) weight = saturated_sum({weight, functions_.weight(i)});
    }
    weight = saturated_product({weight, functions_.times(function)});
    if (weight > most_ - more_) return false;
    more_ += weight;
    return true;
  }

  /// The header goes, the test stands before each turn and behind the last one.
  void unroll(const Loop& loop, const Range& range) {
    const Counting& counting = *loop.counting;
    const std::uint32_t test = module_.code[loop.head + 1].words[1], next = module_.code[loop.head].words[2];
    const std::uint32_t body = module_.code[counting.test].words[2];
    std::vector<Instruction> straight;
    std::vector<Renaming> turns;
    for (std::uint64_t turn = 0; turn < *counting.turns; ++turn) turns.push_back(copies(range, loop.blocks));
    turns.push_back(copies(range, {test}));
    for (std::uint64_t turn = 0; turn <= *counting.turns; ++turn) {
      Renaming& names = turns[turn];
      const bool last = turn == *counting.turns;
      if (!last) names[loop.header] = turns[turn + 1].at(test);
      std::uint32_t label = 0;
      for (std::size_t at = loop.head + 2; at < range.end; ++at) {
        const Instruction& i = module_.code[at];
        if (i.op == spv::OpLabel) label = i.result;
        if (last && label != test) continue;
        if (at == counting.test && !last && range.continues) {
          leave_by_continue(names.at(next), counting.bound, names.at(body), straight);
        } else if (at == counting.test) {
          straight.push_back(branch(last ? loop.merge : names.at(body)));
        } else {
          straight.push_back(renamed(i, names));
        }
        if (i.op != spv::OpLabel) continue;
        made_.insert(names.at(i.result));
        if (const auto origin = origins_.find(i.result); origin != origins_.end())
          origins_[names.at(i.result)] = origin->second;
      }
    }
    module_.code[counting.entry] = branch(turns.front().at(test));
    const auto at = [&](std::size_t place) { return module_.code.begin() + static_cast<std::ptrdiff_t>(place); };
    module_.code.erase(at(range.begin), at(range.end));
    module_.code.insert(at(range.begin), straight.begin(), straight.end());
  }

  /// What may be left from anywhere within it, and is not a loop, is a switch: here one with a single way.
  static void leave_by_continue(std::uint32_t next, std::uint32_t number, std::uint32_t body,
                                std::vector<Instruction>& code) {
    Instruction merge = Instruction::of_words(spv::OpSelectionMerge, {next, spv::SelectionControlMaskNone});
    merge.ids = {1};
    Instruction way = Instruction::of_words(spv::OpSwitch, {number, body});
    way.ids = {1, 2};
    code.push_back(std::move(merge));
    code.push_back(std::move(way));
  }

  static Instruction branch(std::uint32_t to) {
    Instruction out = Instruction::of_words(spv::OpBranch, {to});
    out.ids = {1};
    return out;
  }

  /// New names for what some blocks make.
  Renaming copies(const Range& range, const Labels& blocks) {
    Renaming out;
    std::uint32_t label = 0;
    for (std::size_t at = range.begin; at < range.end; ++at) {
      const Instruction& i = module_.code[at];
      if (i.op == spv::OpLabel) label = i.result;
      if (i.result == 0) continue;
      auto& names = copies_[i.result];
      if (blocks.contains(label)) names.push_back(out[i.result] = module_.fresh());
    }
    return out;
  }

  /// `precise` and the like hold for every copy; names go with what they named.
  void decorate_copies() {
    std::vector<Instruction> code;
    for (auto& i : module_.code) {
      const bool about = (i.op == spv::OpName || i.op == spv::OpDecorate) && copies_.contains(i.words[1]);
      if (about && i.op == spv::OpDecorate) decorate(i, i.words[1], code);
      if (!about) code.push_back(std::move(i));
    }
    module_.code = std::move(code);
    copies_.clear();
  }
  void decorate(const Instruction& decoration, std::uint32_t id, std::vector<Instruction>& code) const {
    if (const auto copies = copies_.find(id); copies != copies_.end()) {
      for (const auto copy : copies->second) decorate(decoration, copy, code);
      return;
    }
    code.push_back(decoration);
    code.back().words[1] = id;
  }

  Module module_;
  FunctionWeights functions_;
  std::uint64_t most_, more_ = 0;
  std::set<std::uint32_t> filters_;                 ///< functions with the loops over the taps of filters, which stay
  std::map<std::uint32_t, std::uint32_t> origins_;  ///< header → which of the loops before
  std::map<std::uint32_t, std::vector<std::uint32_t>> copies_;  ///< of what is gone
  std::uint64_t made_weight_ = 0;                               ///< of all that this trial put in place of loops
  Labels tried_, made_;                                         ///< headers; blocks of the loop that is being unrolled
};

}  // namespace

ArraysUnrolled unroll_over_arrays(std::vector<std::uint32_t> spirv, int rows) {
  auto module = parse(spirv);
  if (!module) return {std::move(spirv), {}};
  return Unroller(std::move(*module), rows).run();
}

}  // namespace afterglow

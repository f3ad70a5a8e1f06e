// SPDX-License-Identifier: MIT
#include "shader/guard_loops.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "shader/cpu/interleave.h"
#include "shader/loop_weights.h"
#include "shader/spirv_passes.h"
#include "shader/weight.h"
#include "shader/workgroup.h"

namespace afterglow {
namespace {

constexpr std::uint32_t kFirstVersion = 0x00010300;  // from here on there are storage buffers as a class of their own
constexpr std::uint32_t kNamesAllVersion = 0x00010400;  // from here on entry points name all their variables

class Guard {
 public:
  /// `may_share`: a workgroup has memory left for a word.
  Guard(Module& module, std::uint32_t binding, bool may_share)
      : module_(module),
        loops_(find_loops(module)),
        weights_(module, loops_),
        binding_(binding),
        may_share_(may_share) {}

  /// False: nothing is guarded, and the module is as it was.
  bool run() {
    if (!weights_.any() || module_.header[1] < kFirstVersion || !leaves_are_safe()) return false;
    const auto entries = std::ranges::count(module_.code, spv::OpEntryPoint, &Instruction::op);
    if (entries != 1) return false;
    declare();
    for (std::size_t i = 0; i < loops_.size(); ++i) {
      if (!weights_.guarded(i)) continue;
      if (loops_[i].counting)
        count_before(i);
      else
        count_turns(i);
    }
    renew_turns();
    begin_and_end();
    rebuild();
    return true;
  }

 private:
  /// A branch from the head of a loop to its end must not leave out what is used behind it.
  bool leaves_are_safe() const {
    for (std::size_t i = 0; i < loops_.size(); ++i) {
      const Loop& loop = loops_[i];
      if (!weights_.guarded(i) || loop.counting) continue;
      if (module_.code[loop.head + 1].op != spv::OpBranch) return false;
      std::set<std::uint32_t> inside;
      std::uint32_t label = 0;
      for (std::size_t at = loop.function; module_.code[at].op != spv::OpFunctionEnd; ++at) {
        const Instruction& code = module_.code[at];
        if (code.op == spv::OpLabel) label = code.result;
        if (code.op == spv::OpLabel || code.result == 0) continue;
        if (label != loop.header && loop.blocks.contains(label)) inside.insert(code.result);
      }
      label = 0;
      for (std::size_t at = loop.function; module_.code[at].op != spv::OpFunctionEnd; ++at) {
        const Instruction& code = module_.code[at];
        if (code.op == spv::OpLabel) label = code.result;
        if (label == loop.merge && code.op == spv::OpPhi) return false;
        if (loop.blocks.contains(label)) continue;
        if (std::ranges::any_of(code.ids, [&](auto word) { return inside.contains(code.words[word]); })) return false;
      }
    }
    return true;
  }

  // ------------------------------------------------------------------------------------------------ declarations

  std::uint32_t type(spv::Op op, const Words& operands) {
    for (const auto* list : {&module_.code, &declared_})
      for (const auto& i : *list)
        if (i.op == op && std::equal(i.words.begin() + 2, i.words.end(), operands.begin(), operands.end()))
          return i.words[1];
    return declare_words(op, operands);
  }
  std::uint32_t declare_words(spv::Op op, const Words& operands) {
    const std::uint32_t id = module_.fresh();
    Words words{id};
    words.insert(words.end(), operands.begin(), operands.end());
    declared_.push_back(Instruction::of_words(op, words));
    return id;
  }
  std::uint32_t constant(std::int64_t value, bool with_sign = true) {
    auto& id = constants_[{value, with_sign}];
    if (id != 0) return id;
    id = module_.fresh();
    Instruction i = Instruction::of_words(
        spv::OpConstant, {with_sign ? int_ : uint_, id, static_cast<std::uint32_t>(static_cast<std::int32_t>(value))});
    i.type = with_sign ? int_ : uint_;
    i.result = id;
    i.ids = {1, 2};
    declared_.push_back(std::move(i));
    return id;
  }
  std::uint32_t variable(std::uint32_t pointer, spv::StorageClass storage) {
    const std::uint32_t id = module_.fresh();
    Instruction i = Instruction::of_words(spv::OpVariable, {pointer, id, storage});
    i.type = pointer;
    i.result = id;
    i.ids = {1, 2};
    declared_.push_back(std::move(i));
    return id;
  }

  void declare() {
    int_ = type(spv::OpTypeInt, {32, 1});
    uint_ = type(spv::OpTypeInt, {32, 0});
    bool_ = type(spv::OpTypeBool, {});
    const std::uint32_t own = type(spv::OpTypePointer, {spv::StorageClassPrivate, int_});
    turns_ = variable(own, spv::StorageClassPrivate);
    where_ = variable(own, spv::StorageClassPrivate);
    for (std::size_t i = 0; i < loops_.size(); ++i)
      if (weights_.guarded(i) && weights_.waits(i)) turns_of_[i] = variable(own, spv::StorageClassPrivate);
    const std::uint32_t block = declare_words(spv::OpTypeStruct, {int_});
    word_pointer_ = type(spv::OpTypePointer, {spv::StorageClassStorageBuffer, int_});
    buffer_ = variable(declare_words(spv::OpTypePointer, {spv::StorageClassStorageBuffer, block}),
                       spv::StorageClassStorageBuffer);
    decorations_ = {Instruction::of_words(spv::OpMemberDecorate, {block, 0, spv::DecorationOffset, 0}),
                    Instruction::of_words(spv::OpDecorate, {block, spv::DecorationBlock}),
                    Instruction::of_words(spv::OpDecorate, {buffer_, spv::DecorationDescriptorSet, 0}),
                    Instruction::of_words(spv::OpDecorate, {buffer_, spv::DecorationBinding, binding_})};
    if (!turns_of_.empty() && may_share_) declare_for_groups();
  }

  void declare_for_groups() {
    told_ = variable(type(spv::OpTypePointer, {spv::StorageClassWorkgroup, int_}), spv::StorageClassWorkgroup);
    for (const Instruction& i : module_.code)
      if (i.op == spv::OpDecorate && i.words[2] == spv::DecorationBuiltIn &&
          i.words[3] == spv::BuiltInLocalInvocationIndex)
        index_ = i.words[1];
    if (index_ != 0) return;
    index_ = variable(type(spv::OpTypePointer, {spv::StorageClassInput, uint_}), spv::StorageClassInput);
    decorations_.push_back(
        Instruction::of_words(spv::OpDecorate, {index_, spv::DecorationBuiltIn, spv::BuiltInLocalInvocationIndex}));
    inputs_.push_back(index_);
  }

  // ----------------------------------------------------------------------------------------------------- code

  using Code = std::vector<Instruction>;
  std::uint32_t add(Code& to, spv::Op op, std::uint32_t type, const Words& operands) {
    const std::uint32_t id = module_.fresh();
    to.push_back(Instruction::of_ids(op, type, id, operands));
    return id;
  }
  static void store(Code& to, std::uint32_t pointer, std::uint32_t value) {
    to.push_back(Instruction::of_words(spv::OpStore, {pointer, value}));
  }
  /// What is left of the turns that a loop takes from. Loops with barriers have their own, which are the same for all
  /// of a workgroup: all of it leaves them at once.
  std::uint32_t turns_of(std::size_t loop) const {
    const auto own = turns_of_.find(loop);
    return own == turns_of_.end() ? turns_ : own->second;
  }
  /// Notes the loop as the one that ran out, unless one has before.
  void note(Code& to, std::size_t loop, std::uint32_t out_of_turns) {
    const std::uint32_t before = add(to, spv::OpLoad, int_, {where_});
    const std::uint32_t none = add(to, spv::OpIEqual, bool_, {before, constant(0)});
    const std::uint32_t first = add(to, spv::OpLogicalAnd, bool_, {none, out_of_turns});
    store(to, where_, add(to, spv::OpSelect, int_, {first, constant(std::int64_t{loops_[loop].ordinal} + 1), before}));
  }

  /// A counting loop pays for all its turns before the first.
  void count_before(std::size_t loop) {
    const Counting& c = *loops_[loop].counting;
    Code& code = before_[c.entry];
    Renaming copies;
    for (const auto at : c.bound_code) {
      const Instruction& i = module_.code[at];
      copies[i.result] = module_.fresh();
      code.push_back(renamed(i, copies));
    }
    const std::uint32_t first = add(code, spv::OpLoad, int_, {c.variable});
    const std::uint32_t bound = copies.contains(c.bound) ? copies.at(c.bound) : c.bound;
    const bool up = c.step > 0;
    const std::uint32_t low = up ? first : bound, high = up ? bound : first;
    const std::uint32_t turns = add(code, c.inclusive ? spv::OpSLessThanEqual : spv::OpSLessThan, bool_, {low, high});
    std::uint32_t last = add(code, spv::OpBitcast, uint_, {add(code, spv::OpISub, int_, {high, low})});
    if (!c.inclusive) last = add(code, spv::OpISub, uint_, {last, constant(1, false)});
    const std::int64_t by = std::abs(std::int64_t{c.step});
    if (by != 1) last = add(code, spv::OpUDiv, uint_, {last, constant(by, false)});  // the number of the last turn

    const std::uint32_t had = add(code, spv::OpLoad, int_, {turns_of(loop)});
    const std::uint32_t used_up = add(code, spv::OpSLessThan, bool_, {had, constant(0)});
    const std::uint32_t left =
        add(code, spv::OpBitcast, uint_, {add(code, spv::OpSelect, int_, {used_up, constant(0), had})});
    const std::uint32_t weight = weights_.weight(loop);
    const std::uint32_t most = weight == 1 ? left : add(code, spv::OpUDiv, uint_, {left, constant(weight, false)});
    std::uint32_t fits = add(code, spv::OpULessThan, bool_, {last, most});
    if (c.inclusive || by != 1) {  // the last step must not run over the end of the numbers
      const std::uint32_t within = up ? add(code, spv::OpSLessThanEqual, bool_, {high, constant(INT32_MAX - by)})
                                      : add(code, spv::OpSGreaterThanEqual, bool_, {low, constant(INT32_MIN + by)});
      fits = add(code, spv::OpLogicalAnd, bool_, {fits, within});
    }
    std::uint32_t used = add(code, spv::OpIAdd, uint_, {last, constant(1, false)});
    if (weight != 1) used = add(code, spv::OpIMul, uint_, {used, constant(weight, false)});
    const std::uint32_t rest = add(code, spv::OpISub, int_, {had, add(code, spv::OpBitcast, int_, {used})});
    const std::uint32_t after = add(code, spv::OpSelect, int_, {fits, rest, constant(-1)});
    store(code, turns_of(loop), add(code, spv::OpSelect, int_, {turns, after, had}));
    const std::uint32_t good = add(code, spv::OpLogicalOr, bool_, {add(code, spv::OpLogicalNot, bool_, {turns}), fits});
    note(code, loop, add(code, spv::OpLogicalNot, bool_, {good}));

    Instruction leave = module_.code[c.test];
    leave.words[1] = add(before_[c.test], spv::OpLogicalAnd, bool_, {leave.words[1], good});
    instead_[c.test] = {leave};
  }

  /// Any other loop pays for each turn, and is left from its head.
  void count_turns(std::size_t loop) {
    const Loop& l = loops_[loop];
    Code& code = before_[l.head];
    const std::uint32_t had = add(code, spv::OpLoad, int_, {turns_of(loop)});
    const std::uint32_t left = add(code, spv::OpISub, int_, {had, constant(weights_.weight(loop))});
    store(code, turns_of(loop), left);
    const std::uint32_t goes_on = add(code, spv::OpSGreaterThanEqual, bool_, {left, constant(0)});
    instead_[l.head + 1] = {
        Instruction::of_words(spv::OpBranchConditional, {goes_on, module_.code[l.head + 1].words[1], l.merge})};

    const auto merge = std::ranges::find_if(
        module_.code, [&](const Instruction& i) { return i.op == spv::OpLabel && i.result == l.merge; });
    const auto behind = static_cast<std::size_t>(merge - module_.code.begin()) + 1;
    Code at_end;
    const std::uint32_t now = add(at_end, spv::OpLoad, int_, {turns_of(loop)});
    note(at_end, loop, add(at_end, spv::OpSLessThan, bool_, {now, constant(0)}));
    at_end.insert(at_end.end(), before_[behind].begin(), before_[behind].end());
    before_[behind] = std::move(at_end);
    if (module_.code[behind].op == spv::OpUnreachable) instead_[behind] = {end_of_function(l.function)};
  }

  /// The head of a loop that nothing left can be left now.
  Instruction end_of_function(std::size_t function) {
    const std::uint32_t type = module_.code[function].type;
    const auto is_void = [&](const Instruction& i) { return i.op == spv::OpTypeVoid && i.words[1] == type; };
    if (std::ranges::any_of(module_.code, is_void)) return Instruction::of_words(spv::OpReturn, {});
    const std::uint32_t zero = module_.fresh();
    declared_.push_back(Instruction::of_ids(spv::OpConstantNull, type, zero, {}));
    return Instruction::of_words(spv::OpReturnValue, {zero});
  }

  std::uint32_t load_word(Code& code) {
    const std::uint32_t word = add(code, spv::OpAccessChain, word_pointer_, {buffer_, constant(0)});
    return add(code, spv::OpLoad, int_, {word});
  }
  /// One invocation of a workgroup reads it for all: others may write it meanwhile.
  std::uint32_t load_word_together(Code& code) {
    const std::uint32_t index = add(code, spv::OpLoad, uint_, {index_});
    const std::uint32_t is_first = add(code, spv::OpIEqual, bool_, {index, constant(0, false)});
    const std::uint32_t yes = module_.fresh(), behind = module_.fresh();
    code.push_back(Instruction::of_words(spv::OpSelectionMerge, {behind, spv::SelectionControlMaskNone}));
    code.push_back(Instruction::of_words(spv::OpBranchConditional, {is_first, yes, behind}));
    code.push_back(Instruction::of_words(spv::OpLabel, {yes}));
    store(code, told_, load_word(code));
    code.push_back(Instruction::of_words(spv::OpBranch, {behind}));
    code.push_back(Instruction::of_words(spv::OpLabel, {behind}));
    const std::uint32_t group = constant(spv::ScopeWorkgroup, false);
    const std::uint32_t memory =
        constant(spv::MemorySemanticsAcquireReleaseMask | spv::MemorySemanticsWorkgroupMemoryMask, false);
    code.push_back(Instruction::of_words(spv::OpControlBarrier, {group, group, memory}));
    return add(code, spv::OpLoad, int_, {told_});
  }

  /// Where the engine calls what an author wrote, for each pass of the kernel and each of its rows. Not in loops, which
  /// could renew their own turns.
  std::vector<std::size_t> calls_of_authors() const {
    const auto entry = std::ranges::find(module_.code, spv::OpEntryPoint, &Instruction::op);
    const std::set<std::uint32_t> engines{entry->words[2], function_named(module_, kRowFunction)};
    std::vector<std::size_t> calls;
    std::uint32_t function = 0, label = 0;
    for (std::size_t at = 0; at < module_.code.size(); ++at) {
      const Instruction& i = module_.code[at];
      if (i.op == spv::OpFunction) function = i.result;
      if (i.op == spv::OpLabel) label = i.result;
      if (i.op != spv::OpFunctionCall || !engines.contains(function) || engines.contains(i.words[3])) continue;
      const bool turns = std::ranges::any_of(loops_, [&](const Loop& loop) { return loop.blocks.contains(label); });
      if (weights_.guards(i.words[3]) && !turns) calls.push_back(at);
    }
    return calls;
  }

  /// Each of those calls has all turns for itself, unless a loop has run out before: which loops run out must not
  /// depend on how passes are fused, and how many rows are drawn at a time.
  void renew_turns() {
    for (const auto at : calls_of_authors()) {
      Code& code = before_[at];
      const std::uint32_t where = add(code, spv::OpLoad, int_, {where_});
      const std::uint32_t goes_on = add(code, spv::OpIEqual, bool_, {where, constant(0)});
      store(code, turns_, add(code, spv::OpSelect, int_, {goes_on, constant(kMaxTurns), constant(0)}));
    }
  }

  /// The turns of an invocation, and what it tells when they are used up.
  void begin_and_end() {
    const auto entry = std::ranges::find(module_.code, spv::OpEntryPoint, &Instruction::op);
    const std::uint32_t main = entry->words[2];
    std::size_t at = 0;
    while (module_.code[at].op != spv::OpFunction || module_.code[at].result != main) ++at;
    while (module_.code[at].op != spv::OpLabel) ++at;
    const std::size_t label = at;
    do ++at;
    while (module_.code[at].op == spv::OpVariable);
    Code code;
    const std::uint32_t told = told_ == 0 ? load_word(code) : load_word_together(code);
    const std::uint32_t goes_on = add(code, spv::OpIEqual, bool_, {told, constant(0)});
    const std::uint32_t turns = add(code, spv::OpSelect, int_, {goes_on, constant(kMaxTurns), constant(0)});
    store(code, where_, told);
    store(code, turns_, turns);
    for (const auto& [loop, own] : turns_of_) store(code, own, turns);
    if (told_ != 0) {  // what comes from the first block comes from this one now
      const std::uint32_t first = module_.code[label].result;
      instead_[label] = {Instruction::of_words(spv::OpLabel, {module_.fresh()})};
      code.push_back(Instruction::of_words(spv::OpBranch, {first}));
      code.push_back(Instruction::of_words(spv::OpLabel, {first}));
    }
    code.insert(code.end(), before_[at].begin(), before_[at].end());
    before_[at] = std::move(code);
    for (; module_.code[at].op != spv::OpFunctionEnd; ++at) {
      const bool returns =
          module_.code[at].op == spv::OpReturn || (instead_.contains(at) && instead_[at].front().op == spv::OpReturn);
      if (!returns) continue;
      Code& end = before_[at];
      const std::uint32_t where = add(end, spv::OpLoad, int_, {where_});
      const std::uint32_t tells = add(end, spv::OpINotEqual, bool_, {where, constant(0)});
      const std::uint32_t yes = module_.fresh(), behind = module_.fresh();
      end.push_back(Instruction::of_words(spv::OpSelectionMerge, {behind, spv::SelectionControlMaskNone}));
      end.push_back(Instruction::of_words(spv::OpBranchConditional, {tells, yes, behind}));
      end.push_back(Instruction::of_words(spv::OpLabel, {yes}));
      store(end, add(end, spv::OpAccessChain, word_pointer_, {buffer_, constant(0)}), where);
      end.push_back(Instruction::of_words(spv::OpBranch, {behind}));
      end.push_back(Instruction::of_words(spv::OpLabel, {behind}));
    }
  }

  void rebuild() {
    Code out;
    bool declared = false, decorated = false;
    for (std::size_t at = 0; at < module_.code.size(); ++at) {
      Instruction& i = module_.code[at];
      if (i.op == spv::OpEntryPoint) {
        Words named = inputs_;
        if (module_.header[1] >= kNamesAllVersion) {  // before, they name inputs and outputs alone
          named.insert(named.end(), {turns_, where_, buffer_});
          for (const auto& [loop, own] : turns_of_) named.push_back(own);
          if (told_ != 0) named.push_back(told_);
        }
        i.words.insert(i.words.end(), named.begin(), named.end());
        i.words[0] += static_cast<std::uint32_t>(named.size()) << spv::WordCountShift;
      }
      const bool is_type = i.op >= spv::OpTypeVoid && i.op <= spv::OpTypeForwardPointer;
      if (is_type && !std::exchange(decorated, true)) out.insert(out.end(), decorations_.begin(), decorations_.end());
      if (i.op == spv::OpFunction && !std::exchange(declared, true))
        out.insert(out.end(), declared_.begin(), declared_.end());
      if (const auto more = before_.find(at); more != before_.end())
        out.insert(out.end(), more->second.begin(), more->second.end());
      if (const auto other = instead_.find(at); other != instead_.end())
        out.insert(out.end(), other->second.begin(), other->second.end());
      else
        out.push_back(std::move(i));
    }
    module_.code = std::move(out);
  }

  Module& module_;
  std::vector<Loop> loops_;
  LoopWeights weights_;
  const std::uint32_t binding_;
  const bool may_share_;
  Code declared_, decorations_;
  std::map<std::size_t, Code> before_, instead_;  ///< by place in the module as it was
  std::map<std::pair<std::int64_t, bool>, std::uint32_t> constants_;
  std::uint32_t int_ = 0, uint_ = 0, bool_ = 0, word_pointer_ = 0;
  std::uint32_t turns_ = 0, where_ = 0, buffer_ = 0;  ///< what is left of an invocation's turns; the loop; the word
  std::map<std::size_t, std::uint32_t> turns_of_;     ///< the same of loops with barriers
  std::uint32_t told_ = 0,
                index_ = 0;  ///< where there are such loops: the word for the workgroup; who an invocation is
  Words inputs_;             ///< that were not there
};

}  // namespace

LoopsGuarded guard_loops(const std::vector<std::uint32_t>& spirv, std::uint32_t binding) {
  auto module = parse(spirv);
  const bool may_share = shared_bytes(spirv) + sizeof(std::uint32_t) <= kMaxSharedBytes;
  if (!module || !Guard(*module, binding, may_share).run()) return {spirv, false};
  return {module->join(), true};
}

}  // namespace afterglow

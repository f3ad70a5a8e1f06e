// SPDX-License-Identifier: MIT
#include "shader/cpu/flat_parameters.h"

#include <algorithm>
#include <map>
#include <set>

#include "shader/spirv_module.h"

namespace afterglow {
namespace {

constexpr std::uint32_t kUnit = 16;  ///< bytes of the block that one location hands on

/// Takes the numbers of the uniform block and of the push constants from inputs: location 0 holds the push constants,
/// location n the n-th 16 bytes of the block.
class Flattener {
 public:
  explicit Flattener(Module& module) : module_(module) {}

  /// False: nothing is read of them, or in a way that is not known.
  bool run() {
    look();
    if (chains_.empty() || entry_ == 0) return false;
    if (!std::ranges::all_of(module_.code, [this](const Instruction& i) { return understood(i); })) return false;
    std::vector<Instruction> body;
    code_.swap(body);
    const auto first = std::ranges::find(module_.code, spv::OpFunction, &Instruction::op);
    for (auto at = first; at != module_.code.end(); ++at) copy(*at);
    code_.swap(body);
    // Declarations stand before the functions, decorations before the types.
    bool decorated = false;
    for (auto at = module_.code.begin(); at != first; ++at) {
      const bool type = at->op >= spv::OpTypeVoid && at->op <= spv::OpTypeForwardPointer;
      if (type && !decorated) decorate(), decorated = true;
      code_.push_back(*at);
      if (at->op == spv::OpEntryPoint) add_to_interface(code_.back());
    }
    code_.insert(code_.end(), declarations_.begin(), declarations_.end());
    code_.insert(code_.end(), body.begin(), body.end());
    module_.code = std::move(code_);
    return true;
  }

  std::uint32_t locations() const { return inputs_.empty() ? 0 : inputs_.rbegin()->first + 1; }

 private:
  struct Type {
    std::uint32_t component = 0, count = 0;  ///< of 32-bit numbers
  };
  struct Chain {
    std::uint32_t location = 0, component = 0;
  };

  void look() {
    std::map<std::uint32_t, std::uint32_t> pointees;
    std::map<std::uint32_t, Words> structs;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> offsets;
    std::map<std::uint32_t, std::uint32_t> blocks, constants;  // variable → struct; id → value
    for (const auto& i : module_.code) {
      const Words& w = i.words;
      if (i.op == spv::OpEntryPoint) entry_ = w[2];
      if (i.op == spv::OpMemberDecorate && w.size() == 5 && w[3] == spv::DecorationOffset) offsets[{w[1], w[2]}] = w[4];
      if ((i.op == spv::OpTypeInt || i.op == spv::OpTypeFloat) && w[2] == 32) types_[w[1]] = {w[1], 1};
      if (i.op == spv::OpTypeInt && w[2] == 32 && w[3] == 0) bits_ = w[1];
      if (i.op == spv::OpTypeVector && types_.contains(w[2])) types_[w[1]] = {w[2], w[3]};
      if (i.op == spv::OpTypePointer) pointees[w[1]] = w[3];
      if (i.op == spv::OpConstant && w.size() == 4) constants[i.result] = w[3];
      if (i.op == spv::OpVariable && (w[3] == spv::StorageClassUniform || w[3] == spv::StorageClassPushConstant)) {
        blocks[i.result] = pointees[i.type];
        if (w[3] == spv::StorageClassPushConstant) pushed_.insert(i.result);
      }
      if (i.op == spv::OpAccessChain && blocks.contains(w[3]) && (w.size() == 5 || w.size() == 6) &&
          std::all_of(w.begin() + 4, w.end(), [&](std::uint32_t id) { return constants.contains(id); })) {
        const auto offset = offsets.find({blocks[w[3]], constants[w[4]]});
        if (offset == offsets.end()) continue;
        const std::uint32_t bytes = offset->second + (w.size() == 6 ? 4 * constants[w[5]] : 0);
        chains_[i.result] = {bytes / kUnit + (pushed_.contains(w[3]) ? 0 : 1), bytes % kUnit / 4};
      }
    }
    for (const auto& [variable, type] : blocks) variables_.insert(variable);
  }

  /// Of the blocks only numbers are read, and in one way.
  bool understood(const Instruction& i) const {
    if (i.op == spv::OpName || i.op == spv::OpDecorate || i.op == spv::OpVariable) return true;
    if (i.op == spv::OpAccessChain && variables_.contains(i.words[3])) return chains_.contains(i.result);
    if (i.op == spv::OpLoad && chains_.contains(i.words[3])) {
      const auto type = types_.find(i.type);
      return type != types_.end() && chains_.at(i.words[3]).component + type->second.count <= 4;
    }
    return std::ranges::none_of(i.ids, [&](std::uint16_t word) {
      return variables_.contains(i.words[word]) || (chains_.contains(i.words[word]) && i.words[word] != i.result);
    });
  }

  void copy(const Instruction& i) {
    if (i.op == spv::OpAccessChain && chains_.contains(i.result)) return;
    if (i.op == spv::OpLoad && chains_.contains(i.words[3]))
      load(i, chains_.at(i.words[3]));
    else
      code_.push_back(i);
  }

  void load(const Instruction& i, Chain from) {
    const Type type = types_.at(i.type);
    const std::uint32_t four = bits_of(4), whole = module_.fresh();
    code_.push_back(Instruction::of_ids(spv::OpLoad, four, whole, {input(from.location)}));
    std::uint32_t part = whole;
    const std::uint32_t part_type = bits_of(type.count);
    const bool same = part_type == i.type;
    if (type.count < 4) {
      part = same ? i.result : module_.fresh();
      Words words{part_type, part, whole};
      if (type.count > 1) words.push_back(whole);
      for (std::uint32_t c = 0; c < type.count; ++c) words.push_back(from.component + c);
      Instruction picked =
          Instruction::of_words(type.count == 1 ? spv::OpCompositeExtract : spv::OpVectorShuffle, words);
      picked.type = part_type, picked.result = part;
      code_.push_back(std::move(picked));
    }
    if (part == i.result) return;
    code_.push_back(Instruction::of_ids(same ? spv::OpCopyObject : spv::OpBitcast, i.type, i.result, {part}));
  }

  Instruction& declare(spv::Op op, const Words& words) {
    declarations_.push_back(Instruction::of_words(op, words));
    return declarations_.back();
  }

  /// Whole numbers without a sign. The type may be declared behind what is looked at, but before all functions.
  std::uint32_t bits_of(std::uint32_t count) {
    if (bits_ == 0) {
      bits_ = module_.fresh();
      declare(spv::OpTypeInt, {bits_, 32, 0});
    }
    if (count == 1) return bits_;
    for (const auto& [id, type] : types_)
      if (type.component == bits_ && type.count == count) return id;
    const std::uint32_t id = module_.fresh();
    types_[id] = {bits_, count};
    declare(spv::OpTypeVector, {id, bits_, count});
    return id;
  }

  std::uint32_t input(std::uint32_t location) {
    if (const auto known = inputs_.find(location); known != inputs_.end()) return known->second;
    if (pointer_ == 0) {
      const std::uint32_t four = bits_of(4);
      pointer_ = module_.fresh();
      declare(spv::OpTypePointer, {pointer_, spv::StorageClassInput, four});
    }
    const std::uint32_t id = inputs_[location] = module_.fresh();
    declare(spv::OpVariable, {pointer_, id, spv::StorageClassInput});
    return id;
  }

  void decorate() {
    for (const auto& [location, id] : inputs_) {
      code_.push_back(Instruction::of_words(spv::OpDecorate, {id, spv::DecorationFlat}));
      code_.push_back(Instruction::of_words(spv::OpDecorate, {id, spv::DecorationLocation, location}));
    }
  }

  void add_to_interface(Instruction& entry) const {
    for (const auto& [location, id] : inputs_) entry.words.push_back(id);
    entry.words[0] = static_cast<std::uint32_t>(entry.words.size()) << spv::WordCountShift |
                     static_cast<std::uint32_t>(spv::OpEntryPoint);
  }

  Module& module_;
  std::vector<Instruction> code_, declarations_;
  std::map<std::uint32_t, Type> types_;
  std::map<std::uint32_t, Chain> chains_;
  std::set<std::uint32_t> variables_, pushed_;
  std::map<std::uint32_t, std::uint32_t> inputs_;  ///< location → variable
  std::uint32_t entry_ = 0, bits_ = 0, pointer_ = 0;
};

/// The full-screen triangle of gpu/fullscreen_vertex.h, which also hands on the push constants (location 0) and the
/// block (locations 1 …). Each number takes a bit of the vertex's index that is 0: a driver that sees what a vertex
/// shader hands on to be the block's would read the block in its place.
Words triangle_that_hands_on(std::uint32_t locations) {
  enum Id : std::uint32_t {
    nothing = 1,
    function,
    real,
    real4,
    whole,
    bits,
    bits4,
    yes,
    zero,
    one,
    two,
    sign,
    minus,
    three,
    nought,
    unity,
    count,
    list,
    block,
    push,
    in_index,
    out_place,
    out_bits,
    from_block,
    from_push,
    member_block,
    member_push,
    index,
    place,
    block_variable,
    push_variable,
    main,
    label,
    at,
    is_two,
    is_one,
    x,
    y,
    corner,
    top,
    four_tops,
    first_output
  };
  std::vector<Instruction> code;
  const auto add = [&](spv::Op op, const Words& words) { code.push_back(Instruction::of_words(op, words)); };
  const std::uint32_t units = locations - 1;
  const auto output = [](std::uint32_t location) { return first_output + location; };
  std::uint32_t bound = first_output + locations;
  std::vector<std::uint32_t> unit_numbers;  // constants 0 … units − 1
  for (std::uint32_t n = 0; n < units; ++n) unit_numbers.push_back(bound++);

  add(spv::OpCapability, {spv::CapabilityShader});
  add(spv::OpMemoryModel, {spv::AddressingModelLogical, spv::MemoryModelGLSL450});
  Words entry{spv::ExecutionModelVertex, main, 0x6e69616d, 0, index, place};  // "main"
  for (std::uint32_t n = 0; n < locations; ++n) entry.push_back(output(n));
  add(spv::OpEntryPoint, entry);
  add(spv::OpDecorate, {index, spv::DecorationBuiltIn, spv::BuiltInVertexIndex});
  add(spv::OpDecorate, {place, spv::DecorationBuiltIn, spv::BuiltInPosition});
  for (std::uint32_t n = 0; n < locations; ++n) {
    add(spv::OpDecorate, {output(n), spv::DecorationFlat});
    add(spv::OpDecorate, {output(n), spv::DecorationLocation, n});
  }
  add(spv::OpDecorate, {push, spv::DecorationBlock});
  add(spv::OpMemberDecorate, {push, 0, spv::DecorationOffset, 0});
  if (units > 0) {
    add(spv::OpDecorate, {list, spv::DecorationArrayStride, kUnit});
    add(spv::OpDecorate, {block, spv::DecorationBlock});
    add(spv::OpMemberDecorate, {block, 0, spv::DecorationOffset, 0});
    add(spv::OpDecorate, {block_variable, spv::DecorationDescriptorSet, 0});
    add(spv::OpDecorate, {block_variable, spv::DecorationBinding, 0});
  }
  add(spv::OpTypeVoid, {nothing});
  add(spv::OpTypeFunction, {function, nothing});
  add(spv::OpTypeFloat, {real, 32});
  add(spv::OpTypeVector, {real4, real, 4});
  add(spv::OpTypeInt, {whole, 32, 1});
  add(spv::OpTypeInt, {bits, 32, 0});
  add(spv::OpTypeVector, {bits4, bits, 4});
  add(spv::OpTypeBool, {yes});
  add(spv::OpConstant, {whole, zero, 0});
  add(spv::OpConstant, {whole, one, 1});
  add(spv::OpConstant, {whole, two, 2});
  add(spv::OpConstant, {bits, sign, 31});
  add(spv::OpConstant, {real, minus, 0xbf800000});
  add(spv::OpConstant, {real, three, 0x40400000});
  add(spv::OpConstant, {real, nought, 0});
  add(spv::OpConstant, {real, unity, 0x3f800000});
  add(spv::OpTypeStruct, {push, bits4});
  add(spv::OpTypePointer, {from_push, spv::StorageClassPushConstant, push});
  add(spv::OpTypePointer, {member_push, spv::StorageClassPushConstant, bits4});
  add(spv::OpVariable, {from_push, push_variable, spv::StorageClassPushConstant});
  if (units > 0) {
    add(spv::OpConstant, {bits, count, units});
    for (std::uint32_t n = 0; n < units; ++n) add(spv::OpConstant, {bits, unit_numbers[n], n});
    add(spv::OpTypeArray, {list, bits4, count});
    add(spv::OpTypeStruct, {block, list});
    add(spv::OpTypePointer, {from_block, spv::StorageClassUniform, block});
    add(spv::OpTypePointer, {member_block, spv::StorageClassUniform, bits4});
    add(spv::OpVariable, {from_block, block_variable, spv::StorageClassUniform});
  }
  add(spv::OpTypePointer, {in_index, spv::StorageClassInput, whole});
  add(spv::OpTypePointer, {out_place, spv::StorageClassOutput, real4});
  add(spv::OpTypePointer, {out_bits, spv::StorageClassOutput, bits4});
  add(spv::OpVariable, {in_index, index, spv::StorageClassInput});
  add(spv::OpVariable, {out_place, place, spv::StorageClassOutput});
  for (std::uint32_t n = 0; n < locations; ++n) add(spv::OpVariable, {out_bits, output(n), spv::StorageClassOutput});

  add(spv::OpFunction, {nothing, main, spv::FunctionControlMaskNone, function});
  add(spv::OpLabel, {label});
  add(spv::OpLoad, {whole, at, index});
  add(spv::OpIEqual, {yes, is_two, at, two});
  add(spv::OpSelect, {real, x, is_two, three, minus});
  add(spv::OpIEqual, {yes, is_one, at, one});
  add(spv::OpSelect, {real, y, is_one, three, minus});
  add(spv::OpCompositeConstruct, {real4, corner, x, y, nought, unity});
  add(spv::OpStore, {place, corner});
  add(spv::OpShiftRightLogical, {bits, top, at, sign});
  add(spv::OpCompositeConstruct, {bits4, four_tops, top, top, top, top});
  for (std::uint32_t n = 0; n < locations; ++n) {
    const std::uint32_t chain = bound++, read = bound++, handed = bound++;
    if (n == 0)
      add(spv::OpAccessChain, {member_push, chain, push_variable, zero});
    else
      add(spv::OpAccessChain, {member_block, chain, block_variable, zero, unit_numbers[n - 1]});
    add(spv::OpLoad, {bits4, read, chain});
    add(spv::OpBitwiseXor, {bits4, handed, read, four_tops});
    add(spv::OpStore, {output(n), handed});
  }
  add(spv::OpReturn, {});
  add(spv::OpFunctionEnd, {});
  const Module module{{0x07230203, 0x00010300, 0, bound, 0}, std::move(code)};
  return module.join();
}

}  // namespace

std::optional<FlatParameters> flat_parameters(const std::vector<std::uint32_t>& spirv, std::uint32_t most_locations) {
  auto module = parse(spirv);
  if (!module) return std::nullopt;
  Flattener flattener(*module);
  if (!flattener.run() || flattener.locations() > most_locations) return std::nullopt;
  return FlatParameters{module->join(), triangle_that_hands_on(flattener.locations())};
}

}  // namespace afterglow

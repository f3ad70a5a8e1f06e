// SPDX-License-Identifier: MIT
#include "shader/cpu/defeat_uniform_inlining.h"

#include <algorithm>
#include <set>

#include "shader/spirv_module.h"

namespace afterglow {
namespace {

class Hider {
 public:
  explicit Hider(Module& module) : module_(module) {}

  /// False: there is nothing to hide, or nowhere to hide it.
  bool run() {
    look();
    if (position_ == 0 || (blocks_.empty() && !divides_)) return false;
    const auto first = std::ranges::find(module_.code, spv::OpFunction, &Instruction::op);
    code_.assign(module_.code.begin(), first);
    for (std::uint32_t n = 1; n <= 4; ++n) bits_of_[n] = type_of_bits(n);
    zero_index_ = constant(0);
    sign_ = constant(31);
    for (auto at = first; at != module_.code.end(); ++at) copy(*at);
    module_.code = std::move(code_);
    return true;
  }

 private:
  struct Shape {
    std::uint32_t component = 0;  ///< id of its type
    std::uint32_t count = 1;
  };

  static bool is_division(spv::Op op) { return op == spv::OpFDiv || op == spv::OpFMod || op == spv::OpFRem; }

  /// Whether it is a constant without a zero in it.
  bool is_sure(const Instruction& i) const {
    if (i.op == spv::OpConstant) return (i.words.back() & ~kSignBit) != 0;
    return i.op == spv::OpConstantComposite &&
           std::all_of(i.words.begin() + 3, i.words.end(), [this](std::uint32_t id) { return sure_.contains(id); });
  }

  /// Types, blocks, constants, and gl_FragCoord or gl_WorkGroupID: of both no one has the highest bit.
  void look() {
    std::map<std::uint32_t, std::uint32_t> pointees;  // pointer type → what it points to
    for (const auto& i : module_.code) {
      const Words& w = i.words;
      if (i.op == spv::OpDecorate && w.size() == 4 && w[2] == spv::DecorationBuiltIn &&
          (w[3] == spv::BuiltInFragCoord || w[3] == spv::BuiltInWorkgroupId))
        position_ = w[1];
      if ((i.op == spv::OpTypeInt || i.op == spv::OpTypeFloat) && w[2] == 32) shapes_[w[1]] = {w[1], 1};
      if (i.op == spv::OpTypeInt && w[2] == 32 && w[3] == 0) bits_ = w[1];
      if (i.op == spv::OpTypeVector && shapes_.contains(w[2])) shapes_[w[1]] = {w[2], w[3]};
      if (i.op == spv::OpTypePointer) pointees[w[1]] = w[3];
      divides_ = divides_ || is_division(i.op);
      if (is_sure(i)) sure_.insert(i.result);
      if (i.op != spv::OpVariable) continue;
      if (i.result == position_) position_type_ = pointees[i.type];
      if (w[3] == spv::StorageClassUniform || w[3] == spv::StorageClassPushConstant) blocks_.insert(i.result);
    }
  }

  /// `n` whole numbers without a sign; declared when the module has no such type.
  std::uint32_t type_of_bits(std::uint32_t n) {
    if (bits_ == 0) {
      bits_ = module_.fresh();
      code_.push_back(Instruction::of_words(spv::OpTypeInt, {bits_, 32, 0}));
    }
    if (n == 1) return bits_;
    for (const auto& [id, shape] : shapes_)
      if (shape.component == bits_ && shape.count == n) return id;
    const std::uint32_t type = module_.fresh();
    code_.push_back(Instruction::of_words(spv::OpTypeVector, {type, bits_, n}));
    return type;
  }

  std::uint32_t constant(std::uint32_t value) {
    const std::uint32_t id = module_.fresh();
    code_.push_back(Instruction::of_words(spv::OpConstant, {bits_, id, value}));
    return id;
  }

  std::uint32_t add(spv::Op op, std::uint32_t type, const Words& operands) {
    const std::uint32_t id = module_.fresh();
    code_.push_back(Instruction::of_ids(op, type, id, operands));
    return id;
  }

  void copy(const Instruction& i) {
    if (i.op == spv::OpFunction) zero_ = 0;
    const bool declares = i.op == spv::OpFunction || i.op == spv::OpFunctionParameter || i.op == spv::OpLabel ||
                          i.op == spv::OpVariable || i.op == spv::OpLine || i.op == spv::OpNoLine;
    if (!declares && zero_ == 0) zero_ = make_zero();
    if (i.op == spv::OpAccessChain && blocks_.contains(i.words[3])) chains_.insert(i.result);
    if (i.op == spv::OpLoad && chains_.contains(i.words[3]) && shapes_.contains(i.type))
      load(i);
    else if (is_division(i.op) && shapes_.contains(i.type) && !sure_.contains(i.words[4]))
      divide(i);
    else
      code_.push_back(i);
  }

  /// The highest bit of the pixel's or the workgroup's place, at the head of a function.
  std::uint32_t make_zero() {
    const std::uint32_t place = add(spv::OpLoad, position_type_, {position_});
    const std::uint32_t component = shapes_.at(position_type_).component;
    const std::uint32_t x = add(spv::OpVectorExtractDynamic, component, {place, zero_index_});
    const std::uint32_t bits = component == bits_ ? x : add(spv::OpBitcast, bits_, {x});
    return add(spv::OpShiftRightLogical, bits_, {bits, sign_});
  }

  void load(const Instruction& i) {
    Instruction read = i;
    read.result = read.words[2] = module_.fresh();
    code_.push_back(read);
    hide(i.type, read.result, i.result);
  }

  void divide(const Instruction& i) {
    Instruction division = i;
    division.words[4] = module_.fresh();
    hide(i.type, i.words[4], division.words[4]);
    // A driver that knows that y − y is 0 takes 0/x for 0, whatever x turns out to be.
    if (!sure_.contains(i.words[3])) {
      division.words[3] = module_.fresh();
      hide(i.type, i.words[3], division.words[3]);
    }
    code_.push_back(division);
  }

  /// Makes `hidden` of `value`: the same bits, as the driver cannot know.
  void hide(std::uint32_t value_type, std::uint32_t value, std::uint32_t hidden) {
    const Shape& shape = shapes_.at(value_type);
    const std::uint32_t type = bits_of_[shape.count];
    const std::uint32_t bits = value_type == type ? value : add(spv::OpBitcast, type, {value});
    const std::uint32_t zeros =
        shape.count == 1 ? zero_ : add(spv::OpCompositeConstruct, type, Words(shape.count, zero_));
    if (value_type == type) {
      code_.push_back(Instruction::of_ids(spv::OpBitwiseXor, type, hidden, {bits, zeros}));
    } else {
      const std::uint32_t same = add(spv::OpBitwiseXor, type, {bits, zeros});
      code_.push_back(Instruction::of_ids(spv::OpBitcast, value_type, hidden, {same}));
    }
  }

  Module& module_;
  std::vector<Instruction> code_;
  std::map<std::uint32_t, Shape> shapes_;  ///< of types of 32-bit numbers
  static constexpr std::uint32_t kSignBit = 0x80000000u;
  std::set<std::uint32_t> blocks_, chains_;
  std::set<std::uint32_t> sure_;  ///< constants without a zero in them
  bool divides_ = false;
  std::uint32_t position_ = 0, position_type_ = 0;  ///< gl_FragCoord or gl_WorkGroupID
  std::uint32_t bits_ = 0, bits_of_[5] = {};
  std::uint32_t zero_index_ = 0, sign_ = 0, zero_ = 0;
};

}  // namespace

std::vector<std::uint32_t> defeat_uniform_inlining(const std::vector<std::uint32_t>& spirv) {
  auto module = parse(spirv);
  return module && Hider(*module).run() ? module->join() : spirv;
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include <algorithm>

#include "shader/cpu/flat_parameters.h"
#include "shader/spirv_module.h"

namespace afterglow {
namespace {

constexpr std::uint32_t kUnit = 16;  ///< bytes of a row of the block

enum : std::uint32_t {
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
  block_number,
  push_number,
  index,
  place,
  block_variable,
  push_variable,
  main,
  label,
  at,
  at_bits,
  is_two,
  is_one,
  x,
  y,
  corner,
  top,
  first_free
};

class Triangle {
 public:
  Triangle(const std::vector<GivenNumber>& numbers, std::uint32_t locations)
      : numbers_(numbers),
        locations_(locations),
        rows_(rows_of(numbers)),
        first_output_(take(locations)),
        first_constant_(take(std::max(rows_, 4u))) {}

  Words make() {
    begin();
    decorate();
    declare();
    body();
    return Module{{0x07230203, 0x00010300, 0, bound_, 0}, std::move(code_)}.join();
  }

 private:
  /// Of the block, as far as it is read.
  static std::uint32_t rows_of(const std::vector<GivenNumber>& numbers) {
    std::uint32_t rows = 0;
    for (const auto& number : numbers)
      if (number.in_block) rows = std::max(rows, number.offset / kUnit + 1);
    return rows;
  }

  std::uint32_t take(std::uint32_t ids) {
    bound_ += ids;
    return bound_ - ids;
  }
  void add(spv::Op op, const Words& words) { code_.push_back(Instruction::of_words(op, words)); }
  std::uint32_t output(std::uint32_t location) const { return first_output_ + location; }
  /// Of a small whole number.
  std::uint32_t constant(std::uint32_t value) const { return first_constant_ + value; }

  void begin() {
    add(spv::OpCapability, {spv::CapabilityShader});
    add(spv::OpMemoryModel, {spv::AddressingModelLogical, spv::MemoryModelGLSL450});
    Words entry{spv::ExecutionModelVertex, main, 0x6e69616d, 0, index, place};  // "main"
    for (std::uint32_t n = 0; n < locations_; ++n) entry.push_back(output(n));
    add(spv::OpEntryPoint, entry);
  }

  void decorate() {
    add(spv::OpDecorate, {index, spv::DecorationBuiltIn, spv::BuiltInVertexIndex});
    add(spv::OpDecorate, {place, spv::DecorationBuiltIn, spv::BuiltInPosition});
    for (std::uint32_t n = 0; n < locations_; ++n) {
      add(spv::OpDecorate, {output(n), spv::DecorationFlat});
      add(spv::OpDecorate, {output(n), spv::DecorationLocation, n});
    }
    add(spv::OpDecorate, {push, spv::DecorationBlock});
    add(spv::OpMemberDecorate, {push, 0, spv::DecorationOffset, 0});
    if (rows_ == 0) return;
    add(spv::OpDecorate, {list, spv::DecorationArrayStride, kUnit});
    add(spv::OpDecorate, {block, spv::DecorationBlock});
    add(spv::OpMemberDecorate, {block, 0, spv::DecorationOffset, 0});
    add(spv::OpDecorate, {block_variable, spv::DecorationDescriptorSet, 0});
    add(spv::OpDecorate, {block_variable, spv::DecorationBinding, 0});
  }

  void declare() {
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
    for (std::uint32_t n = 0; n < first_mask_ - first_constant_; ++n) add(spv::OpConstant, {bits, constant(n), n});
    for (std::uint32_t n = 0; n < spare(); ++n) add(spv::OpConstant, {bits, first_mask_ + n, (n + 1) << 2});
    add(spv::OpTypeStruct, {push, bits4});
    add(spv::OpTypePointer, {from_push, spv::StorageClassPushConstant, push});
    add(spv::OpTypePointer, {push_number, spv::StorageClassPushConstant, bits});
    add(spv::OpVariable, {from_push, push_variable, spv::StorageClassPushConstant});
    if (rows_ > 0) {
      add(spv::OpConstant, {bits, count, rows_});
      add(spv::OpTypeArray, {list, bits4, count});
      add(spv::OpTypeStruct, {block, list});
      add(spv::OpTypePointer, {from_block, spv::StorageClassUniform, block});
      add(spv::OpTypePointer, {block_number, spv::StorageClassUniform, bits});
      add(spv::OpVariable, {from_block, block_variable, spv::StorageClassUniform});
    }
    add(spv::OpTypePointer, {in_index, spv::StorageClassInput, whole});
    add(spv::OpTypePointer, {out_place, spv::StorageClassOutput, real4});
    add(spv::OpTypePointer, {out_bits, spv::StorageClassOutput, bits4});
    add(spv::OpVariable, {in_index, index, spv::StorageClassInput});
    add(spv::OpVariable, {out_place, place, spv::StorageClassOutput});
    for (std::uint32_t n = 0; n < locations_; ++n) add(spv::OpVariable, {out_bits, output(n), spv::StorageClassOutput});
  }

  void body() {
    add(spv::OpFunction, {nothing, main, spv::FunctionControlMaskNone, function});
    add(spv::OpLabel, {label});
    add(spv::OpLoad, {whole, at, index});
    add(spv::OpIEqual, {yes, is_two, at, two});
    add(spv::OpSelect, {real, x, is_two, three, minus});
    add(spv::OpIEqual, {yes, is_one, at, one});
    add(spv::OpSelect, {real, y, is_one, three, minus});
    add(spv::OpCompositeConstruct, {real4, corner, x, y, nought, unity});
    add(spv::OpStore, {place, corner});
    add(spv::OpBitcast, {bits, at_bits, at});
    add(spv::OpShiftRightLogical, {bits, top, at_bits, sign});
    for (std::uint32_t n = 0; n < locations_; ++n) {
      Words four{bits4, 0};
      for (std::uint32_t c = 0; c < 4; ++c) four.push_back(handed(4 * n + c));
      four[1] = take(1);
      add(spv::OpCompositeConstruct, four);
      add(spv::OpStore, {output(n), four[1]});
    }
    add(spv::OpReturn, {});
    add(spv::OpFunctionEnd, {});
  }

  /// Each takes bits of the vertex's index that are 0. A driver that sees what a vertex shader hands on to be the
  /// block's would read the block in its place; and one that sees twice the same, or a constant, would hand on less.
  std::uint32_t handed(std::uint32_t n) {
    const std::uint32_t out = take(1);
    if (n >= numbers_.size()) {
      add(spv::OpBitwiseAnd, {bits, out, at_bits, first_mask_ + n - static_cast<std::uint32_t>(numbers_.size())});
      return out;
    }
    const std::uint32_t chain = take(1), read = take(1), component = constant(numbers_[n].offset % kUnit / 4);
    if (numbers_[n].in_block)
      add(spv::OpAccessChain,
          {block_number, chain, block_variable, zero, constant(numbers_[n].offset / kUnit), component});
    else
      add(spv::OpAccessChain, {push_number, chain, push_variable, zero, component});
    add(spv::OpLoad, {bits, read, chain});
    add(spv::OpBitwiseXor, {bits, out, read, top});
    return out;
  }

  /// Numbers for which there is room beside those that are handed on.
  std::uint32_t spare() const { return 4 * locations_ - static_cast<std::uint32_t>(numbers_.size()); }

  const std::vector<GivenNumber>& numbers_;
  const std::uint32_t locations_, rows_;
  std::uint32_t bound_ = first_free;
  const std::uint32_t first_output_, first_constant_, first_mask_ = take(spare());
  std::vector<Instruction> code_;
};

}  // namespace

std::vector<std::uint32_t> triangle_that_hands_on(const std::vector<GivenNumber>& numbers, std::uint32_t locations) {
  return Triangle(numbers, locations).make();
}

}  // namespace afterglow

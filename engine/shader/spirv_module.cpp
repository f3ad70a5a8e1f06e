// SPDX-License-Identifier: MIT
#include "shader/spirv_module.h"

#include <algorithm>
#include <memory>

namespace afterglow {
namespace {

spv_result_t on_header(void* data, spv_endianness_t, std::uint32_t magic, std::uint32_t version,
                       std::uint32_t generator, std::uint32_t bound, std::uint32_t schema) {
  static_cast<Module*>(data)->header = {magic, version, generator, bound, schema};
  return SPV_SUCCESS;
}

bool is_id(spv_operand_type_t type) {
  return type == SPV_OPERAND_TYPE_ID || type == SPV_OPERAND_TYPE_TYPE_ID || type == SPV_OPERAND_TYPE_RESULT_ID ||
         type == SPV_OPERAND_TYPE_MEMORY_SEMANTICS_ID || type == SPV_OPERAND_TYPE_SCOPE_ID;
}

spv_result_t on_instruction(void* data, const spv_parsed_instruction_t* parsed) {
  Instruction out;
  out.op = static_cast<spv::Op>(parsed->opcode);
  out.words.assign(parsed->words, parsed->words + parsed->num_words);
  out.type = parsed->type_id;
  out.result = parsed->result_id;
  for (std::uint16_t i = 0; i < parsed->num_operands; ++i)
    if (is_id(parsed->operands[i].type)) out.ids.push_back(parsed->operands[i].offset);
  static_cast<Module*>(data)->code.push_back(std::move(out));
  return SPV_SUCCESS;
}

}  // namespace

std::optional<Module> parse(const Words& spirv) {
  const std::unique_ptr<spv_context_t, void (*)(spv_context)> context(spvContextCreate(kSpirvEnvironment),
                                                                      spvContextDestroy);
  Module module;
  if (spvBinaryParse(context.get(), &module, spirv.data(), spirv.size(), on_header, on_instruction, nullptr) !=
      SPV_SUCCESS)
    return std::nullopt;
  return module;
}

Words Module::join() const {
  Words out = header;
  for (const auto& instruction : code) out.insert(out.end(), instruction.words.begin(), instruction.words.end());
  return out;
}

Instruction Instruction::of_words(spv::Op op, const Words& operands) {
  Instruction out;
  out.op = op;
  out.words = {static_cast<std::uint32_t>(operands.size() + 1) << spv::WordCountShift | static_cast<std::uint32_t>(op)};
  out.words.insert(out.words.end(), operands.begin(), operands.end());
  return out;
}

Instruction Instruction::of_ids(spv::Op op, std::uint32_t type, std::uint32_t result, const Words& operands) {
  Words words{type, result};
  words.insert(words.end(), operands.begin(), operands.end());
  Instruction out = of_words(op, words);
  out.type = type;
  out.result = result;
  for (std::size_t word = 1; word < out.words.size(); ++word) out.ids.push_back(static_cast<std::uint16_t>(word));
  return out;
}

Instruction renamed(Instruction instruction, const Renaming& names) {
  const auto rename = [&](std::uint32_t& id) {
    if (const auto name = names.find(id); name != names.end()) id = name->second;
  };
  for (const auto word : instruction.ids) rename(instruction.words[word]);
  rename(instruction.type);
  rename(instruction.result);
  return instruction;
}

void declare(Module& module, const std::vector<Instruction>& declarations) {
  const auto first = std::ranges::find(module.code, spv::OpFunction, &Instruction::op);
  module.code.insert(first, declarations.begin(), declarations.end());
}

std::uint32_t Zeros::of(std::uint32_t type) {
  auto& zero = zeros_[type];
  if (zero == 0) {
    zero = module_.fresh();
    declarations.push_back(Instruction::of_ids(spv::OpConstantNull, type, zero, {}));
  }
  return zero;
}

}  // namespace afterglow

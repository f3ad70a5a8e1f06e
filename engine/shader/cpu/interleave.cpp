// SPDX-License-Identifier: MIT
#include "shader/cpu/interleave.h"

#include <map>
#include <optional>
#include <set>
#include <utility>

#include "shader/spirv_passes.h"

namespace afterglow {
namespace {

/// Where a function stands among the instructions: [begin, end), OpFunction … OpFunctionEnd.
struct Range {
  std::size_t begin = 0, end = 0;
};

Range range_of(const Module& module, std::uint32_t function) {
  Range range;
  for (std::size_t i = 0; i < module.code.size(); ++i) {
    if (module.code[i].op == spv::OpFunction && module.code[i].result == function) range.begin = i;
    if (module.code[i].op == spv::OpFunctionEnd && range.begin > 0 && range.end == 0) range.end = i + 1;
  }
  return range;
}

std::uint32_t entry_point(const Module& module) {
  for (const auto& instruction : module.code)
    if (instruction.op == spv::OpEntryPoint) return instruction.words[2];
  return 0;
}

/// Everything that the row function calls becomes part of it, and branches that only choose a value become selections.
std::optional<Module> flatten(Module module, std::uint32_t function) {
  forbid_inlining(module, function);
  return without_variables(module);
}

/// The parts of a function of one block.
struct Body {
  std::vector<std::uint32_t> parameters;
  std::vector<Instruction> variables, steps;
  std::uint32_t value = 0;  ///< what it returns
};

std::optional<Body> body_of(const Module& module, Range range) {
  Body body;
  int blocks = 0;
  for (std::size_t i = range.begin + 1; i + 1 < range.end; ++i) {
    const Instruction& instruction = module.code[i];
    switch (instruction.op) {
      case spv::OpFunctionParameter:
        body.parameters.push_back(instruction.result);
        break;
      case spv::OpLabel:
        ++blocks;
        break;
      case spv::OpVariable:
        body.variables.push_back(instruction);
        break;
      case spv::OpReturnValue:
        body.value = instruction.words[1];
        break;
      case spv::OpLine:
      case spv::OpNoLine:
        break;
      default:
        body.steps.push_back(instruction);
    }
  }
  if (blocks != 1 || body.value == 0) return std::nullopt;
  return body;
}

/// Whether what the row function calls, as functions with several returns are, still loops.
bool loops(const Module& module, std::uint32_t main) {
  std::uint32_t function = 0;
  for (const auto& i : module.code) {
    if (i.op == spv::OpFunction) function = i.result;
    if (i.op == spv::OpLoopMerge && function != main) return true;
  }
  return false;
}

/// Rewrites main() around the calls.
class Interleaver {
 public:
  Interleaver(Module& module, std::uint32_t function, Body body, std::size_t together)
      : module_(module), function_(function), body_(std::move(body)), together_(together) {}

  void run(Range main) {
    std::vector<Instruction> rewritten;
    for (std::size_t i = main.begin; i < main.end; ++i) {
      const Instruction& instruction = module_.code[i];
      const bool call = instruction.op == spv::OpFunctionCall && instruction.words[3] == function_;
      if (call) {
        // glslang hands arguments over in variables, a fresh one for each call.
        calls_.push_back(instruction);
        results_.insert(instruction.result);
      } else if (waits(instruction)) {
        waiting_.push_back(instruction);
      } else {
        if (instruction.op == spv::OpReturn) emit(rewritten);
        rewritten.push_back(renamed(instruction, values_));
      }
      if (calls_.size() == together_) emit(rewritten);
    }
    // Variables belong to the beginning of the first block.
    std::size_t at = 0;
    while (rewritten[at].op != spv::OpLabel) ++at;
    rewritten.insert(rewritten.begin() + static_cast<std::ptrdiff_t>(at) + 1, variables_.begin(), variables_.end());
    const auto begin = module_.code.begin() + static_cast<std::ptrdiff_t>(main.begin);
    module_.code.erase(begin, module_.code.begin() + static_cast<std::ptrdiff_t>(main.end));
    module_.code.insert(module_.code.begin() + static_cast<std::ptrdiff_t>(main.begin), rewritten.begin(),
                        rewritten.end());
    copy_decorations();
  }

 private:
  /// Whether an instruction uses the result of a call that is still to come.
  bool waits(const Instruction& instruction) const {
    if (instruction.op == spv::OpReturn) return false;
    for (const auto word : instruction.ids)
      if (results_.contains(instruction.words[word])) return true;
    return false;
  }

  Renaming copies_for(const Instruction& call) {
    Renaming names;
    for (std::size_t p = 0; p < body_.parameters.size(); ++p) names[body_.parameters[p]] = call.words[4 + p];
    for (const auto* list : {&body_.variables, &body_.steps})
      for (const auto& instruction : *list)
        if (instruction.result != 0) copies_[instruction.result].push_back(names[instruction.result] = module_.fresh());
    return names;
  }

  void emit(std::vector<Instruction>& out) {
    std::vector<Renaming> names;
    for (const auto& call : calls_) names.push_back(copies_for(call));
    for (const auto& row : names)
      for (const auto& variable : body_.variables) variables_.push_back(renamed(variable, row));
    for (const auto& step : body_.steps)
      for (const auto& row : names) out.push_back(renamed(step, row));
    for (std::size_t i = 0; i < calls_.size(); ++i) {
      const auto value = names[i].find(body_.value);
      values_[calls_[i].result] = value == names[i].end() ? body_.value : value->second;
    }
    for (const auto& instruction : waiting_) out.push_back(renamed(instruction, values_));
    calls_.clear();
    waiting_.clear();
    results_.clear();
  }

  /// `precise` and the like hold for every copy.
  void copy_decorations() {
    std::vector<Instruction> code;
    for (const auto& instruction : module_.code) {
      code.push_back(instruction);
      if (instruction.op != spv::OpDecorate) continue;
      const auto copies = copies_.find(instruction.words[1]);
      if (copies == copies_.end()) continue;
      for (const auto copy : copies->second) {
        code.push_back(instruction);
        code.back().words[1] = copy;
      }
    }
    module_.code = std::move(code);
  }

  Module& module_;
  std::uint32_t function_;
  Body body_;
  std::size_t together_;
  std::vector<Instruction> calls_, waiting_, variables_;
  std::set<std::uint32_t> results_;  ///< of calls_
  Renaming values_;                  ///< results of calls that are done → what holds them now
  std::map<std::uint32_t, std::vector<std::uint32_t>> copies_;
};

}  // namespace

std::optional<Words> interleave_rows(const std::vector<std::uint32_t>& spirv, int together) {
  auto module = parse(spirv);
  if (!module) return std::nullopt;
  const std::uint32_t function = function_named(*module, kRowFunction), main = entry_point(*module);
  if (function == 0 || main == 0) return std::nullopt;
  module = flatten(std::move(*module), function);
  if (!module) return std::nullopt;
  declare_bool_vectors(*module);
  Range range = range_of(*module, function);
  range.end = select_instead_of_branching(*module, range.begin, range.end);
  auto body = body_of(*module, range);
  if (!body || loops(*module, main)) return std::nullopt;
  Interleaver(*module, function, std::move(*body), static_cast<std::size_t>(together)).run(range_of(*module, main));
  // The row function itself is of no use any more, nor is what was only written for it.
  spvtools::Optimizer optimizer(kSpirvEnvironment);
  optimizer.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t&, const char*) {});
  optimizer.RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
  const Words before = module->join();
  Words after;
  if (!optimizer.Run(before.data(), before.size(), &after)) return std::nullopt;
  return after;
}

}  // namespace afterglow

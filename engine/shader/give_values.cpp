// SPDX-License-Identifier: MIT
#include "shader/give_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "shader/cpu/interleave.h"
#include "shader/spirv_passes.h"
#include "shader/unset_uses.h"

namespace afterglow {
namespace {

constexpr const char* kMark = "ag_unset";

std::string_view name_of(const Instruction& op_name) { return reinterpret_cast<const char*>(&op_name.words[2]); }

/// What the functions below have to know about a module.
struct Ids {
  std::uint32_t mark = 0;  ///< the variable kMark
  std::map<std::string, std::uint32_t, std::less<>> by_name;
  std::map<std::uint32_t, std::uint32_t> numbers;   ///< id of a whole number's constant → its value
  std::map<std::uint32_t, std::uint32_t> pointees;  ///< pointer type → what it points to

  explicit Ids(const Module& module) {
    for (const auto& i : module.code) {
      if (i.op == spv::OpName) by_name.emplace(name_of(i), i.words[1]);
      if (i.op == spv::OpConstant && i.words.size() == 4) numbers[i.result] = i.words[3];
      if (i.op == spv::OpTypePointer) pointees[i.words[1]] = i.words[3];
    }
    if (const auto found = by_name.find(kMark); found != by_name.end()) mark = found->second;
  }
};

/// A mark: OpStore of its number, OpLoad of the variable, OpStore of the same.
struct Mark {
  std::uint32_t number = 0, type = 0, variable = 0;
};
std::optional<Mark> mark_at(const Module& module, std::size_t at, const Ids& ids) {
  const auto& code = module.code;
  if (ids.mark == 0 || at + 2 >= code.size() || code[at].op != spv::OpStore || code[at].words[1] != ids.mark)
    return std::nullopt;
  const Instruction &load = code[at + 1], &store = code[at + 2];
  if (load.op != spv::OpLoad || store.op != spv::OpStore || store.words[1] != load.words[3] ||
      store.words[2] != load.result)
    return std::nullopt;
  const auto number = ids.numbers.find(code[at].words[2]);
  if (number == ids.numbers.end()) return std::nullopt;
  return Mark{number->second, load.type, load.words[3]};
}

Instruction store(std::uint32_t variable, std::uint32_t value) {
  Instruction out = Instruction::of_words(spv::OpStore, {variable, value});
  out.ids = {1, 2};
  return out;
}

/// Variables that something is stored in, whole, before anything else is done with them, in the first block of their
/// function.
std::set<std::uint32_t> stored_at_once(const Module& module) {
  std::set<std::uint32_t> touched, stored;
  int block = 0;
  for (const auto& i : module.code) {
    if (i.op == spv::OpFunction) block = 0;
    if (i.op == spv::OpLabel) ++block;
    if (block == 0 || i.op == spv::OpVariable) continue;
    if (i.op == spv::OpStore && block == 1 && !touched.contains(i.words[1]) && i.words[2] != i.words[1])
      stored.insert(i.words[1]);
    for (const auto word : i.ids) touched.insert(i.words[word]);
  }
  return stored;
}

/// The module with zeros in place of the marks.
Words with_zeros(Module module, const Ids& ids) {
  Zeros zeros(module);
  std::vector<Instruction> code;
  for (std::size_t i = 0; i < module.code.size(); ++i) {
    const auto mark = mark_at(module, i, ids);
    if (!mark) {
      code.push_back(module.code[i]);
      continue;
    }
    code.push_back(store(mark->variable, zeros.of(mark->type)));
    i += 2;
  }
  module.code = std::move(code);
  const std::set<std::uint32_t> stored = stored_at_once(module);
  std::vector<Instruction> late;  // variables of file scope, behind the zeros that they begin with
  for (std::size_t i = 0; i < module.code.size(); ++i) {
    Instruction& variable = module.code[i];
    if (variable.op != spv::OpVariable || variable.words.size() > 4) continue;
    const bool file_scope = variable.words[3] == spv::StorageClassPrivate;
    const bool unset = variable.words[3] == spv::StorageClassFunction && !stored.contains(variable.result);
    if (!file_scope && !unset) continue;
    const std::uint32_t zero = zeros.of(ids.pointees.at(variable.type));
    Instruction given =
        Instruction::of_words(spv::OpVariable, {variable.type, variable.result, variable.words[3], zero});
    given.type = variable.type;
    given.result = variable.result;
    given.ids = {1, 2, 4};
    variable = std::move(given);
    if (!file_scope) continue;
    late.push_back(variable);
    module.code.erase(module.code.begin() + static_cast<std::ptrdiff_t>(i--));
  }
  zeros.declarations.insert(zeros.declarations.end(), late.begin(), late.end());
  declare(module, zeros.declarations);
  return module.join();
}

/// Whether elements are stored, and some read or stored by an index that is no constant: which of them, nobody knows.
bool is_filled_by_index(const Module& module, std::uint32_t variable, const std::set<std::uint32_t>& constants) {
  std::set<std::uint32_t> chains;
  bool any_index = false, stored = false;
  for (const auto& i : module.code) {
    if (i.op == spv::OpAccessChain && i.words[3] == variable) {
      chains.insert(i.result);
      any_index |=
          std::any_of(i.words.begin() + 4, i.words.end(), [&](std::uint32_t id) { return !constants.contains(id); });
    }
    stored |= i.op == spv::OpStore && chains.contains(i.words[1]);
  }
  return any_index && stored;
}

/// The module with the value of an input of its own in place of each mark. `sources`: input → number of the mark.
Module with_inputs(Module module, const Ids& ids, const std::vector<AssembledKernel::UnsetVariable>& unset,
                   std::map<std::uint32_t, std::uint32_t>& sources) {
  std::set<std::uint32_t> constants;
  for (const auto& i : module.code)
    if (i.op == spv::OpConstant) constants.insert(i.result);
  std::vector<Instruction> declarations;
  const auto source = [&](std::uint32_t type, std::uint32_t number) {
    const std::uint32_t pointer = module.fresh(), variable = module.fresh();
    declarations.push_back(Instruction::of_words(spv::OpTypePointer, {pointer, spv::StorageClassInput, type}));
    declarations.push_back(Instruction::of_words(spv::OpVariable, {pointer, variable, spv::StorageClassInput}));
    sources[variable] = number;
    return variable;
  };
  std::vector<Instruction> code, first;  // `first`: what main begins with
  const auto give = [&](std::vector<Instruction>& to, const Mark& mark) {
    const std::uint32_t value = module.fresh();
    to.push_back(Instruction::of_ids(spv::OpLoad, mark.type, value, {source(mark.type, mark.number)}));
    to.push_back(store(mark.variable, value));
  };
  std::map<std::uint32_t, std::uint32_t> globals;  // variable of file scope → number
  for (std::size_t n = 0; n < unset.size(); ++n)
    if (const auto found = ids.by_name.find(unset[n].variable);
        !unset[n].variable.empty() && found != ids.by_name.end())
      globals[found->second] = static_cast<std::uint32_t>(n);
  std::uint32_t main = 0, function = 0;
  bool begins = false;
  for (const auto& i : module.code) {
    if (i.op == spv::OpEntryPoint) main = i.words[2];
    const auto global = i.op == spv::OpVariable ? globals.find(i.result) : globals.end();
    if (global != globals.end() && !is_filled_by_index(module, i.result, constants))
      give(first, {global->second, ids.pointees.at(i.type), i.result});
  }
  for (std::size_t i = 0; i < module.code.size(); ++i) {
    const Instruction& at = module.code[i];
    if (at.op == spv::OpFunction) function = at.result;
    if (begins && at.op != spv::OpVariable) {
      code.insert(code.end(), first.begin(), first.end());
      begins = false;
    }
    if (at.op == spv::OpLabel && function == main) begins = !first.empty(), main = 0;
    // modf gives its second argument a value; what value does not matter here.
    constexpr std::uint32_t kModf = 35;  // of GLSL.std.450
    if (at.op == spv::OpExtInst && at.words.size() == 7 && at.words[4] == kModf) {
      code.push_back(store(at.words[6], at.words[5]));
      code.push_back(Instruction::of_ids(spv::OpCopyObject, at.type, at.result, {at.words[5]}));
      continue;
    }
    const auto mark = mark_at(module, i, ids);
    if (!mark) {
      code.push_back(at);
      continue;
    }
    if (!is_filled_by_index(module, mark->variable, constants)) give(code, *mark);
    i += 2;
  }
  module.code = std::move(code);
  declare(module, declarations);

  return module;
}

}  // namespace

std::string give_value_header() { return fmt::format("int {};\n", kMark); }

std::string give_value_text(std::size_t number, const std::string& variable) {
  return fmt::format(" {} = {}; {} = {};", kMark, number, variable, variable);
}

std::string give_result_text(std::size_t number, const std::string& type) {
  return fmt::format(" {} ag_result;{} return ag_result; ", type, give_value_text(number, "ag_result"));
}

std::vector<std::uint32_t> read_before_written(const Words& spirv,
                                               const std::vector<AssembledKernel::UnsetVariable>& unset) {
  if (unset.empty()) return {};
  auto parsed = parse(spirv);
  if (!parsed) return {};
  const Ids ids(*parsed);
  std::map<std::uint32_t, std::uint32_t> sources;
  Module module = with_inputs(std::move(*parsed), ids, unset, sources);
  // Each row does the same, so one is looked at. What variables of file scope hold is only seen in one function.
  const bool any_global = std::ranges::any_of(unset, [](const auto& one) { return !one.variable.empty(); });
  if (!any_global || !inlines_quickly(module)) forbid_inlining(module, function_named(module, kRowFunction));
  return unset_uses(module, sources);
}

Words give_values(Words spirv) {
  auto module = parse(spirv);
  if (!module) return spirv;
  const Ids ids(*module);
  return with_zeros(std::move(*module), ids);
}

std::string unset_warning(const AssembledKernel::UnsetVariable& unset) {
  const char* const what = unset.role == AssembledKernel::UnsetVariable::Role::argument
                               ? "may leave its function without a value; it is 0 then"
                           : unset.role == AssembledKernel::UnsetVariable::Role::result
                               ? "may end without a return; it gives 0 then"
                               : "may be read before it has a value; it is 0 there";
  return fmt::format("{}:{}: '{}' {}", unset.file, unset.line, unset.name, what);
}

}  // namespace afterglow

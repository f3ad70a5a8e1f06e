// SPDX-License-Identifier: MIT
// SPIR-V as a list of instructions that can be taken apart and put together again. Internal to the room.
#pragma once

#include <spirv-tools/libspirv.h>

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

// Behind the other one: it includes the C header in its own way.
#include <glslang/SPIRV/spirv.hpp>

namespace afterglow {

inline constexpr spv_target_env kSpirvEnvironment = SPV_ENV_VULKAN_1_1;

using Words = std::vector<std::uint32_t>;

struct Instruction {
  spv::Op op = spv::OpNop;
  Words words;                     ///< the first one holds length and opcode
  std::vector<std::uint16_t> ids;  ///< which words name ids, the result's included
  std::uint32_t type = 0, result = 0;

  /// A new instruction with these words behind the first; names no ids.
  static Instruction of_words(spv::Op op, const Words& operands);
  /// A new instruction all of whose operands are ids.
  static Instruction of_ids(spv::Op op, std::uint32_t type, std::uint32_t result, const Words& operands);
};

struct Module {
  Words header;
  std::vector<Instruction> code;

  /// A new id.
  std::uint32_t fresh() { return header[3]++; }
  Words join() const;
};

/// Nothing when it is not SPIR-V.
std::optional<Module> parse(const Words& spirv);

/// Puts instructions before the first function: all types and constants are known there.
void declare(Module& module, const std::vector<Instruction>& declarations);

/// Zeros of each type, declared once.
class Zeros {
 public:
  explicit Zeros(Module& module) : module_(module) {}
  std::uint32_t of(std::uint32_t type);
  std::vector<Instruction> declarations;  ///< for `declare`

 private:
  Module& module_;
  std::map<std::uint32_t, std::uint32_t> zeros_;
};

/// Id → the id that stands for it.
using Renaming = std::map<std::uint32_t, std::uint32_t>;
Instruction renamed(Instruction instruction, const Renaming& names);

/// Declares the vectors of bool that selections of vectors need before SPIR-V 1.4. Before the next function is called.
void declare_bool_vectors(Module& module);

/// Makes selections out of branches that only choose values, in the function [begin, end) of the module; returns its
/// new end. Both sides are then always computed; a side that reads images, writes, calls or loops stays a branch.
std::size_t select_instead_of_branching(Module& module, std::size_t begin, std::size_t end);

}  // namespace afterglow

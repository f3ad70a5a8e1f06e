// SPDX-License-Identifier: MIT
// What the functions of a module come to. Internal to the room.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "shader/spirv_module.h"

namespace afterglow {

/// What each comes to with all that it calls, and how often it is called. Memory counts for nothing.
class FunctionWeights {
 public:
  explicit FunctionWeights(const Module& module);

  std::uint64_t weight(const Instruction& i);
  /// A call of what turns loops.
  bool turns(const Instruction& i) { return i.op == spv::OpFunctionCall && functions_[i.words[3]].loops; }
  std::uint64_t times(std::uint32_t function) { return functions_[function].times; }

 private:
  struct Function {
    std::uint64_t own = 0, whole = 0, times = 0;
    std::vector<std::uint32_t> calls;
    bool loops = false;  ///< its own, or those of what it calls
    bool weighed = false, counted = false;
  };

  std::uint64_t weight(std::uint32_t id);
  void count_calls();
  void visit(std::uint32_t id, std::vector<std::uint32_t>& callees_first);

  std::map<std::uint32_t, Function> functions_;
  std::vector<std::uint32_t> order_;
};

}  // namespace afterglow

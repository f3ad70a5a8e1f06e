// SPDX-License-Identifier: MIT
// Variables that authors declare without a value get zeros, so that no pixel depends on what lay in memory. In the text
// each is marked where it is declared; in the SPIR-V made of it the marks become stores of zeros. Internal to the room.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "shader/kernel.h"

namespace afterglow {

/// To stand before all marks, at file scope.
std::string give_value_header();
/// The mark that gives `variable` a value; `number` is its index in AssembledKernel::unset.
std::string give_value_text(std::size_t number, const std::string& variable);

/// The same for what a function returns that ends without a `return`, before its last brace.
std::string give_result_text(std::size_t number, const std::string& type);

/// The numbers of marks of which a part may be read before it is written, in order.
std::vector<std::uint32_t> read_before_written(const std::vector<std::uint32_t>& spirv,
                                               const std::vector<AssembledKernel::UnsetVariable>& unset);

/// Marks become zeros; variables without a mark (in heads of loops, from macros) begin as zeros. What is no SPIR-V
/// comes back as it is.
std::vector<std::uint32_t> give_values(std::vector<std::uint32_t> spirv);

/// "look/shaders/glow.glsl:7: 'u' may be read before it has a value; it is 0 there".
std::string unset_warning(const AssembledKernel::UnsetVariable& unset);

}  // namespace afterglow

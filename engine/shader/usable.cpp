// SPDX-License-Identifier: MIT
#include "shader/usable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "shader/divergence.h"
#include "shader/lined_module.h"
#include "shader/rename.h"
#include "shader/token.h"

namespace afterglow {
namespace {

constexpr std::array kSwitchedOn{spv::CapabilityMatrix,
                                 spv::CapabilityShader,
                                 spv::CapabilityImageQuery,
                                 spv::CapabilityDerivativeControl,
                                 spv::CapabilityStorageImageExtendedFormats,
                                 spv::CapabilityStorageImageReadWithoutFormat,
                                 spv::CapabilityStorageImageWriteWithoutFormat};

/// The first ability that is not switched on.
std::optional<spv::Capability> missing_ability(const Module& module) {
  for (const auto& i : module.code) {
    if (i.op != spv::OpCapability) continue;
    const auto ability = static_cast<spv::Capability>(i.words[1]);
    if (std::ranges::find(kSwitchedOn, ability) == kSwitchedOn.end()) return ability;
  }
  return std::nullopt;
}

std::string name_of(spv::Capability ability) {
  switch (ability) {
    case spv::CapabilityImageGatherExtended:
      return "an offset of textureGatherOffset that is no constant, or textureGatherOffsets,";
    case spv::CapabilityFloat64:
    case spv::CapabilityInt64:
      return "a number of 64 bits";
    case spv::CapabilityFloat16:
    case spv::CapabilityInt16:
    case spv::CapabilityInt8:
      return "a number of less than 32 bits";
    default:
      return fmt::format("something of GLSL (ability {} of SPIR-V)", static_cast<unsigned>(ability));
  }
}

bool gathers_with_offsets(const Instruction& i) {
  constexpr std::size_t kOperands = 6;  // the word behind image, position and component
  if (i.op != spv::OpImageGather || i.words.size() <= kOperands) return false;
  return (i.words[kOperands] & (spv::ImageOperandsOffsetMask | spv::ImageOperandsConstOffsetsMask)) != 0;
}

/// "workgroup_sum" of the function with this id; empty: it has no name.
std::string function_name(const Module& module, std::uint32_t id) {
  for (const auto& i : module.code) {
    if (i.op != spv::OpName || i.words[1] != id) continue;
    const std::string name = original_names(reinterpret_cast<const char*>(&i.words[2]));
    return name.substr(0, name.find('('));
  }
  return {};
}

/// Functions of the prelude that stand for texture and its kin where the position is of whole numbers.
std::set<std::uint32_t> whole_textures(const Module& module) {
  std::set<std::uint32_t> out;
  for (const auto& i : module.code) {
    if (i.op != spv::OpName) continue;
    const std::string_view name = reinterpret_cast<const char*>(&i.words[2]);
    if (name.starts_with("ag_texture") && name.find("(s21;vi2;") != name.npos) out.insert(i.words[1]);
  }
  return out;
}

/// The index of the first call of one of them.
std::optional<std::size_t> texture_of_whole_numbers(const Module& module) {
  const auto functions = whole_textures(module);
  const auto found = std::ranges::find_if(
      module.code, [&](const Instruction& i) { return i.op == spv::OpFunctionCall && functions.contains(i.words[3]); });
  if (found == module.code.end()) return std::nullopt;
  return static_cast<std::size_t>(found - module.code.begin());
}

Error error_at(const LinedModule& lined, std::optional<std::size_t> index, const AssembledKernel& assembled,
               std::string message) {
  const SourcePlace place = index ? lined.places[*index] : SourcePlace{};
  const bool known = index && place.file < assembled.file_names.size();
  return shader_error(known ? assembled.file_names[place.file] : "", known ? static_cast<int>(place.line) : 0,
                      std::move(message));
}

}  // namespace

Result<void> check_usable(const std::vector<std::uint32_t>& spirv, const AssembledKernel& assembled, GlslStage stage) {
  const auto module = parse(spirv);
  if (!module) return Error{ErrorKind::other, "the compiled shader is no SPIR-V"};
  const auto ability = missing_ability(*module);
  const bool whole = texture_of_whole_numbers(*module).has_value();
  if (!ability && !whole && !divergent_barrier(*module)) return {};

  AFTERGLOW_TRY(const LinedModule lined, compile_with_lines(assembled.glsl, stage));
  const auto& code = lined.module.code;
  if (ability) {
    const auto found = std::ranges::find_if(code, gathers_with_offsets);
    const bool placed = *ability == spv::CapabilityImageGatherExtended && found != code.end();
    return error_at(lined, placed ? std::optional(static_cast<std::size_t>(found - code.begin())) : std::nullopt,
                    assembled, fmt::format("{} is not allowed: not all devices have it", name_of(*ability)));
  }
  if (whole) {
    Error error = error_at(lined, texture_of_whole_numbers(lined.module), assembled,
                           "texture takes a position from 0 to 1, not whole numbers");
    error.allowed = "fetch(image, pixel) for a pixel, a vec2 for a position";
    return error;
  }
  const auto barrier = divergent_barrier(lined.module);
  const bool call = barrier && code[*barrier].op == spv::OpFunctionCall;
  const std::string what = call ? fmt::format("'{}' waits for all invocations of the workgroup",
                                              function_name(lined.module, code[*barrier].words[3]))
                                : "barrier() waits for all invocations of the workgroup";
  Error error = error_at(lined, barrier, assembled, what + ", but some do not come here");
  error.allowed =
      "outside of every `if` and loop whose condition differs between invocations, and before every return in one";
  return error;
}

}  // namespace afterglow

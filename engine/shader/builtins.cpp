// SPDX-License-Identifier: MIT
#include "shader/builtins.h"

#include <algorithm>

#include "core/text.h"

namespace afterglow {
namespace {

constexpr std::string_view kBuiltin =
    "radians degrees sin cos tan asin acos atan sinh cosh tanh asinh acosh atanh pow exp log exp2 log2 "
    "sqrt inversesqrt abs sign floor trunc round roundEven ceil fract mod modf min max clamp mix step "
    "smoothstep isnan isinf floatBitsToInt floatBitsToUint intBitsToFloat uintBitsToFloat fma frexp ldexp "
    "packUnorm2x16 packSnorm2x16 packUnorm4x8 packSnorm4x8 unpackUnorm2x16 unpackSnorm2x16 unpackUnorm4x8 "
    "unpackSnorm4x8 packHalf2x16 unpackHalf2x16 packDouble2x32 unpackDouble2x32 length distance dot cross "
    "normalize faceforward reflect refract matrixCompMult outerProduct transpose determinant inverse "
    "lessThan lessThanEqual greaterThan greaterThanEqual equal notEqual any all not uaddCarry usubBorrow "
    "umulExtended imulExtended bitfieldExtract bitfieldInsert bitfieldReverse bitCount findLSB findMSB "
    "textureSize textureQueryLod textureQueryLevels textureSamples texture textureProj textureLod "
    "textureOffset texelFetch texelFetchOffset textureProjOffset textureLodOffset textureProjLod "
    "textureProjLodOffset textureGrad textureGradOffset textureProjGrad textureProjGradOffset "
    "textureGather textureGatherOffset textureGatherOffsets dFdx dFdy dFdxFine dFdyFine dFdxCoarse "
    "dFdyCoarse fwidth fwidthFine fwidthCoarse interpolateAtCentroid interpolateAtSample "
    "interpolateAtOffset barrier memoryBarrier groupMemoryBarrier imageLoad imageStore imageSize "
    "subpassLoad anyInvocation allInvocations allInvocationsEqual noise1 noise2 noise3 noise4";
constexpr std::string_view kPrelude = "target_size image_size fetch fetch_linear sample_scaled";

bool has(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

}  // namespace

const std::vector<std::string>& builtin_functions() {
  static const std::vector<std::string> names = split(kBuiltin, ' ');
  return names;
}

const std::vector<std::string>& prelude_functions() {
  static const std::vector<std::string> names = split(kPrelude, ' ');
  return names;
}

bool is_builtin_function(std::string_view name) { return has(builtin_functions(), name); }
bool is_prelude_function(std::string_view name) { return has(prelude_functions(), name); }

}  // namespace afterglow

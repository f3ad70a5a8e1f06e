// SPDX-License-Identifier: MIT
#include "shader/foreign_words.h"

#include <algorithm>
#include <array>
#include <utility>

namespace afterglow {
namespace {

using Foreign = std::pair<std::string_view, std::string_view>;

constexpr std::array kForeign{
    Foreign{"float2", "vec2"},
    Foreign{"float3", "vec3"},
    Foreign{"float4", "vec4"},
    Foreign{"half", "float"},
    Foreign{"half2", "vec2"},
    Foreign{"half3", "vec3"},
    Foreign{"half4", "vec4"},
    Foreign{"fixed", "float"},
    Foreign{"fixed3", "vec3"},
    Foreign{"fixed4", "vec4"},
    Foreign{"int2", "ivec2"},
    Foreign{"int3", "ivec3"},
    Foreign{"int4", "ivec4"},
    Foreign{"uint2", "uvec2"},
    Foreign{"uint3", "uvec3"},
    Foreign{"uint4", "uvec4"},
    Foreign{"bool2", "bvec2"},
    Foreign{"bool3", "bvec3"},
    Foreign{"bool4", "bvec4"},
    Foreign{"float2x2", "mat2"},
    Foreign{"float3x3", "mat3"},
    Foreign{"float4x4", "mat4"},
    Foreign{"lerp", "mix(a, b, t)"},
    Foreign{"saturate", "clamp(x, 0.0, 1.0)"},
    Foreign{"frac", "fract"},
    Foreign{"fmod", "mod"},
    Foreign{"atan2", "atan(y, x)"},
    Foreign{"rsqrt", "inversesqrt"},
    Foreign{"mad", "fma"},
    Foreign{"mul", "m * v"},
    Foreign{"rcp", "1.0 / x"},
    Foreign{"log10", "log2(x) * 0.30103"},
    Foreign{"sincos", "sin and cos"},
    Foreign{"asfloat", "uintBitsToFloat"},
    Foreign{"asuint", "floatBitsToUint"},
    Foreign{"asint", "floatBitsToInt"},
    Foreign{"countbits", "bitCount"},
    Foreign{"tex2D", "texture(image, position from 0 to 1)"},
    Foreign{"texture2D", "texture(image, position from 0 to 1)"},
    Foreign{"Sample", "texture(image, position from 0 to 1)"},
    Foreign{"SampleLevel", "texture(image, position from 0 to 1)"},
    Foreign{"Texture2D", "uniform sampler2D"},
    Foreign{"static", "const"},
    Foreign{"groupshared", "shared"},
    Foreign{"constexpr", "const"},
    Foreign{"iResolution", "vec2(target_size())"},
    Foreign{"iTime", "a uniform float, to which the script gives g.time"},
    Foreign{"iFrame", "a uniform float, to which the script gives g.frame"},
    Foreign{"fragCoord", "vec2(pixel) + 0.5, whose y runs down"},
    Foreign{"iChannel0", "source, of a uniform sampler2D source"},
    Foreign{"PI", "3.14159265"},
    Foreign{"M_PI", "3.14159265"},
};

/// What workgroups are told, and how much a device takes.
constexpr std::array<std::string_view, 4> kOfWorkgroups{"gl_LocalInvocationID", "gl_LocalInvocationIndex",
                                                        "gl_WorkGroupID", "gl_WorkGroupSize"};

constexpr std::array<std::string_view, 9> kOfLevels{
    "textureProj",           "textureProjLod", "textureProjGrad",   "textureProjOffset", "textureProjLodOffset",
    "textureProjGradOffset", "textureGrad",    "textureGradOffset", "textureLodOffset"};

}  // namespace

std::string_view in_glsl(std::string_view word) {
  const auto found = std::ranges::find(kForeign, word, &Foreign::first);
  return found == kForeign.end() ? std::string_view() : found->second;
}

std::string_view why_not(std::string_view name) {
  if (name == "gl_FragCoord")
    return "one invocation may make several pixels; `ivec2 pixel` is the argument of apply, sample_at and compute_at "
           "that says where";
  if (name.starts_with("gl_Max") || name.starts_with("gl_Min") || std::ranges::count(kOfWorkgroups, name) > 0)
    return {};
  if (name.starts_with("gl_")) return "what is drawn, and how, is the engine's affair";
  if (name == "double" || name.starts_with("dvec") || name.starts_with("dmat"))
    return "numbers of 64 bits are not switched on, and many devices have none; write float, vec and mat";
  if (name.starts_with("dFd") || name == "ddx" || name == "ddy" || name.starts_with("fwidth") ||
      name == "textureQueryLod")
    return "pixels that lie beside each other need not be made beside each other; read both by `fetch` in a sample "
           "shader";
  if (std::ranges::count(kOfLevels, name) > 0)
    return "images have one level, and positions two numbers: write texture(image, position from 0 to 1)";
  return {};
}

}  // namespace afterglow

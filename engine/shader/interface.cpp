// SPDX-License-Identifier: MIT
#include "shader/interface.h"

#include <array>

namespace afterglow {
namespace {

constexpr std::array kKinds = {PassKind::pixel, PassKind::sample, PassKind::compute, PassKind::filter};

std::string listed(const char* PassKindInfo::*text) {
  std::string out;
  for (const PassKind kind : kKinds)
    if (const PassKindInfo& info = info_of(kind); info.entry)
      out += (out.empty() ? "" : ", ") + std::string(info.*text);
  return out;
}

}  // namespace

const PassKindInfo& info_of(PassKind kind) {
  static constexpr std::array<PassKindInfo, kKinds.size()> kInfos = {{
      {"pixel", "apply", "vec4 apply(vec4 color, vec4 NAME, …, ivec2 pixel)", false},
      {"sample", "sample_at", "vec4 sample_at(ivec2 pixel)", true},
      {"compute", "compute_at", "vec4 compute_at(ivec2 pixel)", true},
      {"filter", nullptr, nullptr, true},
  }};
  return kInfos[static_cast<std::size_t>(kind)];
}

std::optional<PassKind> kind_of_entry(std::string_view function) {
  for (const PassKind kind : kKinds)
    if (const char* entry = info_of(kind).entry; entry && function == entry) return kind;
  return std::nullopt;
}

std::string entry_names() { return listed(&PassKindInfo::entry); }
std::string entry_signatures() { return listed(&PassKindInfo::signature); }

namespace {

struct ParamTypeInfo {
  ParamType type;
  const char* glsl;
  int components;
  int side;
};
constexpr ParamTypeInfo kParamTypes[] = {
    {ParamType::float1, "float", 1, 0},  {ParamType::float2, "vec2", 2, 0},  {ParamType::float3, "vec3", 3, 0},
    {ParamType::float4, "vec4", 4, 0},   {ParamType::int1, "int", 1, 0},     {ParamType::int2, "ivec2", 2, 0},
    {ParamType::bool1, "bool", 1, 0},    {ParamType::matrix2, "mat2", 4, 2}, {ParamType::matrix3, "mat3", 9, 3},
    {ParamType::matrix4, "mat4", 16, 4},
};

/// In the order of the enumeration.
const ParamTypeInfo& info_of(ParamType type) { return kParamTypes[static_cast<std::size_t>(type)]; }

}  // namespace

int component_count(ParamType type) { return info_of(type).components; }
int matrix_side(ParamType type) { return info_of(type).side; }
int vector_length(ParamType type) { return component_count(type) / std::max(matrix_side(type), 1); }
const char* glsl_name(ParamType type) { return info_of(type).glsl; }

int block_bytes(ParamType type, int elements) {
  constexpr int kVector = 16;
  return kVector * std::max(matrix_side(type), 1) * std::max(elements, 1);
}

std::optional<ParamType> param_type_of(std::string_view glsl_name) {
  // mat3x3 is mat3; matrices that are not square are no parameters.
  const bool both_sides = glsl_name.size() == 6 && glsl_name.starts_with("mat") &&
                          glsl_name.substr(4) == "x" + std::string(1, glsl_name[3]);
  if (both_sides) glsl_name.remove_suffix(2);
  for (const auto& info : kParamTypes)
    if (glsl_name == info.glsl) return info.type;
  return std::nullopt;
}

const std::vector<std::string>& uniform_types() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const auto& info : kParamTypes) out.push_back(info.glsl);
    out.push_back("sampler2D");
    return out;
  }();
  return names;
}

const std::vector<std::string>& pass_keys() {
  static const std::vector<std::string> keys{"channels", "compute", "name", "precise", "reach", "shader", "size"};
  return keys;
}

}  // namespace afterglow

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

int component_count(ParamType type) {
  switch (type) {
    case ParamType::float1:
      return 1;
    case ParamType::float2:
      return 2;
    case ParamType::float3:
      return 3;
    case ParamType::float4:
      return 4;
    case ParamType::int1:
      return 1;
    case ParamType::int2:
      return 2;
    case ParamType::bool1:
      return 1;
  }
  return 0;
}

const char* glsl_name(ParamType type) {
  switch (type) {
    case ParamType::float1:
      return "float";
    case ParamType::float2:
      return "vec2";
    case ParamType::float3:
      return "vec3";
    case ParamType::float4:
      return "vec4";
    case ParamType::int1:
      return "int";
    case ParamType::int2:
      return "ivec2";
    case ParamType::bool1:
      return "bool";
  }
  return "";
}

const std::vector<std::string>& pass_keys() {
  static const std::vector<std::string> keys{"channels", "compute", "name", "precise", "reach", "shader", "size"};
  return keys;
}

}  // namespace afterglow

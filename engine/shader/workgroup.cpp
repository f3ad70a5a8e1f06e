// SPDX-License-Identifier: MIT
#include "shader/workgroup.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

#include "core/text.h"

namespace afterglow {
namespace {

/// The value of one `NAME = NUMBER`; 0 when it is none.
int number_of(const Token& token) {
  int value = 0;
  const char *begin = token.text.data(), *end = begin + token.text.size();
  const auto [stop, problem] = std::from_chars(begin, end, value);
  const bool suffix = stop + 1 == end && (*stop == 'u' || *stop == 'U');
  return problem == std::errc() && (stop == end || suffix) ? value : 0;
}

}  // namespace

Result<Workgroup> parse_workgroup(const Token& anchor, std::span<const Token* const> arguments,
                                  const std::string& file) {
  static const std::vector<std::string> kNames = {"local_size_x", "local_size_y", "pixels_x", "pixels_y"};
  std::array<int, 4> sizes{1, 1, 0, 0};
  for (std::size_t i = 0; i < arguments.size(); i += 4) {
    const Token& name = *arguments[i];
    const auto known = std::ranges::find(kNames, name.text);
    if (known == kNames.end()) {
      Error error = shader_error(file, name.line, fmt::format("the size of workgroups has no '{}'", name.text));
      error.allowed = join(kNames);
      error.nearest = nearest_name(std::string(name.text), kNames);
      return error;
    }
    const bool well_formed = i + 2 < arguments.size() && arguments[i + 1]->is("=") &&
                             (i + 3 == arguments.size() || arguments[i + 3]->is(","));
    const int value = well_formed ? number_of(*arguments[i + 2]) : 0;
    if (value < 1 || value > kMaxInvocations) {
      Error error = shader_error(file, name.line, fmt::format("'{}' is no size of workgroups", name.text));
      error.allowed = fmt::format("{} = 1…{}", name.text, kMaxInvocations);
      return error;
    }
    sizes[static_cast<std::size_t>(known - kNames.begin())] = value;
  }
  Workgroup out{{sizes[0], sizes[1]}, {sizes[2] ? sizes[2] : sizes[0], sizes[3] ? sizes[3] : sizes[1]}};
  if (out.invocations.area() > kMaxInvocations) {
    Error error =
        shader_error(file, anchor.line,
                     fmt::format("a workgroup of {}×{} invocations", out.invocations.width, out.invocations.height));
    error.allowed = fmt::format("at most {} in all", kMaxInvocations);
    return error;
  }
  if (out.pixels.width > out.invocations.width || out.pixels.height > out.invocations.height) {
    Error error = shader_error(file, anchor.line, "a workgroup makes more pixels than it has invocations");
    error.allowed = "pixels_x at most local_size_x, pixels_y at most local_size_y";
    return error;
  }
  return out;
}

Result<void> check_shared_type(const Token& type, const std::string& file) {
  static const std::vector<std::string> kTypes = {"float", "vec2",  "vec3", "vec4",  "int",   "ivec2",
                                                  "ivec3", "ivec4", "uint", "uvec2", "uvec3", "uvec4"};
  if (std::ranges::find(kTypes, type.text) != kTypes.end()) return {};
  Error error = shader_error(file, type.line, fmt::format("a shared variable cannot be of type '{}'", type.text));
  error.allowed = join(kTypes);
  error.nearest = nearest_name(std::string(type.text), kTypes);
  return error;
}

}  // namespace afterglow

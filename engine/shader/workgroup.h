// SPDX-License-Identifier: MIT
// What a compute shader declares of its workgroups. Internal to the room.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/result.h"
#include "shader/interface.h"
#include "shader/token.h"

namespace afterglow {

inline constexpr int kMaxInvocations = 1024;             ///< of a workgroup, on any desktop device
inline constexpr std::uint64_t kMaxSharedBytes = 32768;  ///< of a workgroup's variables, likewise

/// `arguments` are the tokens between the parentheses of `layout(local_size_x = N, …) in;`, which begins at `anchor`.
/// Errors (script): unknown names, sizes out of range.
Result<Workgroup> parse_workgroup(const Token& anchor, std::span<const Token* const> arguments,
                                  const std::string& file);

/// Errors (script): a type that workgroups cannot share.
Result<void> check_shared_type(const Token& type, const std::string& file);

}  // namespace afterglow

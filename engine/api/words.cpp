// SPDX-License-Identifier: MIT
#include "api/words.h"

#include <array>
#include <string_view>
#include <utility>

namespace afterglow::api {
namespace {

using Words = std::pair<std::string_view, std::string_view>;

/// What messages begin with.
constexpr std::array kBeginnings{Words{"--set ", ""}, Words{"--arg ", "argument "}};

/// Options that messages name for what they are about.
constexpr std::array kOptions{
    Words{"(--max-memory)", "(max_memory)"},
    Words{"(--max-error)", "(max_error)"},
    Words{"--reference", "reference"},
    Words{"; --precision", "; precision"},
    Words{"(--stats=passes)", "(time_kernels)"},
    Words{"(--at, position in the preset, worldToCamera in the file)", "(position of the frame or in the preset)"},
};

}  // namespace

std::string for_hosts(std::string message) {
  for (const auto& [theirs, ours] : kBeginnings)
    if (message.starts_with(theirs)) message.replace(0, theirs.size(), ours);
  for (const auto& [theirs, ours] : kOptions)
    if (const std::size_t at = message.find(theirs); at != std::string::npos) message.replace(at, theirs.size(), ours);
  return message;
}

Error for_hosts(Error error) {
  error.message = for_hosts(std::move(error.message));
  for (auto& line : error.trail) line = for_hosts(std::move(line));
  return error;
}

}  // namespace afterglow::api

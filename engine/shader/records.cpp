// SPDX-License-Identifier: MIT
#include "shader/records.h"

#include <algorithm>
#include <map>
#include <string_view>

#include "core/saturated.h"

namespace afterglow {
namespace {

using Tokens = std::span<const Token* const>;
using Counts = std::map<std::string_view, std::uint64_t>;  ///< by record

/// Of `TYPE NAME [..], NAME; …`, which stands between the braces of a record.
std::uint64_t members_of(Tokens body, const Counts& known) {
  std::uint64_t all = 0, of_type = 0, names = 1;
  for (std::size_t at = 0; at < body.size();) {
    const Token& token = *body[at];
    if (token.is(";")) {
      all = saturated_sum({all, saturated_product({std::max<std::uint64_t>(of_type, 1), names})});
      of_type = 0, names = 1;
    } else if (token.is(",")) {
      ++names;
    } else if (opens(token)) {
      at = after_closing(body, at);
      continue;
    } else if (const auto record = known.find(token.text); record != known.end() && of_type == 0) {
      of_type = record->second;
    }
    ++at;
  }
  return all;
}

}  // namespace

const Token* record_with_too_many_members(Tokens code) {
  Counts known;
  for (std::size_t at = 0; at + 2 < code.size(); ++at) {
    if (!code[at]->is("struct") || !code[at + 1]->is_identifier() || !code[at + 2]->is("{")) continue;
    const std::size_t end = after_closing(code, at + 2);
    const std::uint64_t members = members_of(code.subspan(at + 3, std::max(end, at + 4) - at - 4), known);
    if (members > kMostMembers) return code[at + 1];
    std::uint64_t& most = known[code[at + 1]->text];
    most = std::max(most, members);
  }
  return nullptr;
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "core/result.h"

#include <fmt/format.h>

#include "core/printable.h"

namespace afterglow {

std::string Error::text() const {
  std::string out;
  if (!file.empty()) out += line > 0 ? fmt::format("{}:{}: ", file, line) : fmt::format("{}: ", file);
  out += "error: " + message;
  if (!allowed.empty()) out += "; allowed: " + allowed;
  if (!nearest.empty()) out += fmt::format("; did you mean '{}'?", nearest);
  out = printable(std::move(out));
  for (const auto& detail : trail) out += "\n  " + printable(detail);
  return out;
}

}  // namespace afterglow

#include "core/result.h"

#include <fmt/format.h>

namespace afterglow {

std::string Error::text() const {
  std::string out;
  if (!file.empty()) out += line > 0 ? fmt::format("{}:{}: ", file, line) : fmt::format("{}: ", file);
  out += "error: " + message;
  if (!allowed.empty()) out += "; allowed: " + allowed;
  if (!nearest.empty()) out += fmt::format("; did you mean '{}'?", nearest);
  for (const auto& detail : trail) out += "\n  " + detail;
  return out;
}

}  // namespace afterglow

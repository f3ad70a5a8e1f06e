// SPDX-License-Identifier: MIT
// JSON as the program prints and writes it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace afterglow {

/// Indented, with a line feed at the end. Names of files and texts of scripts are any bytes: what is no UTF-8 becomes
/// U+FFFD.
template <class Json>
std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace afterglow

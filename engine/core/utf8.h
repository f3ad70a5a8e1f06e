// SPDX-License-Identifier: MIT
// Text for those who take UTF-8 alone. Names of files and what scripts say are any bytes.
#pragma once

#include <string>

namespace afterglow {

/// What is no UTF-8 becomes U+FFFD: one for as many bytes as could have begun a character, as Unicode recommends.
std::string utf8_text(std::string text);

}  // namespace afterglow

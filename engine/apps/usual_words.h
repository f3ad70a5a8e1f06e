// SPDX-License-Identifier: MIT
// What shells offer where a command takes other words, too.
#pragma once

#include <string>
#include <vector>

namespace afterglow {

/// Words that values of a kind usually are, by the name that help has for it: names of presets and effects along the
/// search path ("PRESET", "EFFECT"), of colour spaces ("SPACE"), codecs ("CODEC"), compressions ("COMPRESSION"). Of
/// other kinds none.
std::vector<std::string> usual_words(const std::string& kind);

/// "ENTRY.SETTING=" of all that the first preset among these words has; where there is none, of all effects.
std::vector<std::string> setting_words(const std::vector<std::string>& words);

}  // namespace afterglow

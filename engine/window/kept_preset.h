// SPDX-License-Identifier: MIT
// Presets that nobody writes over by a key.
#pragma once

#include <filesystem>
#include <string>

namespace afterglow {

/// What the preset is a part of and stays as it is: "the pack kit.zip", "the installation". Empty: it is the user's.
std::string keeper_of(const std::filesystem::path& preset);

/// Where a copy of the preset goes by itself: beside it, of a kept one into the current folder.
std::filesystem::path folder_for_copies(const std::filesystem::path& preset);

}  // namespace afterglow

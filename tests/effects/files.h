// SPDX-License-Identifier: MIT
// A folder for files that tests write; it goes when the process ends.
#pragma once

#include <filesystem>
#include <string>

namespace afterglow {

/// The same one for all tests of the process.
const std::filesystem::path& test_files();
/// Writes a file into it; its path.
std::filesystem::path write_test_file(const std::string& name, const std::string& text);

}  // namespace afterglow

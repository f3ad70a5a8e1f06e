// SPDX-License-Identifier: MIT
// A folder for files that tests write; it goes when the process ends.
#pragma once

#include <filesystem>
#include <string>

#include "reference/double_image.h"

namespace afterglow {

/// The same one for all tests of the process.
const std::filesystem::path& test_files();
/// Writes a file into it; its path.
std::filesystem::path write_test_file(const std::string& name, const std::string& text);
/// An EXR of full floats with alpha from 0 to 1 in a pattern, and light up to `light` times that; what it holds.
reference::DoubleImage write_test_picture(const std::string& name, Size size, double light = 1);

}  // namespace afterglow

// SPDX-License-Identifier: MIT
// Configurations of OpenColorIO as studios have them, written into the folder of test files: every kind of step that
// its version 2.1 knows, by view.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace afterglow {

/// studio.ocio with its tables. Its display is "Monitor", linear Rec.709 is "lin_rec709".
std::filesystem::path write_studio();
/// The views of "Monitor", in order.
const std::vector<std::string>& studio_views();

/// old.ocio, of version 1 as of 2013: one display "Old" with the views "Film", "Log", "Looked" and "Raw"; linear
/// Rec.709 is "lin_srgb".
std::filesystem::path write_old_studio();

}  // namespace afterglow

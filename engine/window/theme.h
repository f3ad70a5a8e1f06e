// SPDX-License-Identifier: MIT
// How the interface looks.
#pragma once

namespace afterglow {

/// Colours and sizes of the current ImGui context: neutral greys, which leave the eye's sense of colour alone, and one
/// accent.
void apply_theme(float scale);

}  // namespace afterglow

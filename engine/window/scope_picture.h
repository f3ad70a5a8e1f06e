// SPDX-License-Identifier: MIT
// A scope as pixels.
#pragma once

#include <imgui.h>

#include <vector>

#include "play/player.h"

namespace afterglow {

/// AtlasCells::kSide rows of as many pixels, from the top; dark where nothing is. `kind`: one of the four.
/// histogram: levels to the right, counts upwards, red, green and blue over each other. waveform: luminance, levels
/// upwards over the picture's width. parade: the same of red, green and blue, side by side. vectorscope: Cb to the
/// right, Cr upwards, each in its colour.
std::vector<ImU32> scope_picture(const Scopes& scopes, ScopeKind kind);

}  // namespace afterglow

// SPDX-License-Identifier: MIT
// The document of an effect, from its own declarations and the comment at the head of its script.
#pragma once

#include <string>

#include "script/preset.h"

namespace afterglow {

/// One sentence: what light the effect is made for, and what it makes.
std::string space_text(const EffectSchema& effect);
/// "Needs depth. Uses motion."; empty: it works on the picture alone.
std::string inputs_text(const EffectSchema& effect);
/// Markdown: heading, purpose, notes (the comment), where it runs, in what light, with which inputs, a table of
/// settings.
std::string effect_page(const EffectSchema& effect);

}  // namespace afterglow

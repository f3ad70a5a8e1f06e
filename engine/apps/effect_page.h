// The document of an effect, from its own declarations and the comment at the head of its script.
#pragma once

#include <string>

#include "script/preset.h"

namespace afterglow {

/// Markdown: heading, purpose, notes (the comment), where it runs, a table of settings.
std::string effect_page(const EffectSchema& effect);

}  // namespace afterglow

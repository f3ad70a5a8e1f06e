// SPDX-License-Identifier: MIT
// How much of an entry's result counts and where: opacity, blend modes and masks (math.md §20), as passes behind those
// of its effect. Pixel passes, so that they run in the entry's last kernel.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "script/entry_run.h"
#include "script/explanation.h"

namespace afterglow::script {

/// All throw ScriptError.

/// A mask of Runtime::masks, for the entry that it masks.
std::shared_ptr<MaskRun> make_mask_run(const Runtime& runtime, int mask, const StackEntry& owner);
/// EntryMask::text of a mask of Runtime::masks; empty for -1.
std::string mask_text(const Runtime& runtime, int mask);

/// Opacity, blend mode and the settings of masks for a frame, noted in the entry; how they came about, in `history`.
void settle_composition(lua_State* lua, EntryRun& run, const BuildContext& context, EntryHistory& history);
/// Lengths that a mask and those that it is made of read follow.
void scale_lengths(lua_State* lua, MaskRun& mask, double length_scale);
bool composition_moves(const EntryRun& run);

/// Why nothing of the entry's result would be seen; empty when something may be.
std::optional<Inactive> why_unseen(lua_State* lua, const EntryRun& run);

/// May other frames ask for other inputs of masks?
bool mask_inputs_move(const Runtime& runtime, const EntryRun& run);
/// Which auxiliary inputs of masks are meant: those without which they select nothing, also those that they can use, or
/// also those of masks that select nothing now, but whose settings move.
enum class MaskInputs { needed, used, used_later };
/// Puts those that the entry's masks ask for behind `names`.
void add_mask_inputs(lua_State* lua, const EntryRun& run, MaskInputs which, std::vector<std::string>& names);

/// `image`, which the entry made of `source`, put over it.
ImageRef composite(lua_State* lua, const EntryRun& run, GraphBuilder& graph, const ImageRef& source,
                   const ImageRef& image);
/// From one look to the other by `amount`.
ImageRef mixed(const EntryRun& run, GraphBuilder& graph, const ImageRef& first, const ImageRef& second, double amount);

}  // namespace afterglow::script

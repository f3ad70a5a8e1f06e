// SPDX-License-Identifier: MIT
// Settings that an effect declares and nothing reads.
#pragma once

#include <vector>

#include "script/build.h"
#include "script/entry_run.h"

namespace afterglow::script {

/// Makes the view of settings on top of the stack take down what is read of it (EntryRun::reads_ref).
void note_reads(lua_State* lua, EntryRun& run);

/// Of effects that ran in `graph`, each once: settings that were not read, and that neither the effect's script nor a
/// module names again, so that no other settings make a difference.
std::vector<UnreadSetting> unread_settings(lua_State* lua, const std::vector<EntryRun>& runs, const Graph& graph);

}  // namespace afterglow::script

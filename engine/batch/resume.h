// SPDX-License-Identifier: MIT
// --resume: which outputs need not be made again.
//
// Beside the outputs of a sequence stands a folder `.afterglow` with one small file an output, `NAME.made`, that holds
// the hash of everything the pixels depend on but the input: scripts, shaders, overrides and options. An output is
// skipped when that hash is the present one and the output is newer than all its inputs. One file an output, so that
// many machines can share a folder.
#pragma once

#include <string>
#include <vector>

#include "batch/frame_list.h"
#include "batch/run_report.h"
#include "core/hash.h"
#include "core/result.h"
#include "graph/graph.h"
#include "script/preset.h"

namespace afterglow {

/// Hash of the scripts, the shaders of `graph`, and `options` (a text with every option that changes pixels). When
/// other frames may have other passes, all shaders that can be found count. Errors: script, io.
Result<Hash> look_hash(const Preset& preset, const Graph& graph, const std::string& options);

/// True when the output exists, was made by the look with this hash, and is newer than its inputs.
bool is_up_to_date(const FrameJob& job, const Hash& look);
/// Removes what killed runs on this machine have left half-written in the folders of these outputs; returns how many
/// files.
int remove_leftovers(const FrameRecords& frames);
/// Notes that the output was made by this look. Errors: io.
Result<void> record_made(const FrameJob& job, const Hash& look);

}  // namespace afterglow

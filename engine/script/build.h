// SPDX-License-Identifier: MIT
// What a preset says about one frame: a value that nothing changes any more. `Preset::evaluate` makes one a frame, and
// whoever runs, plans or explains that frame looks at it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/file_record.h"
#include "graph/graph.h"
#include "script/dependencies.h"
#include "script/explanation.h"
#include "script/preset.h"

namespace afterglow {

/// What the effect of an entry promises of this frame's result (script/schema.h).
struct Promises {
  std::string entry;
  std::vector<Invariant> invariants;
};

struct UnreadSetting {
  std::string effect, setting;
};

struct Build {
  BuildContext context;     ///< of the frame
  double length_scale = 1;  ///< pixels for each pixel that settings in px are given in
  Graph graph;              ///< `graph.skipped`: effects and passes that were left out, with reasons
  /// In the order of execution, with the settings of this frame. Never null.
  std::shared_ptr<const std::vector<StackEntry>> entries;
  std::shared_ptr<const Explanation> explanation;  ///< how the settings came about. Never null
  std::vector<Promises> promises;      ///< parallel to `entries`, as far as `promise_error` let them be asked
  std::optional<Error> promise_error;  ///< the frame is none the worse for it
  Dependencies depends;                ///< of this frame's passes
  /// Of a preset's first frame, which is built twice: "effect 'e': build gives another graph the second time: …", which
  /// was warned about too. Empty: it does not, or this is another frame.
  std::string changing;
  /// Settings that nothing of an active effect reads, whatever the others are; with PresetOptions::note_reads.
  std::vector<UnreadSetting> unread;
  /// Everything that was looked at on disk for it so far, also in vain. Never null; the same value while nothing was
  /// added.
  std::shared_ptr<const FileProbes> files;
};

}  // namespace afterglow

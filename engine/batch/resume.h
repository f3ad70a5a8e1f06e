// SPDX-License-Identifier: MIT
// --resume: which outputs need not be made again.
//
// Beside the outputs of a sequence stands a folder `.afterglow` with one small file an output, `NAME.made`: what that
// output was made of, written when it was whole. It holds the hash of all that is the same for every frame (scripts,
// shaders, overrides and options), the hashes of the tables and pictures that this frame's passes read, the variables
// of the environment that they depend on, size and time of each input, and size and time of the output itself. An
// output is skipped when all of that is as it was: one that was made otherwise since, by a run without a note or by
// hand, is not the one that the note is about. One file an output, so that many machines can share a folder.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "batch/frame_list.h"
#include "batch/inventory.h"
#include "batch/run_report.h"
#include "batch/sequence_stamps.h"
#include "core/hash.h"
#include "core/result.h"
#include "script/preset.h"

namespace afterglow {

/// Hash of the scripts, the shaders, and `options` (a text with every option that changes pixels but the execution).
/// Errors: io.
Result<Hash> look_hash(const Preset& preset, const Inventory& inventory, const std::string& options);

/// Writes and reads what frames of a preset, which must outlive it, are made of. Not thread-safe, but for
/// `record_made`.
class FrameNotes {
 public:
  FrameNotes(const Hash& look, const Preset& preset)
      : sources_(look), path_(preset.path()), names_(path_), hashes_(preset) {}

  /// How the device executes, by name: a part of what all frames are made of. To be told before the rest is asked, but
  /// for `inputs_of`.
  void made_by(const std::string& execution) { look_ = Hasher().add(sources_.hex()).add(execution).finish(); }

  /// Size and time of every file that the output is made from. To be asked before the frame is read, and of the frames
  /// of a sequence by number: each looks at its own files, and those of earlier frames are as those frames found them.
  /// Zero: one is not there.
  Hash inputs_of(const FrameJob& job);
  /// What is to be noted of a frame (FrameJob::made_of): `inputs`, and what its passes were made of.
  std::string text(const Hash& inputs, const Dependencies& depends);
  /// True when the output is the one that was noted, and would be made of the same.
  bool is_up_to_date(const FrameJob& job);

 private:
  bool is_same(const std::string& line, const FrameJob& job);
  std::filesystem::path file_of(const std::string& name) const;
  std::string content_or_none(const std::filesystem::path& file);
  Hash sources_, look_{};
  SearchPath path_;
  PortableNames names_;
  FileHashes hashes_;
  std::map<std::shared_ptr<const SequenceFiles>, SequenceStamps> stamps_;
};

/// Removes what killed runs on this machine have left half-written in the folders of these outputs; returns how many
/// files.
int remove_leftovers(const FrameRecords& frames);
/// Notes what the output was made of, behind it; nothing when FrameJob::made_of is empty. `stamp`: of the file that was
/// written, which another may have replaced since. Thread-safe. Errors: io.
Result<void> record_made(const FrameJob& job, const std::string& stamp);

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include <utility>

#include "core/file.h"
#include "core/file_lock.h"
#include "core/pack.h"
#include "core/paths.h"
#include "core/replace_file.h"
#include "core/temporary.h"
#include "edit/write_back.h"

namespace afterglow {
namespace {

constexpr std::size_t kMostSaves = 100;

}  // namespace

PresetWriter::PresetWriter(std::filesystem::path file, PresetOptions options)
    : file_(std::move(file)), options_(std::move(options)) {}

// Errors: the file holds something else.
Result<void> PresetWriter::expect(const std::string& text) const {
  AFTERGLOW_TRY(const std::string now, read_file(file_));
  if (now == text) return {};
  return Error{ErrorKind::io, "was changed by something else in the meantime; nothing was written", file_.string()};
}

// One program at a time looks and writes, and what others save meanwhile is seen up to the very last.
Result<void> PresetWriter::replace(const std::string& before, const std::string& after) const {
  const FileLock lock(behind_links(file_).parent_path() / ".");
  AFTERGLOW_CHECK(expect(before));
  return replace_file_atomically(file_, after, [&] { return expect(before); });
}

Result<Rewrite> PresetWriter::plan(const std::vector<PresetEdit>& edits,
                                   const std::optional<WorkingText>& working) const {
  if (!working) {
    AFTERGLOW_TRY(const std::string text, read_file(file_));
    return rewrite_preset(file_, text, edits, options_);
  }
  AFTERGLOW_CHECK(expect(working->base));
  AFTERGLOW_TRY(Rewrite rewrite, rewrite_preset(file_, working->text, edits, options_));
  rewrite.before = working->base;
  return rewrite;
}

Result<void> PresetWriter::check_file() const {
  if (const std::string pack = pack_of(file_, cache_folder()); !pack.empty())
    return Error{ErrorKind::usage, "lies in the pack " + pack + ", and packs are not written: copy or unpack it first",
                 file_.filename().string()};
  return {};
}

Result<void> PresetWriter::save(const Rewrite& rewrite) {
  if (rewrite.text == rewrite.before) return {};
  AFTERGLOW_CHECK(check_file());
  AFTERGLOW_CHECK(replace(rewrite.before, rewrite.text));
  saves_.push_back({rewrite.before, rewrite.text});
  if (saves_.size() > kMostSaves) saves_.erase(saves_.begin());
  return {};
}

Result<void> PresetWriter::undo() {
  if (saves_.empty()) return Error{ErrorKind::io, "nothing was saved that could be taken back", file_.string()};
  AFTERGLOW_CHECK(replace(saves_.back().after, saves_.back().before));
  saves_.pop_back();
  return {};
}

}  // namespace afterglow

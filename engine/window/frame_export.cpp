// SPDX-License-Identifier: MIT
#include "window/frame_export.h"

#include <fmt/format.h>

#include <chrono>

#include "batch/batch_run.h"
#include "image/sequence.h"
#include "image/writer.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostAtOnce = 4;  // whole pictures in memory

/// Is the file one of those that are played?
bool is_played(const Footage& footage, const fs::path& file) {
  std::error_code none;
  for (int picture = 0; picture < footage.pictures(); ++picture)
    for (const fs::path& source : footage.files(picture))
      if (fs::equivalent(source, file, none)) return true;
  return false;
}

/// The picture that is shown; none: another footage has come.
std::optional<int> picture_of(const Player& player) {
  const int position = player.shown().position;
  const Footage& footage = player.footage();
  if (position < 0 || position >= footage.frames()) return std::nullopt;
  return footage.frame(position).picture;
}

/// The frame that is shown, among all there are.
std::string key_of(const Player& player) {
  const ShownFrame& shown = player.shown();
  const auto picture = picture_of(player);
  return fmt::format("{} {} {}", picture ? player.footage().file(*picture).string() : "", shown.name, shown.number);
}

}  // namespace

Result<fs::path> FrameExport::file_for(const Player& player) const {
  const int number = player.shown().number;
  std::error_code none;
  const bool video = !to_.empty() && is_one_output(to_.string());  // the frame goes beside it
  if (to_.empty() || video || fs::is_directory(to_, none) || !new_folder(to_.string()).empty()) {
    const auto picture = picture_of(player);
    const fs::path name = picture ? player.footage().file(*picture) : fs::path(player.shown().name);
    const std::string stem = name.stem().string();
    const std::string frame = picture && player.footage().movie(*picture) ? "." + std::to_string(number) : "";
    return (video ? to_.parent_path() : to_) / (stem + frame + "_graded.exr");
  }
  AFTERGLOW_TRY(const Pattern pattern, parse_pattern(to_.string()));
  return pattern.file(number);
}

/// The file that the shown frame goes to. Errors: it is one that is played; names that are no pattern.
Result<fs::path> FrameExport::free_file(Player& player) {
  AFTERGLOW_TRY(const fs::path wanted, file_for(player));
  const std::string frame = key_of(player);
  fs::path file = wanted;
  std::error_code none;
  for (int n = 2; fs::exists(file, none) || mine_.contains(file); ++n) {
    if (fs::exists(file, none) && is_played(player.footage(), file))
      return Error{ErrorKind::usage, "it is played and would be overwritten by its own result; nothing was written",
                   file.string()};
    const auto own = mine_.find(file);
    if (own != mine_.end() && own->second == frame) return file;
    file = wanted.parent_path() / fmt::format("{}_{}{}", wanted.stem().string(), n, wanted.extension().string());
  }
  mine_[file] = frame;
  return file;
}

void FrameExport::begin(Player& player, Ui& ui) {
  const ShownFrame& shown = player.shown();
  if (running_.size() >= kMostAtOnce) return ui.say("frames are being written; a moment");
  if (shown.unreadable || shown.failed) return ui.say("this frame is not there: nothing was written");
  const auto file = free_file(player);
  const auto folder = make_folder(new_folder(to_.string()));
  auto picture = player.screenshot();
  const Error* error = !file ? &file.error() : !folder ? &folder.error() : !picture ? &picture.error() : nullptr;
  if (error) return ui.say(error->text());
  running_.push_back(std::async(std::launch::async, [this, to = *file, frame = std::move(*picture)] {
    return Written{to, write_picture(frame, to, {}, diagnostics_)};
  }));
  ui.say("writing " + file->string());
}

void FrameExport::poll(Ui& ui) {
  std::erase_if(running_, [&](std::future<Written>& one) {
    if (one.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    const Written written = one.get();
    ui.say(written.done ? "written: " + written.file.string() : written.done.error().text());
    diagnostics_.note(written.done ? "frame written to " + written.file.string() : written.done.error().text());
    return true;
  });
  if (!running_.empty()) ui.again();
}

}  // namespace afterglow

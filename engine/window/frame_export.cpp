// SPDX-License-Identifier: MIT
#include "window/frame_export.h"

#include <chrono>

#include "image/sequence.h"
#include "image/writer.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostAtOnce = 4;  // whole pictures in memory

}  // namespace

Result<fs::path> FrameExport::file_for(const std::string& picture, int number) const {
  std::error_code none;
  if (to_.empty() || fs::is_directory(to_, none)) {
    // "clip.mp4, frame 7" is a name for people.
    const std::string stem = fs::path(picture.substr(0, picture.find(','))).stem().string();
    const std::string frame = picture.find(',') == std::string::npos ? "" : "." + std::to_string(number);
    return to_ / (stem + frame + "_graded.exr");
  }
  AFTERGLOW_TRY(const Pattern pattern, parse_pattern(to_.string()));
  return pattern.file(number);
}

void FrameExport::begin(Player& player, Ui& ui) {
  const ShownFrame& shown = player.shown();
  if (running_.size() >= kMostAtOnce) return ui.say("frames are being written; a moment");
  if (shown.unreadable || shown.failed) return ui.say("this frame is not there: nothing was written");
  const auto file = file_for(shown.name, shown.number);
  auto picture = player.screenshot();
  const Error* error = !file ? &file.error() : !picture ? &picture.error() : nullptr;
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

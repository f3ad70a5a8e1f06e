#include "temporal_player.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace afterglow {

TemporalPlayer::TemporalPlayer(const std::string& entries, bool reference) {
  const auto file = std::filesystem::temp_directory_path() / fmt::format("afterglow_temporal_{}.lua", getpid());
  std::ofstream(file) << "local fx = require \"afterglow\"\nreturn fx.stack { " << entries << " }\n";
  SessionOptions options;
  options.device.validate = true;
  options.stack.reference = reference;
  auto opened = Session::open(file, options, diagnostics_);
  EXPECT_TRUE(opened) << opened.error().text();
  session_ = std::move(*opened);
  std::filesystem::remove(file);
}

TemporalPlayer::~TemporalPlayer() { EXPECT_EQ(session_->device().validation_errors(), 0); }

std::vector<float> TemporalPlayer::play(std::vector<float> pixels, Size size, int frame, double fps) {
  Picture picture;
  picture.color = Image(size.width, size.height, 4);
  picture.color.pixels = std::move(pixels);
  BuildContext context;
  context.frame = frame;
  context.fps = fps;
  context.time = frame / fps;
  const auto done = session_->process(picture, context);
  EXPECT_TRUE(done) << done.error().text();
  return picture.color.pixels;
}

std::vector<float> TemporalPlayer::play(const reference::DoubleImage& source, int frame, double fps) {
  std::vector<float> pixels;
  for (const auto& p : source.pixels)
    for (int c = 0; c < 4; ++c) pixels.push_back(static_cast<float>(p[c]));
  return play(std::move(pixels), source.size(), frame, fps);
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "temporal_player.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace afterglow {
namespace {

Image image_of(const reference::DoubleImage& source, int channels = 4) {
  Image out(source.width, source.height, channels);
  out.pixels.clear();
  for (const auto& p : source.pixels)
    for (int c = 0; c < channels; ++c) out.pixels.push_back(static_cast<float>(p[c]));
  return out;
}

}  // namespace

TemporalPlayer::TemporalPlayer(const std::string& entries, bool reference, Precision precision) {
  const auto file = std::filesystem::temp_directory_path() / fmt::format("afterglow_temporal_{}.lua", getpid());
  std::ofstream(file) << "local fx = require \"afterglow\"\nreturn fx.stack { " << entries << " }\n";
  SessionOptions options;
  options.device.validate = true;
  options.stack.reference = reference;
  options.stack.precision = precision;
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
  return process(std::move(picture), frame, fps);
}

std::vector<float> TemporalPlayer::process(Picture picture, int frame, double fps) {
  BuildContext context;
  context.frame = frame;
  context.fps = fps;
  context.time = frame / fps;
  const auto done = session_->process(picture, context);
  EXPECT_TRUE(done) << done.error().text();
  return picture.color.pixels;
}

std::vector<float> TemporalPlayer::play(const reference::DoubleImage& source, int frame, double fps) {
  return process({.color = image_of(source)}, frame, fps);
}

std::vector<float> TemporalPlayer::play(const Scene& scene, int frame, double fps) {
  Picture picture{.color = image_of(scene.source)};
  if (scene.depth) picture.auxiliary["depth"] = image_of(*scene.depth, 1);
  if (scene.normal) picture.auxiliary["normal"] = image_of(*scene.normal, 3);
  if (scene.motion) picture.auxiliary["motion"] = image_of(*scene.motion, 2);
  return process(std::move(picture), frame, fps);
}

}  // namespace afterglow

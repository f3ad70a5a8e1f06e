// SPDX-License-Identifier: MIT
// The module's one symbol.
extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <fmt/format.h>

#include "core/module_shapes.h"
#include "image/ffmpeg_encoder.h"
#include "image/ffmpeg_join.h"
#include "image/ffmpeg_log.h"
#include "image/ffmpeg_module.h"
#include "image/ffmpeg_movie.h"
#include "image/ffmpeg_sound.h"
#include "image/ffmpeg_stream.h"

namespace afterglow {
namespace {

std::string number(unsigned version) {
  return fmt::format("{}.{}.{}", AV_VERSION_MAJOR(version), AV_VERSION_MINOR(version), AV_VERSION_MICRO(version));
}

std::string ffmpeg_versions() {
  return fmt::format("libavformat {}, libavcodec {}", number(avformat_version()), number(avcodec_version()));
}

}  // namespace
}  // namespace afterglow

extern "C" __attribute__((visibility("default"))) const afterglow::FfmpegModule* afterglow_ffmpeg_module() {
  static constexpr afterglow::FfmpegModule module{&afterglow::ffmpeg_versions,       &afterglow::open_with_ffmpeg,
                                                  &afterglow::stream_with_ffmpeg,    &afterglow::has_ffmpeg_encoder,
                                                  &afterglow::encode_with_ffmpeg,    &afterglow::join_with_ffmpeg,
                                                  &afterglow::open_sound_with_ffmpeg};
  static const bool quiet = (afterglow::take_ffmpeg_log(), true);
  static_cast<void>(quiet);
  return &module;
}

AFTERGLOW_MODULE_SHAPES

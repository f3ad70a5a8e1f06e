// SPDX-License-Identifier: MIT
#include "image/ffmpeg_log.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/error.h>
#include <libavutil/log.h>
}

#include <fmt/format.h>

#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <utility>

#include "core/printable.h"
#include "core/text.h"

namespace afterglow {
namespace {

thread_local std::string said;

void count(void* from) {
  const AVClass* kind = from ? *static_cast<AVClass**>(from) : nullptr;
  if (!kind || std::strcmp(kind->class_name, "AVCodecContext") != 0) return;
  if (void* errors = static_cast<AVCodecContext*>(from)->opaque) ++*static_cast<FfmpegErrors*>(errors);
}

void note_line(void* from, int level, const char* format, va_list arguments) {
  if (level > AV_LOG_ERROR) return;
  count(from);
  if (!said.empty()) return;
  std::array<char, 512> line{};
  std::vsnprintf(line.data(), line.size(), format, arguments);
  said = printable(trim(line.data()));
  while (!said.empty() && said.back() == '.') said.pop_back();
}

}  // namespace

void take_ffmpeg_log() { av_log_set_callback(note_line); }

std::string ffmpeg_said() { return std::exchange(said, {}); }

std::string ffmpeg_error(int code) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> text{};
  av_strerror(code, text.data(), text.size());
  const std::string more = ffmpeg_said();
  return more.empty() ? std::string(text.data()) : fmt::format("{} ({})", text.data(), more);
}

}  // namespace afterglow

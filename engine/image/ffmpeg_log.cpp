// SPDX-License-Identifier: MIT
#include "image/ffmpeg_log.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
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

bool is_a(void* from, const char* name) {
  const AVClass* kind = from ? *static_cast<AVClass**>(from) : nullptr;
  return kind && std::strcmp(kind->class_name, name) == 0;
}

void count(void* from) {
  if (!is_a(from, "AVCodecContext")) return;
  if (void* errors = static_cast<AVCodecContext*>(from)->opaque) ++*static_cast<FfmpegErrors*>(errors);
}

/// Matroska: "File ended prematurely"; MP4 and MXF: "partial file".
void remark(void* from, const char* line) {
  if (!is_a(from, "AVFormatContext")) return;
  auto* remarks = static_cast<FfmpegRemarks*>(static_cast<AVFormatContext*>(from)->opaque);
  if (remarks && (std::strstr(line, "prematurely") || std::strstr(line, "partial file"))) remarks->ends_early = true;
}

void note_line(void* from, int level, const char* format, va_list arguments) {
  if (level > AV_LOG_ERROR) return;
  count(from);
  std::array<char, 512> line{};
  std::vsnprintf(line.data(), line.size(), format, arguments);
  remark(from, line.data());
  if (!said.empty()) return;
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

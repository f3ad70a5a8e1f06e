// SPDX-License-Identifier: MIT
// What FFmpeg has to say, in one line, instead of on stderr.
#pragma once

#include <atomic>
#include <string>

namespace afterglow {

/// How many errors a decoder has told of, on whatever thread: the `opaque` of its context.
using FfmpegErrors = std::atomic<int>;

/// What a demuxer told of its file, whatever else was said before: the `opaque` of its container. Used by the thread
/// that reads.
struct FfmpegRemarks {
  bool ends_early = false;  ///< the file, within something
};

/// From here on FFmpeg writes nothing to stderr: the errors of each thread are kept for whoever asks there.
void take_ffmpeg_log();
/// The first error that FFmpeg noted on this thread since the last call, without its new line; may be empty. Threads of
/// FFmpeg's own decoders note theirs for nobody.
std::string ffmpeg_said();
/// Of a negative return value, and of what FFmpeg said: "Invalid data found when processing input (moov atom not
/// found)".
std::string ffmpeg_error(int code);

}  // namespace afterglow

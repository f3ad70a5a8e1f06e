// SPDX-License-Identifier: MIT
// Videos that are written: which codec, pixel format and colours go into which container, and what is taken where
// nobody says.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics.h"
#include "core/patience.h"
#include "core/result.h"
#include "image/clock_part.h"
#include "image/metadata.h"
#include "image/output_space.h"
#include "image/pack_frame.h"
#include "image/writer.h"

namespace afterglow {

/// Whether the extension is that of a video that is written: mp4, mov, mkv, webm, gif, apng.
bool is_video_output(const std::filesystem::path& file);
/// Those extensions, with the dot.
std::vector<std::string> video_extensions();
/// Names of `--codec`.
std::vector<std::string> video_codecs();

/// Part of the source that is copied beside the frames. Times in microseconds of its clock.
struct CopyRange {
  long long begin = std::numeric_limits<long long>::min(), end = std::numeric_limits<long long>::max();
  long long shift = 0;           ///< goes off every time stamp
  std::vector<ClockPart> clock;  ///< where that of the source starts anew
};

/// In place of a file in VideoOptions::audio: no sound, nor that of the source.
inline constexpr const char* kNoAudio = "none";
/// That of the source, where the container takes it as it is.
inline constexpr const char* kCopiedAudio = "copy";
/// Whether VideoOptions::audio is a file.
bool is_audio_file(const std::filesystem::path& audio);

/// Everything that a module needs to write one.
struct VideoPlan {
  std::string container;                                      ///< FFmpeg's muxer
  std::string codec;                                          ///< as --codec has it
  std::vector<std::string> encoders;                          ///< FFmpeg's, the first that is there is taken
  std::vector<std::pair<std::string, std::string>> settings;  ///< of the encoder, FFmpeg's names
  long long bitrate = 0;                                      ///< bits a second; 0: the encoder's quality
  PackRules pack;
  int primaries = 2, transfer = 2, matrix = 2;  ///< of ITU-T H.273; 2: not said
  bool exact = false;                           ///< what goes in comes out
  bool shows_steps = false;                     ///< 8 bits of a space that wants more, for want of a format with alpha
  Size size;
  Rational pixel_aspect{1, 1};   ///< width of a pixel to its height
  Rational rate{24, 1};          ///< frames a second, on the average
  Rational time_base{1, 24};     ///< seconds of a time stamp's unit
  std::filesystem::path audio;   ///< sound from here: --audio
  bool silent = false;           ///< kNoAudio
  bool copies_only = false;      ///< kCopiedAudio
  CopyRange range;               ///< of the source
  CopyRange audio_range;         ///< of the other file, whose time is that since the source's first frame
  std::filesystem::path source;  ///< the video that is worked on: its other streams are copied; empty: none
  std::string time_code;         ///< of the first picture; empty: the source's, if it has one
  Patience patience{};           ///< with these and with pieces
};

/// Codec, pixel format and settings for this output. `deep`: the picture had more than 8 bits; `has_alpha`: it has
/// alpha. Errors (usage), each naming what is allowed and the nearest: no such codec or not in this container, a pixel
/// format that the codec does not have, options that it does not take.
Result<VideoPlan> plan_video(const std::filesystem::path& file, const WriteOptions& options, bool deep, bool has_alpha);

/// The space of a video's codes: what was asked for; sRGB of RGB and of a view's codes (Picture::view), else BT.709.
const OutputSpace* video_space(const WriteOptions& options, const PixelLayout& layout, bool view);

/// What a video keeps of the file of its first picture: the time code, the shape of a pixel, whether light beyond black
/// and white stays.
/// `held`: places before it that it holds, too.
void keep_facts(const FileFacts& first, VideoPlan& plan, std::size_t held = 0);

/// Frames a second that a picture's file says; 0: it does not.
double said_fps(const FileFacts& picture);

/// Sides that the pixel format cannot hold. Errors (usage).
Result<void> check_video_size(const VideoPlan& plan, Size size, const std::filesystem::path& file);

/// Primaries, transfer and matrix of a space, by ITU-T H.273; 2 where there is no number.
void describe_space(const OutputSpace& space, const PixelLayout& layout, VideoPlan& plan);

/// Codes of a view (Picture::view) of a display that nobody knows: RGB says neither primaries nor transfer; YUV goes
/// with BT.709's, whose matrix it has. Whether they are stored with 8 bits, and the codec has more.
bool describe_view(const WriteOptions& options, VideoPlan& plan);

/// Frames a second that every container and encoder was seen to take.
inline constexpr double kSlowestRate = 0.001, kFastestRate = 1000;

/// 23.976 is 24000/1001. The nearest rate that a video can have.
Rational frame_rate(double fps);

/// "8M", "500k", "2500000". Errors: usage.
Result<long long> parse_bitrate(const std::string& text);

}  // namespace afterglow

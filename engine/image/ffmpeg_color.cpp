// SPDX-License-Identifier: MIT
#include "image/ffmpeg_color.h"

extern "C" {
#include <libavutil/pixdesc.h>
}

#include <fmt/format.h>

#include <cstring>

#include "image/movie_color.h"

namespace afterglow {
namespace {

/// What a file says of its colours, as the number that stands there: FFmpeg's readers (Matroska's) put numbers into
/// enumerations that have no such name, and C++ may not read those as what they claim to be.
template <class Enumeration>
int number_of(const Enumeration& stands) {
  static_assert(sizeof stands == sizeof(int));
  int number = 0;
  std::memcpy(&number, &stands, sizeof number);
  return number;
}

/// 0 and 3 are reserved; writers put 0 where they mean nothing (ProRes).
bool says(int code) { return code != kUnsaid && code != 0 && code != 3; }

struct Merge {
  bool outer_first;
  bool disagree = false;
  int operator()(int own, int around, bool trusted = true) {
    if (!says(around)) return own;
    if (!says(own) || !trusted) return around;
    disagree = disagree || own != around;
    return outer_first ? around : own;
  }
};

}  // namespace

SaidColor said_by(const AVCodecParameters& parameters) {
  return {number_of(parameters.color_primaries), number_of(parameters.color_trc), number_of(parameters.color_space)};
}

int chroma_place_of(const AVFrame& frame) { return number_of(frame.chroma_location); }

MovieColor color_of(const AVFrame& frame, AVCodecID codec, const std::string& format, const SaidColor& around,
                    std::vector<std::string>& differs) {
  MovieColor color;
  const AVPixFmtDescriptor* pixels = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
  color.rgb = pixels && (pixels->flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL)) != 0;
  const SaidColor own{number_of(frame.color_primaries), number_of(frame.color_trc), number_of(frame.colorspace)};
  Merge merge{format.starts_with("mov")};
  color.primaries = merge(own.primaries, around.primaries);
  color.transfer = merge(own.transfer, around.transfer);
  color.matrix = color.rgb ? own.matrix : merge(own.matrix, around.matrix, codec != AV_CODEC_ID_DNXHD);
  if (merge.disagree)
    differs.push_back(fmt::format(
        "its container says primaries {}, transfer {}, matrix {} (of H.273), its stream {}, {}, {}; {} counts",
        around.primaries, around.transfer, around.matrix, own.primaries, own.transfer, own.matrix,
        merge.outer_first ? "the container" : "the stream"));
  for (const AVCodecID still : {AV_CODEC_ID_MJPEG, AV_CODEC_ID_GIF, AV_CODEC_ID_APNG, AV_CODEC_ID_PNG, AV_CODEC_ID_BMP,
                                AV_CODEC_ID_WEBP, AV_CODEC_ID_PPM, AV_CODEC_ID_PGM, AV_CODEC_ID_PAM, AV_CODEC_ID_PFM})
    color.picture = color.picture || codec == still;
  // As FFmpeg's swscale has it: grey that no matrix of YUV goes with is no part of a video signal.
  const bool plain_grey = !color.rgb && pixels && pixels->nb_components <= 2 &&
                          (color.matrix == AVCOL_SPC_UNSPECIFIED || color.matrix == AVCOL_SPC_RGB);
  const bool full_format = pixels && std::strncmp(pixels->name, "yuvj", 4) == 0;
  const int range = number_of(frame.color_range);
  color.full_range = range == AVCOL_RANGE_JPEG || full_format ||
                     (range == AVCOL_RANGE_UNSPECIFIED && (color.rgb || color.picture || plain_grey));
  return color;
}

}  // namespace afterglow

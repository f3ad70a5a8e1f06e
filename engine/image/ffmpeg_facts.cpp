// SPDX-License-Identifier: MIT
#include "image/ffmpeg_facts.h"

extern "C" {
#include <libavutil/display.h>
#include <libavutil/mastering_display_metadata.h>
#include <libavutil/pixdesc.h>
}

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "image/ffmpeg_color.h"

namespace afterglow {
namespace {

const std::int32_t* matrix_of(const AVFrame& frame, AVStream& stream) {
  constexpr std::size_t kSize = 9 * sizeof(std::int32_t);
#if LIBAVFORMAT_VERSION_MAJOR >= 61
  const AVPacketSideData* found = av_packet_side_data_get(
      stream.codecpar->coded_side_data, stream.codecpar->nb_coded_side_data, AV_PKT_DATA_DISPLAYMATRIX);
  if (found && found->size >= kSize) return reinterpret_cast<const std::int32_t*>(found->data);
#else
  std::size_t size = 0;
  const std::uint8_t* found = av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, &size);
  if (found && size >= kSize) return reinterpret_cast<const std::int32_t*>(found);
#endif
  const AVFrameSideData* own = av_frame_get_side_data(&frame, AV_FRAME_DATA_DISPLAYMATRIX);
  return own && own->size >= kSize ? reinterpret_cast<const std::int32_t*>(own->data) : nullptr;
}

/// SMPTE ST 2086 and CTA-861.3, in the container or in the first frame.
bool has_hdr_metadata(const AVFrame& frame, [[maybe_unused]] AVStream& stream) {
#if LIBAVFORMAT_VERSION_MAJOR >= 61
  const auto in_container = [&](AVPacketSideDataType type) {
    return av_packet_side_data_get(stream.codecpar->coded_side_data, stream.codecpar->nb_coded_side_data, type) !=
           nullptr;
  };
#else
  const auto in_container = [&](AVPacketSideDataType type) {
    return av_stream_get_side_data(&stream, type, nullptr) != nullptr;
  };
#endif
  return in_container(AV_PKT_DATA_MASTERING_DISPLAY_METADATA) || in_container(AV_PKT_DATA_CONTENT_LIGHT_LEVEL) ||
         av_frame_get_side_data(&frame, AV_FRAME_DATA_MASTERING_DISPLAY_METADATA) != nullptr ||
         av_frame_get_side_data(&frame, AV_FRAME_DATA_CONTENT_LIGHT_LEVEL) != nullptr;
}

/// Where the matrix takes the picture's axes (x to the right, y down), as Exif numbers it.
void use_display_matrix(const std::int32_t* matrix, MovieFacts& facts) {
  const auto sign = [](std::int32_t v) { return v > 0 ? 1 : v < 0 ? -1 : 0; };
  const std::array<int, 4> axes{sign(matrix[0]), sign(matrix[1]), sign(matrix[3]), sign(matrix[4])};
  constexpr std::array<std::array<int, 4>, 8> kOrientations{{{1, 0, 0, 1},
                                                             {-1, 0, 0, 1},
                                                             {-1, 0, 0, -1},
                                                             {1, 0, 0, -1},
                                                             {0, 1, 1, 0},
                                                             {0, 1, -1, 0},
                                                             {0, -1, -1, 0},
                                                             {0, -1, 1, 0}}};
  for (std::size_t i = 0; i < kOrientations.size(); ++i)
    if (axes == kOrientations[i]) {
      facts.orientation = static_cast<int>(i) + 1;
      return;
    }
  const double angle = av_display_rotation_get(matrix);
  if (std::isfinite(angle)) facts.turned = -angle;
}

bool is_interlaced(const AVFrame& frame) {
#ifdef AV_FRAME_FLAG_INTERLACED
  return (frame.flags & AV_FRAME_FLAG_INTERLACED) != 0;
#else
  return frame.interlaced_frame != 0;
#endif
}

Rational rational(AVRational r) { return {r.num, r.den}; }

/// A side that becomes longer; an even one stays even, for codecs that halve colour.
int lengthened(int side, double ratio) {
  const int unit = side % 2 == 0 ? 2 : 1;
  return unit * static_cast<int>(std::lround(side * ratio / unit));
}

/// Square pixels: the side that has too few is made longer.
Size square_pixels(const Size& stored, const AVRational& aspect) {
  const double ratio = av_q2d(aspect);
  if (ratio > 1) return {lengthened(stored.width, ratio), stored.height};
  return {stored.width, lengthened(stored.height, 1 / ratio)};
}

void use_aspect(FfmpegInput& input, const AVFrame& first, MovieFacts& facts) {
  facts.size = facts.stored;
  AVRational aspect = av_guess_sample_aspect_ratio(&input.container(), &input.stream(), const_cast<AVFrame*>(&first));
  constexpr double kMost = 10;  // beyond it nobody means it
  if (aspect.num <= 0 || aspect.den <= 0 || aspect.num == aspect.den) return;
  if (av_q2d(aspect) > kMost || av_q2d(aspect) < 1 / kMost) {
    facts.notes.push_back(fmt::format("its pixel aspect {}:{} makes no sense and is ignored", aspect.num, aspect.den));
    return;
  }
  facts.pixel_aspect = rational(aspect);
  facts.size = square_pixels(facts.stored, aspect);
  facts.notes.push_back(fmt::format("its pixels are {}:{}; {}x{} is scaled to {}x{} square ones", aspect.num,
                                    aspect.den, facts.stored.width, facts.stored.height, facts.size.width,
                                    facts.size.height));
}

}  // namespace

std::string first_time_code(const AVFormatContext& container) {
  const AVDictionaryEntry* found = av_dict_get(container.metadata, "timecode", nullptr, 0);
  for (unsigned i = 0; !found && i < container.nb_streams; ++i)
    found = av_dict_get(container.streams[i]->metadata, "timecode", nullptr, 0);
  return found ? found->value : "";
}

MovieFacts facts_of(FfmpegInput& input, const AVFrame& first) {
  MovieFacts facts;
  AVStream& stream = input.stream();
  facts.container = input.container().iformat->name;
  facts.codec = avcodec_get_name(stream.codecpar->codec_id);
  facts.stored = {first.width, first.height};
  facts.interlaced = is_interlaced(first);
  facts.hdr_metadata = has_hdr_metadata(first, stream);
  facts.rate = rational(stream.avg_frame_rate);
  facts.time_base = rational(stream.time_base);
  facts.time_code = first_time_code(input.container());
  if (const AVPixFmtDescriptor* format = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(first.format))) {
    const bool palette = (format->flags & AV_PIX_FMT_FLAG_PAL) != 0;
    facts.pixel_format = format->name;
    facts.bits = palette ? 8 : format->comp[0].depth;
    facts.floating = (format->flags & AV_PIX_FMT_FLAG_FLOAT) != 0;
    facts.has_alpha = palette || (format->flags & AV_PIX_FMT_FLAG_ALPHA) != 0;
    facts.grey = format->nb_components <= 2 && !palette;
  }
  facts.color = color_of(first, stream.codecpar->codec_id, facts.container, input.said_around(), facts.warnings);
  use_aspect(input, first, facts);
  if (const std::int32_t* matrix = matrix_of(first, stream)) use_display_matrix(matrix, facts);
  facts.leaves_alpha = input.leaves_alpha();
  return facts;
}

FramePlanes planes_of(const AVFrame& frame, const MovieFacts& facts) {
  FramePlanes planes;
  planes.format = static_cast<AVPixelFormat>(frame.format);
  planes.stored = facts.stored;
  planes.wanted = facts.size;
  planes.matrix = facts.color.matrix;
  planes.transfer = facts.color.transfer;
  planes.primaries = facts.color.primaries;
  planes.full_range = facts.color.full_range;
  planes.chroma_place = chroma_place_of(frame);
  return planes;
}

}  // namespace afterglow

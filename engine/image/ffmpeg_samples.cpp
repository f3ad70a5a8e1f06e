// SPDX-License-Identifier: MIT
#include "image/ffmpeg_samples.h"

extern "C" {
#include <libavutil/channel_layout.h>
#include <libavutil/samplefmt.h>
}

#include <utility>

namespace afterglow {
namespace {

template <class T>
void hold_planes(AVFrame& frame, bool planar) {
  const int channels = frame.ch_layout.nb_channels, planes = planar ? channels : 1;
  const std::int64_t count = std::int64_t{frame.nb_samples} * (planar ? 1 : channels);
  for (int i = 0; i < planes; ++i) {
    T* samples = reinterpret_cast<T*>(frame.extended_data[i]);
    std::transform(samples, samples + count, samples, held_sample<T>);
  }
}

/// A copy; where the file says none, the usual one for so many channels. Negative: an error.
int known_layout(AVChannelLayout& to, const AVChannelLayout& from) {
  if (from.order != AV_CHANNEL_ORDER_UNSPEC) return av_channel_layout_copy(&to, &from);
  av_channel_layout_default(&to, from.nb_channels);
  return 0;
}

}  // namespace

bool hold_samples(AVFrame& frame) {
  const auto format = static_cast<AVSampleFormat>(frame.format);
  const AVSampleFormat packed = av_get_packed_sample_fmt(format);
  if (packed != AV_SAMPLE_FMT_FLT && packed != AV_SAMPLE_FMT_DBL) return true;
  if (av_frame_make_writable(&frame) < 0) return false;
  const bool planar = av_sample_fmt_is_planar(format) != 0;
  if (packed == AV_SAMPLE_FMT_FLT)
    hold_planes<float>(frame, planar);
  else
    hold_planes<double>(frame, planar);
  return true;
}

SwrHandle converter_between(const AVFrame& from, const AVChannelLayout& from_layout, const AVChannelLayout& layout,
                            AVSampleFormat format, int rate) {
  AVChannelLayout given{}, wanted = layout;  // FFmpeg before 6 takes no constant ones
  if (known_layout(given, from_layout) < 0) return nullptr;
  SwrContext* made = nullptr;
  const int set = swr_alloc_set_opts2(&made, &wanted, format, rate, &given, static_cast<AVSampleFormat>(from.format),
                                      from.sample_rate, 0, nullptr);
  av_channel_layout_uninit(&given);
  SwrHandle converter(made);
  return set < 0 || swr_init(made) < 0 ? nullptr : std::move(converter);
}

}  // namespace afterglow

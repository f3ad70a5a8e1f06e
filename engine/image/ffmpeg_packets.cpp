// SPDX-License-Identifier: MIT
#include "image/ffmpeg_packets.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "image/ffmpeg_log.h"

namespace afterglow {
namespace {

constexpr int kMostStrangers = 64;  // packets that begin in the middle, after a seek

std::int64_t in_file(std::int64_t stamp, const MoviePacket& packet) {
  return stamp == AV_NOPTS_VALUE ? stamp : stamp - packet.shift;
}

auto place_of(const MoviePacket& packet) {
  return std::tuple(packet.pos, in_file(packet.dts, packet), in_file(packet.pts, packet), packet.size);
}

}  // namespace

FfmpegPackets::FfmpegPackets(std::unique_ptr<FfmpegInput> input, const MovieIndex& index, Reopen reopen)
    : input_(std::move(input)), index_(index), reopen_(std::move(reopen)), held_(av_packet_alloc()) {
  by_place_.resize(index.packets.size());
  std::iota(by_place_.begin(), by_place_.end(), 0);
  std::ranges::sort(by_place_, {}, [&](int i) { return place_of(index_.packets[static_cast<std::size_t>(i)]); });
  next_ = static_cast<int>(index.packets.size());
}

/// −1: none, or more than one that looks like it.
int FfmpegPackets::find(const AVPacket& packet) const {
  const auto key = [&](int i) { return place_of(index_.packets[static_cast<std::size_t>(i)]); };
  const auto wanted = std::tuple(packet.pos, packet.dts, packet.pts, packet.size);
  const auto found = std::ranges::lower_bound(by_place_, wanted, {}, key);
  if (found == by_place_.end() || key(*found) != wanted) return -1;
  if (found + 1 != by_place_.end() && key(*(found + 1)) == wanted) return -1;
  return *found;
}

bool FfmpegPackets::take(AVPacket& packet) {
  if (holds_) {
    av_packet_unref(&packet);
    av_packet_move_ref(&packet, held_.get());
    holds_ = false;
    return true;
  }
  for (int errors = 0; errors < kMostStrangers;) {
    const int got = input_->read(packet);
    if (got == 0) return true;
    if ((given_up_ = input_->given_up()) || got == AVERROR_EOF) return false;
    ++errors;
  }
  return false;
}

bool FfmpegPackets::try_seek(std::int64_t stamp, int packet) {
  holds_ = false;
  av_packet_unref(held_.get());
  if (stamp == AV_NOPTS_VALUE ||
      av_seek_frame(&input_->container(), input_->stream().index, stamp, AVSEEK_FLAG_BACKWARD) < 0)
    return false;
  for (int strangers = 0; strangers < kMostStrangers; ++strangers) {
    av_packet_unref(held_.get());
    if (!take(*held_)) return false;
    next_ = find(*held_);
    if (next_ < 0) continue;
    if (next_ > packet) return false;
    holds_ = true;
    break;
  }
  while (holds_ && next_ < packet) {
    av_packet_unref(held_.get());
    holds_ = false;
    if (!take(*held_)) return false;
    ++next_;
    holds_ = find(*held_) == next_;
  }
  return holds_;
}

Result<void> FfmpegPackets::begin_anew(int packet) {
  holds_ = false;
  av_packet_unref(held_.get());
  auto again = reopen_();
  if (!again) {
    given_up_ = again.error();
    return *given_up_;
  }
  input_ = *std::move(again);
  for (next_ = 0; next_ < packet; ++next_) {
    av_packet_unref(held_.get());
    if (!take(*held_)) return not_there();
  }
  av_packet_unref(held_.get());
  return {};
}

Result<void> FfmpegPackets::seek(int packet) {
  if (given_up_) return not_there();
  if (packet == next_) return {};
  const MoviePacket& wanted = index_.packets[static_cast<std::size_t>(packet)];
  const AVRational base = input_->stream().time_base;
  const std::int64_t second = base.num > 0 ? base.den / base.num : 1;
  const std::int64_t pts = in_file(wanted.pts, wanted), dts = in_file(wanted.dts, wanted);
  const bool found = packet > 0 && (try_seek(pts, packet) || try_seek(dts, packet) ||
                                    (dts != AV_NOPTS_VALUE && try_seek(dts - second, packet)));
  static_cast<void>(ffmpeg_said());
  if (given_up_) return not_there();
  return found ? Result<void>() : begin_anew(packet);
}

Error FfmpegPackets::not_there() const {
  return given_up_ ? *given_up_ : Error{ErrorKind::io, "changed while it was read"};
}

Result<void> FfmpegPackets::read(AVPacket& packet) {
  const MoviePacket& expected = index_.packets[static_cast<std::size_t>(next_)];
  if (!take(packet) || packet.size != expected.size) return not_there();
  packet.pts = packet.dts = next_;
  ++next_;
  return {};
}

}  // namespace afterglow

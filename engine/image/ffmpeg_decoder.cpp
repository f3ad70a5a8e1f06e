// SPDX-License-Identifier: MIT
#include "image/ffmpeg_decoder.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "image/ffmpeg_log.h"

namespace afterglow {
namespace {

/// Frames may come out so many packets later than they went in.
constexpr int kLongestDelay = 64;

std::uint64_t bytes_of(const AVFrame& frame) {
  std::uint64_t bytes = 0;
  for (const AVBufferRef* buffer : frame.buf)
    if (buffer) bytes += buffer->size;
  return bytes;
}

std::size_t at(int packet) { return static_cast<std::size_t>(packet); }

}  // namespace

FfmpegDecoder::FfmpegDecoder(FfmpegPackets packets, const MovieIndex& index, std::uint64_t cache_bytes)
    : packets_(std::move(packets)),
      index_(index),
      cache_bytes_(cache_bytes),
      packet_(av_packet_alloc()),
      settled_(index.packets.size()) {
  for (std::size_t i = 0; i < index.packets.size(); ++i)
    if (index.packets[i].damaged) damaged_.insert(static_cast<int>(i));
}

const AVFrame* FfmpegDecoder::cached(int packet) const {
  const auto found = std::ranges::find(cache_, packet, &Cached::packet);
  return found == cache_.end() ? nullptr : found->frame.get();
}

void FfmpegDecoder::keep(FrameHandle frame, int packet) {
  if (cached(packet)) return;
  Cached made{.packet = packet, .bytes = bytes_of(*frame), .frame = std::move(frame)};
  held_bytes_ += made.bytes;
  cache_.push_back(std::move(made));
  while (held_bytes_ > cache_bytes_ && cache_.size() > 1) {
    held_bytes_ -= cache_.front().bytes;
    cache_.pop_front();
  }
}

void FfmpegDecoder::forget() {
  cache_.clear();
  held_bytes_ = 0;
}

Result<void> FfmpegDecoder::begin_at(int packet, bool careful) {
  AFTERGLOW_CHECK(packets_.seek(packet));
  AFTERGLOW_TRY(codec_, packets_.input().open_decoder(*errors_, careful));
  const AVCodecDescriptor* kind = avcodec_descriptor_get(codec_->codec_id);
  intra_only_ = kind && (kind->props & AV_CODEC_PROP_INTRA_ONLY) != 0;
  *errors_ = 0;
  careful_ = careful;
  start_ = packet;
  emitted_ = came_last_ = -1;
  draining_ = ended_ = false;
  return {};
}

/// What most decoders tell of damage is a message while they decode the packet, as long as they use one thread.
void FfmpegDecoder::note_complaints() {
  const AVCodecID codec = codec_->codec_id;
  const bool flags_tell = codec == AV_CODEC_ID_H264 || codec == AV_CODEC_ID_MPEG1VIDEO ||
                          codec == AV_CODEC_ID_MPEG2VIDEO || codec == AV_CODEC_ID_MPEG4;
  if (flags_tell || !(careful_ || intra_only_) || errors_->exchange(0) == 0) return;
  const int packet = packets_.position() - 1;
  if (index_.start_for(packet) < start_) return;
  complained_.insert(packet);
  damaged_.insert(packet);
}

/// Frames from..to−1 should have come out and have not.
void FfmpegDecoder::note_lost(int from, int to) {
  for (int rank = from; rank < to; ++rank)
    if (const int packet = index_.order[at(rank)];
        packet >= start_ && index_.start_for(packet) >= start_ && !cached(packet))
      damaged_.insert(packet);
}

/// One frame out of the decoder, with as many packets as that takes. False: there is no more.
Result<bool> FfmpegDecoder::step() {
  for (int errors = 0; !ended_;) {
    FrameHandle frame(av_frame_alloc());
    const int got = avcodec_receive_frame(codec_.get(), frame.get());
    if (got == 0) {
      if (frame->pts < start_ || frame->pts >= static_cast<std::int64_t>(index_.packets.size())) continue;
      came_last_ = static_cast<int>(frame->pts);
      const int rank = index_.rank[at(came_last_)];
      if (rank < 0) continue;
      note_lost(emitted_ + 1, rank);
      emitted_ = std::max(emitted_, rank);
      // What comes out before its own group has begun is built on frames that were not decoded.
      if (index_.start_for(came_last_) < start_) continue;
      note_complaints();
      const bool bad = complained_.contains(came_last_) || frame->decode_error_flags != 0 ||
                       (frame->flags & AV_FRAME_FLAG_CORRUPT) != 0;
      if (bad || index_.packets[at(came_last_)].damaged)
        damaged_.insert(came_last_);
      else
        damaged_.erase(came_last_);
      keep(std::move(frame), came_last_);
      return true;
    }
    if (got == AVERROR_EOF || (draining_ && ++errors > kLongestDelay)) {
      ended_ = true;
      note_lost(emitted_ + 1, static_cast<int>(index_.order.size()));
    } else if (got == AVERROR(EAGAIN)) {
      if (!packets_.at_end()) {
        AFTERGLOW_CHECK(packets_.read(*packet_));
        avcodec_send_packet(codec_.get(), packet_.get());  // what it cannot take does not come out either
        av_packet_unref(packet_.get());
        note_complaints();
      } else if (!std::exchange(draining_, true)) {
        avcodec_send_packet(codec_.get(), nullptr);
      }
    }
    // Other errors are of a frame that will be missed.
  }
  return false;
}

/// The last frame to wait for: those that this one may be built on come out behind it, with word of their damage.
int FfmpegDecoder::last_needed(int packet, int start) const {
  int rank = index_.rank[at(packet)];
  for (int i = packet; i >= std::max(start, packet - kLongestDelay); --i) rank = std::max(rank, index_.rank[at(i)]);
  return rank;
}

Result<void> FfmpegDecoder::decode_until(int packet, int start) {
  const int needed = last_needed(packet, start);
  FrameHandle wanted;  // held when the cache is too small for what comes behind it
  while (emitted_ < needed) {
    AFTERGLOW_TRY(const bool more, step());
    if (!more) break;
    if (came_last_ == packet) wanted.reset(av_frame_clone(cached(packet)));
  }
  if (wanted && !cached(packet)) keep(std::move(wanted), packet);
  settled_[at(packet)] = true;
  return {};
}

/// Whether all that the frame may be built on came out whole.
Result<void> FfmpegDecoder::check_whole(int packet, int start) const {
  if (damaged_.contains(packet) || !cached(packet)) return Error{ErrorKind::io, "is damaged"};
  if (intra_only_) return {};
  for (auto bad = damaged_.lower_bound(start); bad != damaged_.end() && *bad < packet; ++bad)
    if (!index_.packets[at(*bad)].needless)
      return Error{ErrorKind::io, fmt::format("is built on frame {}, which is damaged", index_.rank[at(*bad)] + 1)};
  return {};
}

Result<FrameHandle> FfmpegDecoder::frame(int number) {
  const int packet = index_.order[at(number)];
  const int start = index_.start_for(packet);
  if (!cached(packet) || !settled_[at(packet)]) {
    const bool covers = start_ >= 0 && start_ <= start && packets_.position() >= start;
    const bool comes = cached(packet) || (emitted_ < number && !ended_);
    if (!covers || !comes) AFTERGLOW_CHECK(begin_at(start));
    AFTERGLOW_CHECK(decode_until(packet, start));
    if (*errors_ > 0 && !careful_ && !intra_only_) {
      forget();
      AFTERGLOW_CHECK(begin_at(start, true));
      AFTERGLOW_CHECK(decode_until(packet, start));
    }
  }
  AFTERGLOW_CHECK(check_whole(packet, start));
  FrameHandle out(av_frame_clone(cached(packet)));
  if (!out) return Error{ErrorKind::io, "cannot be decoded: there is no memory"};
  return out;
}

Result<std::vector<int>> FfmpegDecoder::order_by_decoding() {
  AFTERGLOW_CHECK(begin_at(0));
  std::vector<int> order;
  std::vector<bool> came(index_.packets.size());
  while (true) {
    AFTERGLOW_TRY(const bool more, step());
    if (!more) break;
    // Out of a damaged packet two frames may come: it is one in the order.
    if (!came[at(came_last_)]) order.push_back(came_last_);
    came[at(came_last_)] = true;
  }
  start_ = -1;
  forget();
  return order;
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "image/ffmpeg_index.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "image/ffmpeg_clock.h"
#include "image/ffmpeg_log.h"

namespace afterglow {
namespace {

constexpr std::size_t kMostPackets = 1'000'000;
constexpr int kMostErrors = 64;  // in a row, before the rest of the file is given up

/// What an H.264 access unit begins with. `instant`: nothing reaches back over it (IDR). `intra`: a picture that
/// decoding can begin at, though what shows before it, or its parameters, may need what lies before. `other`: no
/// beginning at all, though streams that refresh themselves bit by bit mark it as one.
enum class AccessPoint { other, intra, instant };

class AccessPointFinder {
 public:
  explicit AccessPointFinder(const AVCodecParameters& parameters) {
    // An avcC record begins with 1 and says how long lengths are; without one there are start codes.
    if (parameters.extradata_size > 4 && parameters.extradata[0] == 1) length_ = (parameters.extradata[4] & 3) + 1;
  }

  AccessPoint operator()(const AVPacket& packet) const {
    const std::uint8_t* at = packet.data;
    const std::uint8_t* end = packet.data + packet.size;
    while (length_ > 0 && end - at > length_) {
      std::int64_t size = 0;
      for (int i = 0; i < length_; ++i) size = size << 8 | at[i];
      at += length_;
      if (is_slice(*at)) return of_slice(at, end);
      if (size > end - at) break;
      at += size;
    }
    for (; length_ == 0 && end - at > 3; ++at)
      if (at[0] == 0 && at[1] == 0 && at[2] == 1 && is_slice(at[3])) return of_slice(at + 3, end);
    return AccessPoint::other;
  }

 private:
  static bool is_slice(int header) { return (header & 31) == 1 || (header & 31) == 5; }

  static AccessPoint of_slice(const std::uint8_t* at, const std::uint8_t* end) {
    constexpr int kIdr = 5, kIntra = 2, kKinds = 5;  // slice_type 2 and 7
    if ((*at & 31) == kIdr) return AccessPoint::instant;
    int bit = 0;
    const auto next = [&] {
      const std::uint8_t* byte = at + 1 + bit / 8;
      return byte < end ? *byte >> (7 - bit++ % 8) & 1 : 1;
    };
    const auto exp_golomb = [&] {
      int zeros = 0, value = 0;
      while (zeros < 24 && next() == 0) ++zeros;
      for (int i = 0; i < zeros; ++i) value = value << 1 | next();
      return (1 << zeros) - 1 + value;
    };
    exp_golomb();  // first_mb_in_slice
    return exp_golomb() % kKinds == kIntra ? AccessPoint::intra : AccessPoint::other;
  }

  int length_ = 0;
};

/// Stamps that far from 0 are none: sums and differences of others fit.
constexpr std::int64_t kFarthestStamp = std::int64_t{1} << 60;
std::int64_t near_stamp(std::int64_t stamp) {
  return stamp < -kFarthestStamp || stamp > kFarthestStamp ? AV_NOPTS_VALUE : stamp;
}

MoviePacket noted(const AVPacket& packet, AVCodecID codec, const AccessPointFinder& find) {
  MoviePacket out{.pts = near_stamp(packet.pts),
                  .dts = near_stamp(packet.dts),
                  .pos = packet.pos,
                  .size = packet.size,
                  .duration = near_stamp(std::max<std::int64_t>(packet.duration, 0))};
  out.key = (packet.flags & AV_PKT_FLAG_KEY) != 0;
  out.exact = out.key;
  if (out.key && codec == AV_CODEC_ID_H264) {
    const AccessPoint point = find(packet);
    out.key = point != AccessPoint::other;
    out.exact = point == AccessPoint::instant;
  }
  out.shown = (packet.flags & AV_PKT_FLAG_DISCARD) == 0;
  if (codec == AV_CODEC_ID_VP8 && (packet.data[0] & 0x10) == 0) out.shown = false;  // for other frames to look at
  out.damaged = (packet.flags & AV_PKT_FLAG_CORRUPT) != 0;
  out.needless = (packet.flags & AV_PKT_FLAG_DISPOSABLE) != 0;
  return out;
}

/// Of the last frame, where the container holds lengths; elsewhere FFmpeg guesses them from rates, which is better than
/// nothing for a frame alone.
long long last_length(const FfmpegInput& input, const MovieIndex& index) {
  if (index.order.empty()) return 0;
  const std::string format = input.container().iformat->name;
  const bool holds = format.starts_with("mov") || format.starts_with("matroska") || format == "gif" || format == "apng";
  const std::int64_t length = index.packets[static_cast<std::size_t>(index.order.back())].duration;
  return (holds || index.order.size() == 1) && length > 0 ? length : 0;
}

/// Frames that the container's own tables tell of, beyond the packets that are there. `cut`: the file ends too early.
/// AVI counts places, of which some may be empty: the one before stays; its stamps are these places' numbers.
std::size_t missing_frames(FfmpegInput& input, const MovieIndex& index, bool cut) {
  AVStream& stream = input.stream();
  const std::string format = input.container().iformat->name;
  std::int64_t told = 0, there = static_cast<std::int64_t>(index.packets.size());
  if (format.starts_with("mov")) told = avformat_index_get_entries_count(&stream);
  if (format == "avi" && cut) {
    told = stream.nb_frames;
    for (const MoviePacket& packet : index.packets)
      if (packet.dts != AV_NOPTS_VALUE) there = std::max(there, packet.dts + 1);
    // What is cut off may be the index alone.
    if (told > 0 && told <= there) return 0;
  }
  const bool more = told > there && told < static_cast<std::int64_t>(kMostPackets);
  return more ? static_cast<std::size_t>(told - there) : cut ? 1 : 0;
}

}  // namespace

void hide_what_comes_before_the_first_key(std::span<MoviePacket> packets) {
  const auto first = std::ranges::find(packets, true, &MoviePacket::key);
  if (first == packets.end()) return;
  for (auto packet = packets.begin(); packet != first; ++packet) packet->shown = false;
  for (auto packet = first; packet != packets.end(); ++packet)
    if (packet->pts < first->pts && packet->pts != AV_NOPTS_VALUE) packet->shown = false;
}

void sort_by_time(MovieIndex& index) {
  index.order.clear();
  for (std::size_t i = 0; i < index.packets.size(); ++i)
    if (index.packets[i].shown) index.order.push_back(static_cast<int>(i));
  const auto pts = [&](int packet) { return index.packets[static_cast<std::size_t>(packet)].pts; };
  std::ranges::stable_sort(index.order, {}, pts);
  index.rank.assign(index.packets.size(), -1);
  index.pts.clear();
  for (std::size_t i = 0; i < index.order.size(); ++i) {
    index.rank[static_cast<std::size_t>(index.order[i])] = static_cast<int>(i);
    index.pts.push_back(pts(index.order[i]));
  }
}

void add_missing(MovieIndex& index, std::size_t missing) {
  index.missing = missing;
  const std::size_t frames = index.pts.size();
  // Frames without stamps are ordered, and come here again, later.
  const auto near = [](long long stamp) { return std::clamp<long long>(stamp, -kFarthestStamp, kFarthestStamp); };
  const long long step =
      frames > 1
          ? std::max(1ll, (near(index.pts.back()) - near(index.pts.front())) / static_cast<long long>(frames - 1))
          : 1;
  for (std::size_t i = 0; i < missing; ++i)
    index.pts.push_back((index.pts.empty() ? 0 : near(index.pts.back())) + step);
}

int MovieIndex::start_for(int packet) const {
  const MoviePacket& wanted = packets[static_cast<std::size_t>(packet)];
  bool one_more = false;
  for (auto at = std::ranges::upper_bound(keys, packet); at != keys.begin();) {
    const MoviePacket& key = packets[static_cast<std::size_t>(*--at)];
    if (key.pts > wanted.pts && wanted.pts != AV_NOPTS_VALUE) continue;
    if (key.exact || one_more) return *at;
    one_more = true;
  }
  return 0;
}

Result<MovieIndex> index_movie(FfmpegInput& input) {
  MovieIndex index;
  const PacketHandle packet(av_packet_alloc());
  const AVCodecParameters& parameters = *input.stream().codecpar;
  const AccessPointFinder find(parameters);
  bool cut_short = false;
  for (int errors = 0; errors < kMostErrors;) {
    const int got = input.read(*packet);
    if (auto reason = input.given_up()) return *std::move(reason);
    if (got == AVERROR_EOF) break;
    if (got < 0) {
      ++errors;
      cut_short = true;
      continue;
    }
    errors = 0;
    if (index.packets.size() == kMostPackets)
      return Error{ErrorKind::io, fmt::format("has more than {} frames", kMostPackets)};
    index.packets.push_back(noted(*packet, parameters.codec_id, find));
    if (index.packets.back().key) index.keys.push_back(static_cast<int>(index.packets.size()) - 1);
    av_packet_unref(packet.get());
  }
  if (index.packets.empty()) return Error{ErrorKind::io, "has no frame (truncated?)"};
  index.parts = run_on(input.container(), input.stream().time_base, index.packets);
  hide_what_comes_before_the_first_key(index.packets);
  sort_by_time(index);
  static_cast<void>(ffmpeg_said());
  cut_short = input.ends_early() || cut_short;
  if (auto reason = input.given_up()) return *std::move(reason);
  const std::size_t missing = missing_frames(input, index, cut_short);
  if (index.order.empty() && missing == 0) return Error{ErrorKind::io, "has no frame that shows"};
  index.last_length = last_length(input, index);
  add_missing(index, missing);
  return index;
}

}  // namespace afterglow

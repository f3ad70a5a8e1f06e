// SPDX-License-Identifier: MIT
#include "image/ffmpeg_clock.h"

extern "C" {
#include <libavutil/mathematics.h>
}

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

namespace afterglow {
namespace {

// As in the program ffmpeg: MPEG streams may pause for so long, and their stamps of decoding never go back.
constexpr std::int64_t kLongestPause = 10 * AV_TIME_BASE, kRoundBack = AV_TIME_BASE / 10;
/// Microseconds. Sound that goes on as exactly as that is of the same part.
constexpr std::int64_t kSeamless = AV_TIME_BASE / 2;

bool is_known(std::int64_t stamp) { return stamp != AV_NOPTS_VALUE; }

/// Where parts begin, as places in `packets`; the first at 0.
std::vector<std::size_t> beginnings(AVRational time_base, std::span<const MoviePacket> packets) {
  std::vector<std::size_t> out{0};
  std::int64_t last = AV_NOPTS_VALUE;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    const std::int64_t stamp = packets[i].dts;
    if (!is_known(stamp)) continue;
    if (starts_anew(last, stamp, time_base)) out.push_back(i);
    last = stamp;
  }
  return out;
}

/// As at the beginning of a file; but a stream that runs on while its clock alone jumps is whole. `joined`: it does not
/// run on.
void hide_orphans(std::span<MoviePacket> part, bool joined) {
  if (joined || part.front().key) hide_what_comes_before_the_first_key(part);
}

/// The usual way from one packet to the next; where there is but one, its own length.
std::int64_t step_of(std::span<const MoviePacket> part) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < part.size(); ++i)
    if (is_known(part[i].dts) && is_known(part[i - 1].dts) && part[i].dts > part[i - 1].dts)
      steps.push_back(part[i].dts - part[i - 1].dts);
  if (steps.empty()) return std::max<std::int64_t>(part.back().duration, 1);
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

/// So that the part begins when those before it have ended: both to decode and to show.
std::int64_t shift_behind(std::span<const MoviePacket> before, std::int64_t step, std::span<const MoviePacket> part) {
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  std::int64_t decoded = kLeast, shown = kLeast;
  for (const MoviePacket& packet : before) {
    if (is_known(packet.dts)) decoded = std::max(decoded, packet.dts);
    if (is_known(packet.pts) && packet.shown) shown = std::max(shown, packet.pts);
  }
  std::int64_t shift = decoded + step - part.front().dts;
  const auto visible = [](const MoviePacket& packet) { return packet.shown && is_known(packet.pts); };
  std::int64_t first = AV_NOPTS_VALUE;
  for (const MoviePacket& packet : part)
    if (visible(packet) && (!is_known(first) || packet.pts < first)) first = packet.pts;
  if (is_known(first) && shown != kLeast) shift = std::max(shift, shown + step - first);
  return shift;
}

/// Where parts are joined, counters of packets start anew as well, which looks like damage of the last picture; parsers
/// say it of the one before. What is damaged indeed its decoder will say. Returns whether it looked so.
bool trust_last(std::span<MoviePacket> part) {
  constexpr std::size_t kTold = 2;
  bool told = false;
  for (MoviePacket& packet : part.last(std::min(kTold, part.size()))) told |= std::exchange(packet.damaged, false);
  return told;
}

void move(std::span<MoviePacket> part, std::int64_t shift) {
  for (MoviePacket& packet : part) {
    packet.shift = shift;
    if (is_known(packet.pts)) packet.pts += shift;
    if (is_known(packet.dts)) packet.dts += shift;
  }
}

}  // namespace

bool is_mpeg(const AVFormatContext& container) { return std::string_view(container.iformat->name).starts_with("mpeg"); }

bool starts_anew(std::int64_t last, std::int64_t next, AVRational time_base) {
  if (!is_known(last) || !is_known(next)) return false;
  return next < last - av_rescale_q(kRoundBack, kMicroseconds, time_base) ||
         next > last + av_rescale_q(kLongestPause, kMicroseconds, time_base);
}

std::vector<ClockPart> run_on(const AVFormatContext& container, AVRational time_base,
                              std::vector<MoviePacket>& packets) {
  if (!is_mpeg(container)) return {};
  const std::vector<std::size_t> begins = beginnings(time_base, packets);
  if (begins.size() == 1) return {};
  std::vector<ClockPart> parts{{}};
  const std::span<MoviePacket> all(packets);
  for (std::size_t i = 1; i < begins.size(); ++i) {
    const std::size_t begin = begins[i], end = i + 1 < begins.size() ? begins[i + 1] : packets.size();
    const auto before = all.subspan(begins[i - 1], begin - begins[i - 1]), part = all.subspan(begin, end - begin);
    hide_orphans(part, trust_last(before));
    const std::int64_t shift = shift_behind(before, step_of(before), part);
    const std::int64_t pos = std::max(parts.back().pos, part.front().pos);
    move(part, shift);
    parts.push_back({pos, av_rescale_q(shift, time_base, kMicroseconds)});
  }
  return parts;
}

/// Sound lies some way off its pictures in the file: where parts meet it is of the one that goes on best.
std::int64_t ClockFollower::shift_of(const Way& way, std::int64_t time, bool sound) const {
  auto here = std::ranges::upper_bound(parts_, way.pos, {}, &ClockPart::pos);
  if (here != parts_.begin()) --here;
  std::int64_t best = kSeamless, shift = here->shift;
  if (!sound || !is_known(way.end)) return shift;
  const auto first = here == parts_.begin() ? here : here - 1;
  const auto last = here + 1 == parts_.end() ? here : here + 1;
  for (auto part = first; part <= last; ++part) {
    const std::int64_t off = std::abs(time + part->shift - way.end);
    if (off >= best) continue;
    best = off;
    shift = part->shift;
  }
  return shift;
}

std::int64_t ClockFollower::shift_by_itself(const Way& way, std::int64_t time) const {
  if (!is_known(way.end)) return 0;
  const std::int64_t at = time + way.shift;
  const bool anew = at < way.begin - kRoundBack || (alone_ && at > way.end + kLongestPause);
  return anew ? way.end - time : way.shift;
}

bool ClockFollower::follow(AVPacket& packet, const AVStream& stream) {
  const bool sound = stream.codecpar->codec_type == AVMEDIA_TYPE_AUDIO;
  if (parts_.empty() && !sound) return true;
  Way& way = ways_[static_cast<std::size_t>(packet.stream_index)];
  if (packet.pos >= 0) way.pos = packet.pos;  // of several that lie together only the first one has it
  const std::int64_t stamp = is_known(packet.dts) ? packet.dts : packet.pts;
  if (!is_known(stamp)) return true;
  const std::int64_t time = av_rescale_q(stamp, stream.time_base, kMicroseconds);
  const std::int64_t shift = parts_.empty() ? shift_by_itself(way, time) : shift_of(way, time, sound);
  const std::int64_t moved = av_rescale_q(shift, kMicroseconds, stream.time_base);
  if (is_known(packet.pts)) packet.pts += moved;
  if (is_known(packet.dts)) packet.dts += moved;
  const std::int64_t length = av_rescale_q(packet.duration, stream.time_base, kMicroseconds), begin = time + shift;
  // Lengths alone are no reason where the clock runs on: some are guesses. Subtitles may lie over each other.
  const bool begins_alone = parts_.empty() || !sound;
  if (is_known(way.end) && begin < (begins_alone ? way.begin : way.end - length / 2 - 1)) return false;
  way.begin = begin;
  way.end = begin + length;
  way.shift = shift;
  return true;
}

void ClockFollower::resume(int stream, std::int64_t pos, std::int64_t time) {
  ways_[static_cast<std::size_t>(stream)] = {.pos = pos, .begin = time, .end = time};
}

}  // namespace afterglow

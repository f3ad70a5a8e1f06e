// SPDX-License-Identifier: MIT
#include "image/ffmpeg_copy.h"

extern "C" {
#include <libavutil/avutil.h>
#include <libavutil/dict.h>
#include <libavutil/mathematics.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "core/text.h"
#include "image/ffmpeg_facts.h"
#include "image/ffmpeg_index.h"
#include "image/ffmpeg_log.h"
#include "image/ffmpeg_opus_delay.h"

namespace afterglow {
namespace {

/// Containers with sound and subtitles. Playlists and the like would read other files.
constexpr const char* kFormats =
    "mov,mp4,matroska,webm,avi,mpegts,mpeg,ogg,flac,wav,w64,mp3,aac,ac3,eac3,aiff,caf,flv,mxf,opus,srt,ass,webvtt,gif,"
    "apng,yuv4mpegpipe,asf,nut,ivf,mpegvideo";

std::string stream_name(const AVStream& stream, unsigned index) {
  const char* kind = av_get_media_type_string(stream.codecpar->codec_type);
  return fmt::format("{} {} ({})", kind ? kind : "data", index + 1, avcodec_get_name(stream.codecpar->codec_id));
}

bool is_quicktime(const AVOutputFormat& format) {
  const std::string_view name = format.name;
  return name == "mov" || name == "mp4";
}

/// FFmpeg calls FLAC in MP4 an experiment, though it is written down since 2018 and players know it.
bool is_experiment(const AVOutputFormat& format, AVCodecID codec) {
  return codec == AV_CODEC_ID_FLAC && std::string_view(format.name) == "mp4";
}

/// MOV and MP4 refuse some kinds of sound no sooner than at their head.
bool head_takes(const AVOutputFormat& format, const AVStream& from) {
  AVFormatContext* trial = nullptr;
  if (avformat_alloc_output_context2(&trial, &format, nullptr, nullptr) < 0) return false;
  AVStream* to = avformat_new_stream(trial, nullptr);
  bool takes = to && avio_open_dyn_buf(&trial->pb) >= 0 && avcodec_parameters_copy(to->codecpar, from.codecpar) >= 0;
  if (takes) {
    to->codecpar->codec_tag = 0;
    to->time_base = from.time_base;
    if (is_experiment(format, from.codecpar->codec_id)) trial->strict_std_compliance = FF_COMPLIANCE_EXPERIMENTAL;
    takes = avformat_init_output(trial, nullptr) >= 0;
  }
  std::uint8_t* written = nullptr;
  if (trial->pb) avio_close_dyn_buf(trial->pb, &written);
  av_free(written);
  trial->pb = nullptr;
  avformat_free_context(trial);
  static_cast<void>(ffmpeg_said());
  return takes;
}

/// FFmpeg from 6.1 on writes PCM into MP4, and few players know it there.
bool is_unusual(const AVOutputFormat& format, AVCodecID codec) {
  return std::string_view(format.name) == "mp4" && std::string_view(avcodec_get_name(codec)).starts_with("pcm_");
}

bool can_hold(const AVOutputFormat& format, const AVStream& from) {
  const AVCodecParameters& parameters = *from.codecpar;
  if (is_unusual(format, parameters.codec_id)) return false;
  if (avformat_query_codec(&format, parameters.codec_id, FF_COMPLIANCE_NORMAL) != 1) return false;
  return parameters.codec_type != AVMEDIA_TYPE_AUDIO || !is_quicktime(format) || head_takes(format, from);
}

/// Told by something else in the output: timecodes by a tag, names of chapters by the chapters.
bool is_told_elsewhere(const AVStream& from) {
  const bool names_of_chapters =
      from.codecpar->codec_id == AV_CODEC_ID_BIN_DATA && from.discard == AVDISCARD_ALL;  // as FFmpeg reads QuickTime's
  return names_of_chapters || from.codecpar->codec_tag == MKTAG('t', 'm', 'c', 'd');
}

/// Fonts and the like, which Matroska holds by name and kind.
bool is_attachment(const AVOutputFormat& format, const AVStream& from) {
  return from.codecpar->codec_type == AVMEDIA_TYPE_ATTACHMENT && std::string_view(format.name) == "matroska" &&
         av_dict_get(from.metadata, "filename", nullptr, 0) && av_dict_get(from.metadata, "mimetype", nullptr, 0);
}

bool can_copy(const AVOutputFormat& format, const AVStream& from) {
  const AVMediaType kind = from.codecpar->codec_type;
  const bool known = kind == AVMEDIA_TYPE_AUDIO || kind == AVMEDIA_TYPE_SUBTITLE;
  return (known && can_hold(format, from)) || is_attachment(format, from);
}

/// Why sound of more channels is not encoded.
std::string most_channels(const AVOutputFormat& format) {
  const std::string_view name = format.name;
  const char* codec = name == "mp4" ? "AAC" : name == "webm" ? "Opus" : nullptr;
  return codec ? fmt::format(", and {} holds at most {} channels", codec, FfmpegSoundEncoder::kMostChannels) : "";
}

/// Streams that one message is about.
struct Named {
  std::vector<std::string> names;
  std::vector<const AVStream*> streams;

  bool one() const { return streams.size() == 1; }
  void add(const AVStream& stream, unsigned index) {
    names.push_back(stream_name(stream, index));
    streams.push_back(&stream);
  }
  /// "audio 2 (flac) of a.mkv is"
  std::string of(const std::filesystem::path& file) const {
    return fmt::format("{} of {} {}", join(names), file.string(), one() ? "is" : "are");
  }
  /// Containers that are written and take all of them: "; .mov, .mkv take it". Empty: none does.
  std::string takers() const {
    std::vector<std::string> found;
    for (const auto& [extension, muxer] :
         {std::pair(".mp4", "mp4"), {".mov", "mov"}, {".mkv", "matroska"}, {".webm", "webm"}}) {
      const AVOutputFormat* format = av_guess_format(muxer, nullptr, nullptr);
      if (format && std::ranges::all_of(streams, [&](const AVStream* each) { return can_copy(*format, *each); }))
        found.emplace_back(extension);
    }
    if (found.empty()) return "";
    return fmt::format("; {} {} {}", join(found), found.size() == 1 ? "takes" : "take", one() ? "it" : "them");
  }
};

void move(AVPacket& packet, std::int64_t microseconds, AVRational clock) {
  const std::int64_t by = av_rescale_q(microseconds, kMicroseconds, clock);
  if (packet.pts != AV_NOPTS_VALUE) packet.pts += by;
  if (packet.dts != AV_NOPTS_VALUE) packet.dts += by;
}

struct MpegClock {
  std::vector<ClockPart> parts;  ///< where it starts anew
  std::int64_t begin = 0;        ///< when the first picture shows; without pictures, when the sound begins
  bool pictures = false;         ///< there are some, and they are read
};

MpegClock clock_of(const std::filesystem::path& file, const AVFormatContext& input, const Patience& patience) {
  MpegClock clock{.parts = {}, .begin = input.start_time != AV_NOPTS_VALUE ? input.start_time : 0};
  if ((input.pb->seekable & AVIO_SEEKABLE_NORMAL) == 0) return clock;  // is read but once
  auto pictures = FfmpegInput::open(file, input.iformat->name, {}, patience);
  if (!pictures) return clock;
  auto index = index_movie(**pictures);
  if (!index || index->pts.empty()) return clock;
  const std::int64_t begin = av_rescale_q(index->pts.front(), (*pictures)->stream().time_base, kMicroseconds);
  return {std::move(index->parts), begin, true};
}

/// A range of the time since the clock's beginning.
void begin_at(std::int64_t begin, CopyRange& range) {
  using Limits = std::numeric_limits<long long>;
  range.shift += begin;
  if (range.begin != Limits::min()) range.begin += begin;
  if (range.end != Limits::max()) range.end += begin;
}

}  // namespace

FfmpegCopy::~FfmpegCopy() {
  if (input_) avformat_close_input(&input_);
}

Result<std::unique_ptr<FfmpegCopy>> FfmpegCopy::open(const std::filesystem::path& file, Copied what, bool encodes,
                                                     FfmpegOutput& output, const CopyRange& range,
                                                     const Patience& patience, const std::string& name,
                                                     Diagnostics& diagnostics) {
  std::unique_ptr<FfmpegCopy> copy(new FfmpegCopy(output));
  copy->file_ = file;
  copy->range_ = range;
  copy->encodes_ = encodes;
  AFTERGLOW_TRY(copy->bytes_, FfmpegBytes::open(file, patience));
  copy->input_ = copy->bytes_->container();
  if (!copy->input_) return Error{ErrorKind::io, "there is no memory to open it", file.string()};
  AVDictionary* options = nullptr;
  av_dict_set(&options, "format_whitelist", kFormats, 0);
  int code = avformat_open_input(&copy->input_, file.c_str(), nullptr, &options);  // the name tells of the format
  av_dict_free(&options);
  if (code < 0) return copy->cannot_be_read(code);
  code = avformat_find_stream_info(copy->input_, nullptr);
  if (code < 0 || copy->bytes_->given_up()) return copy->cannot_be_read(code);
  copy->follow_clock(what, patience);
  AFTERGLOW_CHECK(copy->add_streams(what, name, diagnostics));
  copy->cut_sound();
  if (what != Copied::sound) copy->add_chapters();
  return copy;
}

/// The clock of the source is known; that of another MPEG stream, which runs from anywhere, is found here.
void FfmpegCopy::follow_clock(Copied what, const Patience& patience) {
  MpegClock clock{.parts = range_.clock, .pictures = true};
  if (what == Copied::sound && is_mpeg(*input_)) {
    clock = clock_of(file_, *input_, patience);
    begin_at(clock.begin, range_);
  }
  clock_.emplace(std::move(clock.parts), input_->nb_streams, !clock.pictures);
}

Error FfmpegCopy::cannot_be_read(int code) const {
  if (auto reason = bytes_->given_up()) {
    reason->file = file_.string();
    return *std::move(reason);
  }
  return {ErrorKind::io, "cannot be read: " + ffmpeg_error(code), file_.string()};
}

/// As it is, or as other text or sound; null where the container holds none of it.
Result<AVStream*> FfmpegCopy::add_stream(unsigned index) {
  AVFormatContext& out = output_.container();
  const AVStream& from = *input_->streams[index];
  const AVMediaType kind = from.codecpar->codec_type;
  const bool held = can_copy(*out.oformat, from);
  if (!held && kind == AVMEDIA_TYPE_SUBTITLE) texts_[index] = FfmpegSubtitles::open(from, *out.oformat);
  if (!held && kind == AVMEDIA_TYPE_AUDIO && encodes_) sounds_[index] = FfmpegSoundEncoder::open(from, *out.oformat);
  const AVCodecContext* encoder = texts_[index]    ? &texts_[index]->encoder()
                                  : sounds_[index] ? &sounds_[index]->encoder()
                                                   : nullptr;
  if (!held && !encoder) return static_cast<AVStream*>(nullptr);
  AVStream* to = avformat_new_stream(&out, nullptr);
  const int code = !to       ? AVERROR(ENOMEM)
                   : encoder ? avcodec_parameters_from_context(to->codecpar, encoder)
                             : avcodec_parameters_copy(to->codecpar, from.codecpar);
  if (code < 0) return Error{ErrorKind::io, "cannot be written: " + ffmpeg_error(code)};
  if (is_experiment(*out.oformat, to->codecpar->codec_id)) out.strict_std_compliance = FF_COMPLIANCE_EXPERIMENTAL;
  to->codecpar->codec_tag = 0;
  to->time_base = sounds_[index] ? encoder->time_base : from.time_base;
  to->disposition = from.disposition;
  av_dict_copy(&to->metadata, from.metadata, 0);
  return to;
}

Result<void> FfmpegCopy::add_streams(Copied what, const std::string& name, Diagnostics& diagnostics) {
  AVFormatContext& out = output_.container();
  const bool sound_only = what == Copied::sound;
  Named left, pictures;
  std::map<std::string, Named> encoded;  // by the codec that they get
  bool too_many = false;
  const int worked_on = av_find_best_stream(input_, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  bool sound = false;
  target_.assign(input_->nb_streams, -1);
  texts_.resize(input_->nb_streams);
  sounds_.resize(input_->nb_streams);
  for (unsigned i = 0; i < input_->nb_streams; ++i) {
    const AVStream& from = *input_->streams[i];
    const AVMediaType kind = from.codecpar->codec_type;
    sound = sound || kind == AVMEDIA_TYPE_AUDIO;
    if (!sound_only && kind == AVMEDIA_TYPE_VIDEO && static_cast<int>(i) != worked_on) pictures.add(from, i);
    if (kind == AVMEDIA_TYPE_VIDEO || (sound_only && kind != AVMEDIA_TYPE_AUDIO) ||
        (what == Copied::all_but_sound && kind == AVMEDIA_TYPE_AUDIO))
      continue;
    AFTERGLOW_TRY(const AVStream* to, add_stream(i));
    if (!to && !is_told_elsewhere(from)) left.add(from, i);
    too_many =
        too_many || (!to && encodes_ && from.codecpar->ch_layout.nb_channels > FfmpegSoundEncoder::kMostChannels);
    if (!to) continue;
    target_[i] = to->index;
    if (sounds_[i]) encoded[avcodec_get_name(to->codecpar->codec_id)].add(from, i);
  }
  if (sound_only && !sound) return Error{ErrorKind::io, "has no sound", file_.string()};
  if (!sound_only) av_dict_copy(&out.metadata, input_->metadata, AV_DICT_DONT_OVERWRITE);
  if (!pictures.names.empty())
    diagnostics.warn(fmt::format("{}: of the pictures of {} one stream is worked on; {} {} left out", name,
                                 file_.string(), join(pictures.names), pictures.one() ? "is" : "are"));
  for (const auto& [codec, streams] : encoded)
    diagnostics.warn(fmt::format("{}: {} encoded as {}, since {} does not take {}{}{}", name, streams.of(file_), codec,
                                 out.oformat->name, streams.one() ? "it" : "them", streams.takers(),
                                 sound_only ? "" : "; --audio copy does not encode"));
  if (!left.names.empty())
    diagnostics.warn(fmt::format("{}: {} left out, since {} does not take {}{}{}", name, left.of(file_),
                                 out.oformat->name, left.one() ? "it" : "them",
                                 too_many ? most_channels(*out.oformat) : "", left.takers()));
  return {};
}

std::string FfmpegCopy::time_code() const { return first_time_code(*input_); }

void FfmpegCopy::describe_pictures(AVStream& to) const {
  const int index = av_find_best_stream(input_, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (index < 0) return;
  const AVStream& from = *input_->streams[index];
  to.disposition = from.disposition & ~AV_DISPOSITION_ATTACHED_PIC;
  for (const char* key : {"language", "title"})
    if (const AVDictionaryEntry* found = av_dict_get(from.metadata, key, nullptr, 0))
      av_dict_set(&to.metadata, key, found->value, 0);
}

/// As far as they lie in the range.
void FfmpegCopy::add_chapters() {
  AVFormatContext& out = output_.container();
  if (input_->nb_chapters == 0 || out.nb_chapters != 0) return;
  out.chapters = static_cast<AVChapter**>(av_calloc(input_->nb_chapters, sizeof(AVChapter*)));
  if (!out.chapters) return;
  for (unsigned i = 0; i < input_->nb_chapters; ++i) {
    const AVChapter& from = *input_->chapters[i];
    const auto at = [&](std::int64_t time) { return av_rescale_q(time, from.time_base, kMicroseconds); };
    const std::int64_t begin = std::max<std::int64_t>({at(from.start), range_.begin, range_.shift}),
                       end = std::min<std::int64_t>(at(from.end), range_.end);
    auto* to = begin < end ? static_cast<AVChapter*>(av_mallocz(sizeof(AVChapter))) : nullptr;
    if (!to) continue;
    to->id = from.id;
    to->time_base = kMicroseconds;
    to->start = begin - range_.shift;
    to->end = end - range_.shift;
    av_dict_copy(&to->metadata, from.metadata, 0);
    out.chapters[out.nb_chapters++] = to;
  }
}

/// When it begins. A text that shows already when the range begins is held to that, and one that shows on to its end.
std::int64_t FfmpegCopy::begin_of(AVPacket& packet, std::int64_t stamp) const {
  const AVStream& stream = *input_->streams[packet.stream_index];
  const AVRational unit = stream.time_base;
  const std::int64_t time = av_rescale_q(stamp, unit, kMicroseconds);
  if (stream.codecpar->codec_type != AVMEDIA_TYPE_SUBTITLE || packet.duration <= 0) return time;
  const std::int64_t end = time + av_rescale_q(packet.duration, unit, kMicroseconds);
  const std::int64_t begin = std::max(time, std::min<std::int64_t>(range_.begin, end));
  const std::int64_t until = std::min<std::int64_t>(end, range_.end);
  if (begin >= until || (begin == time && until == end)) return time;
  packet.pts = packet.dts = av_rescale_q(begin, kMicroseconds, unit);
  packet.duration = av_rescale_q(until - begin, kMicroseconds, unit);
  return begin;
}

Result<void> FfmpegCopy::put(AVPacket& packet) {
  const AVStream& from = *input_->streams[packet.stream_index];
  const auto stream = static_cast<std::size_t>(packet.stream_index);
  const AVStream& to = *output_.container().streams[target_[stream]];
  // In the finer of both clocks: that of MP3 in AVI, say, counts packets alone.
  const bool before = av_cmp_q(from.time_base, to.time_base) < 0;
  if (before) move(packet, -range_.shift, from.time_base);
  av_packet_rescale_ts(&packet, from.time_base, to.time_base);
  if (!before) move(packet, -range_.shift, to.time_base);
  return write(packet, stream);
}

/// Files of MP3 begin behind what their decoder needs first.
void FfmpegCopy::cut_sound() {
  const bool late = std::string_view(input_->iformat->name) == "mp3" && input_->start_time != AV_NOPTS_VALUE;
  late_ = late ? input_->start_time : 0;
  const std::int64_t end = range_.end;
  for (const auto& sound : sounds_)
    if (sound) sound->cut(range_.shift + late_, end < INT64_MAX - late_ ? end + late_ : INT64_MAX);
}

/// By the clock of the output.
Result<void> FfmpegCopy::write(AVPacket& packet, std::size_t stream) const {
  AVFormatContext& out = output_.container();
  const AVStream& to = *out.streams[target_[stream]];
  const AVCodecParameters& codec = *to.codecpar;
  if (const std::int64_t delay = missing_opus_delay(*out.oformat, codec); delay > 0)
    move(packet, av_rescale_q(delay, {1, codec.sample_rate}, kMicroseconds), to.time_base);
  packet.stream_index = to.index;
  packet.pos = -1;
  return output_.write(packet);
}

FfmpegSoundEncoder::Put FfmpegCopy::put_sound(std::size_t stream) const {
  return [this, stream](AVPacket& packet) {
    const AVStream& to = *output_.container().streams[target_[stream]];
    av_packet_rescale_ts(&packet, sounds_[stream]->encoder().time_base, to.time_base);
    return write(packet, stream);
  };
}

Result<void> FfmpegCopy::finish() {
  for (std::size_t i = 0; i < sounds_.size(); ++i)
    if (sounds_[i]) AFTERGLOW_CHECK(sounds_[i]->finish(put_sound(i)));
  return {};
}

/// Reads up to a packet that is held by the output, by the clock that runs on. False: the end.
Result<bool> FfmpegCopy::wait_for_next() {
  waiting_.reset(av_packet_alloc());
  if (!waiting_) return Error{ErrorKind::io, "cannot be written: no memory"};
  while (true) {
    av_packet_unref(waiting_.get());
    const int code = av_read_frame(input_, waiting_.get());
    if (code < 0) {
      ended_ = true;
      if (code == AVERROR_EOF && !bytes_->given_up()) return false;
      return cannot_be_read(code);
    }
    bytes_->packet_came();
    const auto stream = static_cast<std::size_t>(waiting_->stream_index);
    const bool held = stream < target_.size() && target_[stream] >= 0;
    if (held && clock_->follow(*waiting_, *input_->streams[stream])) return true;
  }
}

/// The next packet of this stream is later than `until`.
Result<void> FfmpegCopy::wait(std::size_t stream, std::int64_t next, std::int64_t until) const {
  return sounds_[stream] ? sounds_[stream]->wait(next, until, put_sound(stream)) : Result<void>();
}

Result<void> FfmpegCopy::copy(std::int64_t until) {
  while (!ended_) {
    if (!waiting_) {
      AFTERGLOW_TRY(const bool more, wait_for_next());
      if (!more) return {};
    }
    const auto stream = static_cast<std::size_t>(waiting_->stream_index);
    const std::int64_t stamp = waiting_->dts != AV_NOPTS_VALUE ? waiting_->dts : waiting_->pts;
    if (stamp != AV_NOPTS_VALUE) {
      constexpr std::int64_t kFarthest = kFarthestSound * AV_TIME_BASE;
      const std::int64_t time = std::clamp(begin_of(*waiting_, stamp), -kFarthest, kFarthest);
      const bool heard = sounds_[stream] != nullptr;  // its decoder needs what comes before the range, too
      if ((time >= range_.begin || heard) && time - (heard ? late_ : 0) < range_.end) {
        if (time - range_.shift >= until) return wait(stream, time - range_.shift, until);
        if (heard) {
          AFTERGLOW_CHECK(sounds_[stream]->convert(*waiting_, put_sound(stream)));
        } else if (!texts_[stream] || texts_[stream]->convert(*waiting_))
          AFTERGLOW_CHECK(put(*waiting_));
      }
    }
    waiting_.reset();
  }
  return {};
}

}  // namespace afterglow

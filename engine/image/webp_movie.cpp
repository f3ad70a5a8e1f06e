// SPDX-License-Identifier: MIT
#include "image/webp_movie.h"

#include <fmt/format.h>
#include <webp/demux.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <vector>

#include "core/file.h"
#include "image/container_bytes.h"

namespace afterglow {
namespace {

constexpr int kMostFrames = 1'000'000;

struct WebpDeleter {
  void operator()(WebPDemuxer* demuxer) const { WebPDemuxDelete(demuxer); }
  void operator()(WebPAnimDecoder* decoder) const { WebPAnimDecoderDelete(decoder); }
};

/// Cuts off what is no whole chunk, and says so in the head, since the library takes whole files alone. True if there
/// was something to cut.
bool cut_to_whole_chunks(std::string& bytes) {
  constexpr std::size_t kHead = 12, kChunkHead = 8;  // "RIFF" SIZE "WEBP"; NAME SIZE
  if (bytes.size() < kHead) return false;
  const auto number_at = [&](std::size_t at) {
    return std::size_t{little_endian(reinterpret_cast<const unsigned char*>(&bytes[at]), 4)};
  };
  const std::size_t told = number_at(4) + kChunkHead;
  std::size_t end = kHead;
  while (end + kChunkHead <= std::min(told, bytes.size())) {
    const std::size_t size = number_at(end + 4), padded = kChunkHead + size + size % 2;
    if (padded > bytes.size() - end) break;
    end += padded;
  }
  const bool cut = end < told;
  bytes.resize(end);
  put_ordered(reinterpret_cast<unsigned char*>(&bytes[4]), 4, end - kChunkHead, false);
  return cut;
}

class WebpMovie : public MovieSource {
 public:
  Result<void> open(const MovieRequest& request) {
    cache_bytes_ = movie_cache_bytes(request.limits.max_bytes);
    AFTERGLOW_TRY(bytes_, read_file(request.file, request.limits.max_bytes));
    const bool cut = cut_to_whole_chunks(bytes_);
    data_ = {reinterpret_cast<const std::uint8_t*>(bytes_.data()), bytes_.size()};
    AFTERGLOW_CHECK(look_at_frames(request, cut));
    WebPAnimDecoderOptions options;
    if (WebPAnimDecoderOptionsInit(&options) == 0) return Error{ErrorKind::io, "libwebp is of another version"};
    options.color_mode = MODE_RGBA;
    options.use_threads = 1;
    decoder_.reset(WebPAnimDecoderNew(&data_, &options));
    if (!decoder_) return Error{ErrorKind::io, "is a damaged WebP file, or there is no memory to decode it"};
    return {};
  }

  Result<void> read(int frame, float* rgba, std::size_t row_stride) override {
    const auto whole = static_cast<int>(facts_.pts.size() - facts_.missing);
    if (frame >= whole) return Error{ErrorKind::io, "is missing: the file ends before it"};
    const std::lock_guard lock(mutex_);
    AFTERGLOW_TRY(const std::vector<std::uint8_t>* codes, decoded(frame));
    const auto width = static_cast<std::size_t>(facts_.size.width);
    for (std::size_t y = 0; y < static_cast<std::size_t>(facts_.size.height); ++y)
      for (std::size_t i = 0; i < width * 4; ++i)
        rgba[y * row_stride + i] = static_cast<float>((*codes)[y * width * 4 + i]) / 255;
    return {};
  }

 private:
  /// Canvas, times and alpha, without a decode.
  Result<void> look_at_frames(const MovieRequest& request, bool cut) {
    const std::unique_ptr<WebPDemuxer, WebpDeleter> demuxer(WebPDemux(&data_));
    if (!demuxer) return Error{ErrorKind::io, cut ? "is truncated before its first frame" : "is a damaged WebP file"};
    facts_.container = facts_.codec = "webp";
    facts_.pixel_format = "rgba";
    facts_.pictures_alone = true;
    facts_.stored = facts_.size = {static_cast<int>(WebPDemuxGetI(demuxer.get(), WEBP_FF_CANVAS_WIDTH)),
                                   static_cast<int>(WebPDemuxGetI(demuxer.get(), WEBP_FF_CANVAS_HEIGHT))};
    AFTERGLOW_CHECK(check_sides({0, 0, facts_.size.width, facts_.size.height}, "canvas", request.limits, request.file));
    facts_.color = {.primaries = 1, .transfer = 13, .matrix = 0, .full_range = true, .rgb = true, .picture = true};
    facts_.time_base = {1, 1000};
    const long long end = add_frames(*demuxer);
    if (facts_.pts.empty()) return Error{ErrorKind::io, "has no frame (truncated?)"};
    const auto frames = static_cast<int>(facts_.pts.size());
    if (frames > kMostFrames) return Error{ErrorKind::io, fmt::format("has more than {} frames", kMostFrames)};
    if (end > 0 && end <= 2'000'000) facts_.rate = {frames * 1000, static_cast<int>(end)};
    if (cut) {
      facts_.missing = 1;
      facts_.pts.push_back(end);
    }
    return {};
  }

  /// Whether the canvas may let light through from this frame on, which was opaque before. The file's own mark is set
  /// already where a frame leaves out what has not changed.
  bool makes_holes(const WebPIterator& frame) const {
    const bool first = facts_.pts.empty();
    const bool covers = frame.width == facts_.size.width && frame.height == facts_.size.height;
    return (first && !covers) || (frame.has_alpha != 0 && (first || frame.blend_method == WEBP_MUX_NO_BLEND)) ||
           frame.dispose_method == WEBP_MUX_DISPOSE_BACKGROUND;
  }
  /// Milliseconds. Who writes none means what browsers show.
  static int length_of(const WebPIterator& frame) {
    constexpr int kUsual = 100;
    return frame.duration > 0 ? frame.duration : kUsual;
  }
  /// When the last one ends.
  long long add_frames(WebPDemuxer& demuxer) {
    long long at = 0;
    WebPIterator frame;
    for (int more = WebPDemuxGetFrame(&demuxer, 1, &frame); more != 0; more = WebPDemuxNextFrame(&frame)) {
      facts_.has_alpha = facts_.has_alpha || makes_holes(frame);
      facts_.pts.push_back(at);
      facts_.last_length = length_of(frame);
      at += facts_.last_length;
    }
    WebPDemuxReleaseIterator(&frame);
    return at;
  }

  /// Frames are built on those before: from the last one, or from the beginning.
  Result<const std::vector<std::uint8_t>*> decoded(int frame) {
    if (const auto found = cache_.find(frame); found != cache_.end()) return &found->second;
    if (frame < next_) {
      WebPAnimDecoderReset(decoder_.get());
      next_ = 0;
    }
    while (next_ <= frame) {
      std::uint8_t* canvas = nullptr;
      int ends = 0;
      if (WebPAnimDecoderGetNext(decoder_.get(), &canvas, &ends) == 0)
        return Error{ErrorKind::io, next_ == frame ? "cannot be decoded: it is damaged"
                                                   : fmt::format("is built on frame {}, which is damaged", next_ + 1)};
      keep(next_++, canvas);
    }
    return &cache_.at(frame);
  }

  void keep(int frame, const std::uint8_t* canvas) {
    const auto bytes = static_cast<std::size_t>(facts_.size.area()) * 4;
    while (!cache_.empty() && (cache_.size() + 1) * bytes > cache_bytes_) {
      // The one that is furthest away from where decoding is.
      const auto first = cache_.begin(), last = std::prev(cache_.end());
      cache_.erase(frame - first->first > last->first - frame ? first : last);
    }
    cache_.insert_or_assign(frame, std::vector<std::uint8_t>(canvas, canvas + bytes));
  }

  std::string bytes_;
  WebPData data_{};
  std::mutex mutex_;
  std::unique_ptr<WebPAnimDecoder, WebpDeleter> decoder_;
  int next_ = 0;                   ///< that the decoder gives next
  std::uint64_t cache_bytes_ = 0;  ///< of decoded frames, for going backwards
  std::map<int, std::vector<std::uint8_t>> cache_;
};

}  // namespace

Result<std::shared_ptr<MovieSource>> open_webp_movie(const MovieRequest& request) {
  auto movie = std::make_shared<WebpMovie>();
  auto opened = movie->open(request);
  if (opened) return std::shared_ptr<MovieSource>(std::move(movie));
  Error error = std::move(opened).error();
  if (error.file.empty()) error.file = request.file.string();
  return error;
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "image/exr_lines.h"

#include <OpenEXR/ImfCompression.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <functional>
#include <memory>
#include <stdexcept>
#include <thread>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "core/file_time.h"
#include "core/half.h"
#include "core/large_pages.h"
#include "core/parallel.h"
#include "core/spares.h"
#include "image/exr_zip.h"

namespace afterglow {
namespace {

/// Of lines that are fetched before they are unpacked side by side.
constexpr std::size_t kFetchedBytes = 4 << 20;

/// The samples of one channel in one line, as floats that lie side by side.
void take_samples(const std::uint8_t* stored, ExrChannelType type, std::size_t width, float* to) {
  if (type == ExrChannelType::half) {
    floats_from_halves(stored, width, to);
  } else {
    std::memcpy(to, stored, width * sizeof(float));
  }
}

/// Channels that go to neighbouring floats of the same pixels are written together.
struct TargetGroup {
  float* base = nullptr;
  std::size_t pixel_stride = 1, row_stride = 0;
  std::vector<std::size_t> channels;

  bool goes_on_with(const ExrLineTarget& target) const {
    return channels.size() < 4 && target.pixel_stride == pixel_stride && target.row_stride == row_stride &&
           target.base == base + channels.size() && channels.size() < pixel_stride;
  }
};

std::vector<TargetGroup> grouped(std::span<const ExrLineTarget> targets) {
  std::vector<TargetGroup> groups;
  for (const ExrLineTarget& target : targets) {
    if (groups.empty() || !groups.back().goes_on_with(target))
      groups.push_back({target.base, target.pixel_stride, target.row_stride, {}});
    groups.back().channels.push_back(target.channel);
  }
  return groups;
}

#if defined(__x86_64__)
/// Four pixels of three or four channels at a time; how many pixels that were.
std::size_t interleave_quads(const float* lines, std::size_t lanes, std::size_t width, float* pixels) {
  if (lanes < 3) return 0;
  const __m128 taken = _mm_castsi128_ps(_mm_set_epi32(lanes == 4 ? -1 : 0, -1, -1, -1));
  std::size_t x = 0;
  for (; x + 4 <= width; x += 4, pixels += 16) {
    __m128 a = _mm_loadu_ps(lines + x), b = _mm_loadu_ps(lines + width + x), c = _mm_loadu_ps(lines + 2 * width + x);
    __m128 d = lanes == 4 ? _mm_loadu_ps(lines + 3 * width + x) : _mm_setzero_ps();
    _MM_TRANSPOSE4_PS(a, b, c, d);
    const auto put = [&](float* pixel, __m128 value) {
      _mm_storeu_ps(pixel, _mm_or_ps(_mm_and_ps(taken, value), _mm_andnot_ps(taken, _mm_loadu_ps(pixel))));
    };
    put(pixels, a), put(pixels + 4, b), put(pixels + 8, c), put(pixels + 12, d);
  }
  return x;
}
#endif

/// Lines of `lanes` channels, one after the other, into pixels of `stride` floats; what lies between them stays.
void interleave(const float* lines, std::size_t lanes, std::size_t width, float* pixels, std::size_t stride) {
  std::size_t first = 0;
#if defined(__x86_64__)
  if (stride == 4) first = interleave_quads(lines, lanes, width, pixels);
#endif
  for (std::size_t c = 0; c < lanes; ++c)
    for (std::size_t x = first; x < width; ++x) pixels[x * stride + c] = lines[c * width + x];
}

/// Half floats of four channels into pixels of RGBA; without the last one alpha is 1.
void interleave_halves(const std::array<const std::uint8_t*, 4>& channels, std::size_t width, std::uint16_t* rgba) {
  std::size_t x = 0;
#if defined(__x86_64__)
  const auto eight = [&](std::size_t c) {
    if (!channels[c]) return _mm_set1_epi16(kOneAsHalf);
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(channels[c] + 2 * x));
  };
  for (; x + 8 <= width; x += 8) {
    const __m128i r = eight(0), g = eight(1), b = eight(2), a = eight(3);
    auto* to = reinterpret_cast<__m128i*>(rgba + 4 * x);
    const __m128i rg = _mm_unpacklo_epi16(r, g), ba = _mm_unpacklo_epi16(b, a);
    const __m128i rg_high = _mm_unpackhi_epi16(r, g), ba_high = _mm_unpackhi_epi16(b, a);
    _mm_storeu_si128(to, _mm_unpacklo_epi32(rg, ba));
    _mm_storeu_si128(to + 1, _mm_unpackhi_epi32(rg, ba));
    _mm_storeu_si128(to + 2, _mm_unpacklo_epi32(rg_high, ba_high));
    _mm_storeu_si128(to + 3, _mm_unpackhi_epi32(rg_high, ba_high));
  }
#endif
  for (; x < width; ++x)
    for (std::size_t c = 0; c < 4; ++c) {
      if (channels[c]) {
        std::memcpy(rgba + 4 * x + c, channels[c] + 2 * x, sizeof(std::uint16_t));
      } else {
        rgba[4 * x + c] = kOneAsHalf;
      }
    }
}

/// Where the channels begin in a line; behind them, where it ends.
std::vector<std::size_t> channel_offsets(const ExrPart& part) {
  std::vector<std::size_t> offsets{0};
  for (const ExrChannel& channel : part.channels)
    offsets.push_back(offsets.back() + static_cast<std::size_t>(part.data_window.width) * channel.sample_bytes());
  return offsets;
}

/// What is done with line y, counted from the data window's top. Called on several threads.
using TakeLine = std::function<void(int y, const std::uint8_t* line)>;

class LineReader {
 public:
  LineReader(Imf::InputPart& input, const ExrPart& part, const TakeLine& take, const RowsArrived& rows)
      : input_(input),
        part_(part),
        take_(take),
        rows_(rows),
        line_bytes_(channel_offsets(part).back()),
        lines_(part.chunk_lines()) {}

  /// Chunks are fetched one by one, as files are read best, and unpacked side by side.
  void run() {
    const int chunks = static_cast<int>(part_.chunks());
    const int threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 16u));
    const int chunk_bytes = static_cast<int>(std::min<std::size_t>(line_bytes_ * lines_, kFetchedBytes));
    const int most =
        std::min(chunks, std::max(2 * threads, static_cast<int>(kFetchedBytes) / std::max(chunk_bytes, 1)));
    // In one piece: asking the system for each is what readers that work side by side wait for.
    const std::size_t room = chunk_room(), unpacking = static_cast<std::size_t>(std::min(kMostRanges, most));
    const std::size_t bytes = room * (static_cast<std::size_t>(most) + 2 * unpacking);
    const auto memory = std::make_unique_for_overwrite<std::uint8_t[]>(bytes);
    use_large_pages(memory.get(), bytes);
    std::vector<Packed> packed(static_cast<std::size_t>(most));
    for (std::size_t i = 0; i < packed.size(); ++i) packed[i].bytes = memory.get() + i * room;
    std::atomic<std::uint8_t*> rest = memory.get() + packed.size() * room;
    Spares<Unpacker> unpackers;
    for (int first = 0; first < chunks; first += most) {
      const int count = std::min(most, chunks - first);
      {
        const FileTime time;
        for (int i = 0; i < count; ++i) fetch(first + i, packed[static_cast<std::size_t>(i)]);
      }
      const long long samples = static_cast<long long>(line_bytes_) * lines_ * count;
      parallel_rows(count, samples, [&](int begin, int end) {
        const auto unpacker = unpackers.borrow([&] {
          std::uint8_t* const own = rest.fetch_add(static_cast<std::ptrdiff_t>(2 * room));
          return std::make_unique<Unpacker>(own, own + room);
        });
        for (int i = begin; i < end; ++i) unpack(first + i, packed[static_cast<std::size_t>(i)], *unpacker);
      });
    }
  }

 private:
  /// A chunk as the file has it.
  struct Packed {
    std::uint8_t* bytes = nullptr;  ///< room for one that is stored as it is
    std::size_t size = 0;
  };
  /// What a thread needs for one chunk after the other.
  struct Unpacker {
    Unpacker(std::uint8_t* bytes_in, std::uint8_t* apart_in) : bytes(bytes_in), apart(apart_in) {}
    ExrUnzip unzip;
    std::uint8_t *bytes, *apart;  ///< room for one each
  };

  int lines_of(int chunk) const { return std::min(lines_, part_.data_window.height - chunk * lines_); }
  std::size_t chunk_room() const { return line_bytes_ * static_cast<std::size_t>(lines_); }

  void fetch(int chunk, Packed& packed) {
    const std::size_t most =
        line_bytes_ * static_cast<std::size_t>(lines_of(chunk));  // what does not get shorter is stored as it is
    int size = static_cast<int>(most);
    input_.rawPixelDataToBuffer(part_.data_window.y + chunk * lines_, reinterpret_cast<char*>(packed.bytes), size);
    if (size < 0 || static_cast<std::size_t>(size) > most) throw damaged(chunk);
    packed.size = static_cast<std::size_t>(size);
  }

  void unpack(int chunk, const Packed& packed, Unpacker& unpacker) const {
    const std::size_t length = line_bytes_ * static_cast<std::size_t>(lines_of(chunk));
    const std::uint8_t* stored = packed.bytes;
    if (packed.size != length) {
      stored = unpacker.bytes;
      if (!unpacker.unzip.run({packed.bytes, packed.size}, {unpacker.bytes, length}, {unpacker.apart, length}))
        throw damaged(chunk);
    }
    for (int y = 0; y < lines_of(chunk); ++y, stored += line_bytes_) take_(chunk * lines_ + y, stored);
    if (rows_) rows_(chunk * lines_, chunk * lines_ + lines_of(chunk));
  }

  std::runtime_error damaged(int chunk) const {
    return std::runtime_error(fmt::format("the lines from {} on are damaged", part_.data_window.y + chunk * lines_));
  }

  Imf::InputPart& input_;
  const ExrPart& part_;
  const TakeLine& take_;
  const RowsArrived& rows_;
  std::size_t line_bytes_;
  int lines_;
};

}  // namespace

bool has_zipped_lines(const ExrPart& part, std::span<const ExrLineTarget> targets) {
  if (part.tiled || part.deep || targets.empty()) return false;
  if (part.compression != Imf::ZIP_COMPRESSION && part.compression != Imf::ZIPS_COMPRESSION) return false;
  return std::ranges::all_of(part.channels,
                             [](const ExrChannel& c) { return c.x_sampling == 1 && c.y_sampling == 1; }) &&
         std::ranges::none_of(targets, [&](const ExrLineTarget& target) {
           return part.channels[target.channel].type == ExrChannelType::uint32;
         });
}

void read_zipped_lines(Imf::InputPart& input, const ExrPart& part, std::span<const ExrLineTarget> targets,
                       const RowsArrived& rows) {
  const std::vector<TargetGroup> groups = grouped(targets);
  const std::vector<std::size_t> offsets = channel_offsets(part);
  const auto width = static_cast<std::size_t>(part.data_window.width);
  const TakeLine take = [&](int y, const std::uint8_t* stored) {
    thread_local std::vector<float> lines;
    lines.resize(width * 4);
    for (const TargetGroup& group : groups) {
      float* out = group.base + static_cast<std::size_t>(y) * group.row_stride;
      float* line = group.pixel_stride == 1 ? out : lines.data();
      for (std::size_t i = 0; i < group.channels.size(); ++i)
        take_samples(stored + offsets[group.channels[i]], part.channels[group.channels[i]].type, width,
                     line + i * width);
      if (line != out) interleave(line, group.channels.size(), width, out, group.pixel_stride);
    }
  };
  LineReader(input, part, take, rows).run();
}

void read_zipped_halves(Imf::InputPart& input, const ExrPart& part, const ExrHalfTarget& target,
                        const RowsArrived& rows) {
  const std::vector<std::size_t> offsets = channel_offsets(part);
  const auto width = static_cast<std::size_t>(part.data_window.width);
  const TakeLine take = [&](int y, const std::uint8_t* stored) {
    std::array<const std::uint8_t*, 4> channels{};
    for (std::size_t c = 0; c < 4; ++c)
      if (target.channels[c]) channels[c] = stored + offsets[*target.channels[c]];
    interleave_halves(channels, width, target.rgba + static_cast<std::size_t>(y) * width * 4);
  };
  LineReader(input, part, take, rows).run();
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "image/exr_lines.h"

#include <OpenEXR/ImfCompression.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "core/file_time.h"
#include "core/parallel.h"
#include "image/encode.h"
#include "image/exr_zip.h"

namespace afterglow {
namespace {

/// Of lines that are fetched before they are unpacked side by side, which starts threads.
constexpr std::size_t kFetchedBytes = 4 << 20;

/// The samples of one channel in one line.
void take_samples(const std::uint8_t* stored, ExrChannelType type, std::size_t width, std::vector<float>& line,
                  float* base, std::size_t stride) {
  float* to = stride == 1 ? base : line.data();
  if (type == ExrChannelType::half) {
    from_half(stored, to, width);
  } else {
    std::memcpy(to, stored, width * sizeof(float));
  }
  if (stride == 1) return;
  for (std::size_t x = 0; x < width; ++x) base[x * stride] = to[x];
}

class LineReader {
 public:
  LineReader(Imf::InputPart& input, const ExrPart& part, std::span<const ExrLineTarget> targets)
      : input_(input),
        part_(part),
        targets_(targets),
        width_(static_cast<std::size_t>(part.data_window.width)),
        lines_(part.chunk_lines()) {
    for (const ExrChannel& channel : part.channels) {
      offsets_.push_back(line_bytes_);
      line_bytes_ += width_ * channel.sample_bytes();
    }
  }

  /// Chunks are fetched one by one, as files are read best, and unpacked side by side.
  void run() {
    const int chunks = static_cast<int>(part_.chunks());
    const int threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 16u));
    const int chunk_bytes = static_cast<int>(std::min<std::size_t>(line_bytes_ * lines_, kFetchedBytes));
    const int most =
        std::min(chunks, std::max(2 * threads, static_cast<int>(kFetchedBytes) / std::max(chunk_bytes, 1)));
    std::vector<std::vector<std::uint8_t>> packed(static_cast<std::size_t>(most));
    for (int first = 0; first < chunks; first += most) {
      const int count = std::min(most, chunks - first);
      {
        const FileTime time;
        for (int i = 0; i < count; ++i) fetch(first + i, packed[static_cast<std::size_t>(i)]);
      }
      const long long samples = static_cast<long long>(line_bytes_) * lines_ * count;
      parallel_rows(count, samples, [&](int begin, int end) {
        ExrUnzip unzip;
        std::vector<std::uint8_t> bytes(line_bytes_ * static_cast<std::size_t>(lines_));
        std::vector<float> line(width_);
        for (int i = begin; i < end; ++i) unpack(first + i, packed[static_cast<std::size_t>(i)], unzip, bytes, line);
      });
    }
  }

 private:
  int lines_of(int chunk) const { return std::min(lines_, part_.data_window.height - chunk * lines_); }

  void fetch(int chunk, std::vector<std::uint8_t>& packed) {
    packed.resize(line_bytes_ *
                  static_cast<std::size_t>(lines_of(chunk)));  // what does not get shorter is stored as it is
    int size = static_cast<int>(packed.size());
    input_.rawPixelDataToBuffer(part_.data_window.y + chunk * lines_, reinterpret_cast<char*>(packed.data()), size);
    if (size < 0 || static_cast<std::size_t>(size) > packed.size()) throw damaged(chunk);
    packed.resize(static_cast<std::size_t>(size));
  }

  void unpack(int chunk, std::span<const std::uint8_t> packed, ExrUnzip& unzip, std::vector<std::uint8_t>& bytes,
              std::vector<float>& line) const {
    const std::size_t length = line_bytes_ * static_cast<std::size_t>(lines_of(chunk));
    const std::uint8_t* stored = packed.data();
    if (packed.size() != length) {
      if (!unzip.run(packed, {bytes.data(), length})) throw damaged(chunk);
      stored = bytes.data();
    }
    for (int y = 0; y < lines_of(chunk); ++y, stored += line_bytes_)
      for (const ExrLineTarget& target : targets_)
        take_samples(stored + offsets_[target.channel], part_.channels[target.channel].type, width_, line,
                     target.base + static_cast<std::size_t>(chunk * lines_ + y) * target.row_stride,
                     target.pixel_stride);
  }

  std::runtime_error damaged(int chunk) const {
    return std::runtime_error(fmt::format("the lines from {} on are damaged", part_.data_window.y + chunk * lines_));
  }

  Imf::InputPart& input_;
  const ExrPart& part_;
  std::span<const ExrLineTarget> targets_;
  std::size_t width_, line_bytes_ = 0;
  std::vector<std::size_t> offsets_;  // of channels within a line
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

void read_zipped_lines(Imf::InputPart& input, const ExrPart& part, std::span<const ExrLineTarget> targets) {
  LineReader(input, part, targets).run();
}

}  // namespace afterglow

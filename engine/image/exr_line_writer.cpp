// SPDX-License-Identifier: MIT
#include "image/exr_line_writer.h"

#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <thread>

#include "core/parallel.h"
#include "image/exr_dwa.h"
#include "image/exr_header.h"
#include "image/exr_zip.h"

namespace afterglow {
namespace {

constexpr std::size_t kOldNames = 31;           // longest name that readers of the first version know
constexpr int kLinesTogether = 128;             // packed before they are written: of ZIPS, whose chunks are short
constexpr std::size_t kWorthAThread = 1 << 17;  // bytes

bool has_long_names(const Imf::Header& header) {
  for (auto it = header.begin(); it != header.end(); ++it)
    if (std::strlen(it.name()) > kOldNames || std::strlen(it.attribute().typeName()) > kOldNames) return true;
  const Imf::ChannelList& channels = header.channels();
  for (auto it = channels.begin(); it != channels.end(); ++it)
    if (std::strlen(it.name()) > kOldNames) return true;
  return false;
}

bool is_zip(const Imf::Header& header) {
  return header.compression() == Imf::ZIP_COMPRESSION || header.compression() == Imf::ZIPS_COMPRESSION;
}

std::unique_ptr<ExrPacker> make_packer(const Imf::Header& header) {
  if (is_zip(header)) return std::make_unique<ExrZip>(header.zipCompressionLevel());
  return std::make_unique<ExrDwa>(header);
}

template <class Number>
void put(OutputFile& out, Number value) {
  std::uint8_t bytes[sizeof(Number)];
  for (std::size_t i = 0; i < sizeof(Number); ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
  out.write(bytes, sizeof bytes);
}

}  // namespace

bool can_pack_lines(const Imf::Header& header) {
  if (!is_zip(header) && !has_dwa_lines(header)) return false;
  if (header.lineOrder() != Imf::INCREASING_Y || header.hasTileDescription()) return false;
  const Imf::ChannelList& channels = header.channels();
  for (auto it = channels.begin(); it != channels.end(); ++it)
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1) return false;
  return true;
}

std::size_t channel_place(const Imf::Header& header, const std::string& name) {
  const auto width = static_cast<std::size_t>(header.dataWindow().max.x - header.dataWindow().min.x + 1);
  const Imf::ChannelList& channels = header.channels();
  std::size_t place = 0;
  for (auto it = channels.begin(); it != channels.end() && it.name() != name; ++it)
    place += width * (it.channel().type == Imf::HALF ? 2 : 4);
  return place;
}

ExrLineWriter::ExrLineWriter(const Imf::Header& header, OutputFile& out) : out_(out) {
  header.sanityCheck();
  const Imath::Box2i& window = header.dataWindow();
  top_ = window.min.y;
  height_ = window.max.y - window.min.y + 1;
  lines_ = chunk_lines_of(header.compression());
  line_bytes_ = channel_place(header, {});  // no channel has this name: all of them

  put(out_, static_cast<std::uint32_t>(Imf::MAGIC));
  put(out_, static_cast<std::uint32_t>(Imf::EXR_VERSION | (has_long_names(header) ? Imf::LONG_NAMES_FLAG : 0)));
  ExrOutput stream(out_, "");
  header.writeTo(stream);
  offsets_at_ = out_.position();
  const std::vector<std::uint8_t> room(static_cast<std::size_t>((height_ + lines_ - 1) / lines_) *
                                       sizeof(std::uint64_t));
  out_.write(room.data(), room.size());

  const int threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 16u));
  const int together = lines_ > kLinesTogether ? threads : std::max(4 * threads, kLinesTogether / lines_);
  together_.resize(static_cast<std::size_t>(together));
  for (int i = 0; i < threads; ++i) packers_.push_back(make_packer(header));
}

int ExrLineWriter::lines_of(int chunk) const { return std::min(lines_, height_ - chunk * lines_); }

void ExrLineWriter::pack(int number, Chunk& chunk, ExrPacker& packer, const FillLine& fill) const {
  chunk.bytes.resize(line_bytes_ * static_cast<std::size_t>(lines_of(number)));
  std::uint8_t* line = chunk.bytes.data();
  for (int i = 0; i < lines_of(number); ++i, line += line_bytes_) fill(number * lines_ + i, line);
  chunk.stored = packer.run(chunk.bytes, chunk.packed);
}

void ExrLineWriter::write(int count, const FillLine& fill) {
  const std::size_t first = offsets_.size(), end = first + static_cast<std::size_t>((count + lines_ - 1) / lines_);
  for (std::size_t begin = first; begin < end && !out_.failure(); begin = offsets_.size()) {
    const std::size_t chunks = std::min(end - begin, together_.size());
    const std::size_t bytes = line_bytes_ * static_cast<std::size_t>(lines_) * chunks;
    std::atomic<std::size_t> next = 0;
    parallel_for(std::clamp<std::size_t>(bytes / kWorthAThread, 1, std::min(packers_.size(), chunks)),
                 [&](std::size_t t) {
                   for (std::size_t i = next++; i < chunks; i = next++)
                     pack(static_cast<int>(begin + i), together_[i], *packers_[t], fill);
                 });
    for (std::size_t i = 0; i < chunks; ++i) {
      const auto& stored = together_[i].stored;
      offsets_.push_back(out_.position());
      put(out_, static_cast<std::uint32_t>(top_ + static_cast<int>(begin + i) * lines_));
      put(out_, static_cast<std::uint32_t>(stored.size()));
      out_.write(stored.data(), stored.size());
    }
  }
}

void ExrLineWriter::finish() {
  const std::uint64_t end = out_.position();
  out_.seek(offsets_at_);
  for (const std::uint64_t offset : offsets_) put(out_, offset);
  out_.seek(end);
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "image/write_png.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "core/parallel.h"
#include "core/text.h"
#include "image/metadata.h"
#include "image/output_metadata.h"
#include "image/png_filter.h"
#include "image/strips.h"

namespace afterglow {
namespace {

constexpr std::size_t kStripBytes =
    1 << 19;  // of samples: long enough that the seams cost nothing, short enough to share out

void put_number(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
}

void write_chunk(OutputFile& out, const char* type, const void* data, std::size_t size) {
  std::string head;
  put_number(head, static_cast<std::uint32_t>(size));
  head += type;
  uLong sum = crc32(0, reinterpret_cast<const Bytef*>(type), 4);
  if (size > 0) sum = crc32(sum, static_cast<const Bytef*>(data), static_cast<uInt>(size));
  std::string tail;
  put_number(tail, static_cast<std::uint32_t>(sum));
  out.write(head.data(), head.size());
  if (size > 0) out.write(data, size);
  out.write(tail.data(), tail.size());
}
void write_chunk(OutputFile& out, const char* type, const std::string& data) {
  write_chunk(out, type, data.data(), data.size());
}

void write_resolution(OutputFile& out, const Metadata& metadata) {
  const auto number = [&](const char* name) {
    const MetadataValue* value = find_metadata(metadata, name);
    return value ? metadata_number(*value, 0) : 0.0f;
  };
  double x = number("XResolution"), y = number("YResolution");
  const MetadataValue* unit_value = find_metadata(metadata, "ResolutionUnit");
  const std::string unit = unit_value ? lower(metadata_text(*unit_value)) : "";
  const double per_metre = unit.starts_with("in") ? 1 / 0.0254 : unit.starts_with("cm") ? 100 : unit == "m" ? 1 : 0;
  if (per_metre == 0) {
    // No unit: only the shape of a pixel, which is y to x.
    const double ratio = number("PixelAspectRatio");
    if (!(ratio > 0.01 && ratio < 100) || ratio == 1) return;
    x = 1000;
    y = 1000 * ratio;
  } else {
    x *= per_metre;
    y *= per_metre;
  }
  if (!(x >= 1 && y >= 1 && x < 1e9 && y < 1e9)) return;
  std::string data;
  put_number(data, static_cast<std::uint32_t>(std::lround(x)));
  put_number(data, static_cast<std::uint32_t>(std::lround(y)));
  write_chunk(out, "pHYs", data + (per_metre == 0 ? '\0' : '\1'));
}

/// Registered keywords, and the names that readers give them.
std::string keyword_of(const std::string& name) {
  if (name == "ImageDescription") return "Description";
  if (name == "Artist") return "Author";
  if (name == "DocumentName") return "Title";
  return name;
}

bool printable(const std::string& text, bool newlines) {
  return std::all_of(text.begin(), text.end(),
                     [&](unsigned char c) { return (c >= 32 && c < 127) || (newlines && (c == '\n' || c == '\t')); });
}

/// "YYYY:MM:DD hh:mm:ss" has a chunk of its own.
bool write_time(OutputFile& out, const std::string& text) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
  if (std::sscanf(text.c_str(), "%4d:%2d:%2d %2d:%2d:%2d", &year, &month, &day, &hour, &minute, &second) != 6)
    return false;
  const auto inside = [](int value, int low, int high) { return value >= low && value <= high; };
  if (!inside(year, 1, 9999) || !inside(month, 1, 12) || !inside(day, 1, 31) || !inside(hour, 0, 23) ||
      !inside(minute, 0, 59) || !inside(second, 0, 60))
    return false;
  std::string data{static_cast<char>(year >> 8)};
  for (const int value : {year & 255, month, day, hour, minute, second}) data += static_cast<char>(value);
  write_chunk(out, "tIME", data);
  return true;
}

void write_texts(OutputFile& out, const Metadata& metadata) {
  for (const auto& [name, value] : metadata) {
    const auto* text = std::get_if<std::string>(&value);
    if (!text || name == "ResolutionUnit" || (name == "DateTime" && write_time(out, *text))) continue;
    const std::string keyword = keyword_of(name);
    if (keyword.empty() || keyword.size() > 79 || !printable(keyword, false) || keyword.front() == ' ' ||
        keyword.back() == ' ')
      continue;
    if (text->find('\0') != std::string::npos) continue;
    if (printable(*text, true)) {
      write_chunk(out, "tEXt", keyword + '\0' + *text);
    } else {
      write_chunk(out, "iTXt",
                  keyword + std::string(5, '\0') + *text);  // UTF-8, not compressed, no language, no translation
    }
  }
}

void write_header(const Picture& picture, const StripForm& form, OutputFile& out) {
  out.write("\x89PNG\r\n\x1a\n", 8);
  std::string head;
  put_number(head, static_cast<std::uint32_t>(picture.display_window.width));
  put_number(head, static_cast<std::uint32_t>(picture.display_window.height));
  head += {static_cast<char>(form.type == SampleType::uint16 ? 16 : 8), static_cast<char>(form.alpha ? 6 : 2), 0, 0, 0};
  write_chunk(out, "IHDR", head);
  if (!form.space) {
    write_chunk(out, "sRGB", std::string(1, '\1'));  // relative colorimetric
    std::string gamma;
    put_number(gamma, 45455);
    write_chunk(out, "gAMA", gamma);
  }
  if (!picture.facts) return;
  const Metadata metadata = kept_metadata(*picture.facts);
  write_resolution(out, metadata);
  write_texts(out, metadata);
}

/// One strip of rows: filtered, and compressed as a piece of a deflate stream that ends on a byte.
struct Strip {
  int first = 0, rows = 0;
  bool last = false;
  std::vector<std::uint8_t> compressed;
  uLong adler = 0;
  std::size_t filtered = 0;
  int failure = Z_OK;
};

class StripEncoder {
 public:
  StripEncoder(const Picture& picture, StripForm form, int level)
      : picture_(picture),
        form_(form),
        row_bytes_(form.row_bytes(picture)),
        pixel_((form.alpha ? 4 : 3) * form.sample_bytes()),
        level_(level) {}

  int rows_per_strip() const { return static_cast<int>(std::clamp<std::size_t>(kStripBytes / row_bytes_, 1, 4096)); }

  void run(Strip& strip) const {
    // The row above is needed to filter the first one.
    const int lead = strip.first > 0 ? 1 : 0;
    std::vector<std::uint8_t> samples(row_bytes_ * static_cast<std::size_t>(strip.rows + lead)),
        scratch(4 * row_bytes_);
    encode_rows(picture_, form_, strip.first - lead, strip.rows + lead, samples.data());
    if (form_.type == SampleType::uint16)
      for (std::size_t i = 0; i + 1 < samples.size(); i += 2)
        std::swap(samples[i], samples[i + 1]);  // PNG is big-endian
    std::vector<std::uint8_t> filtered((row_bytes_ + 1) * static_cast<std::size_t>(strip.rows));
    for (int i = 0; i < strip.rows; ++i) {
      const std::uint8_t* row = samples.data() + row_bytes_ * static_cast<std::size_t>(i + lead);
      png_filter_row(row, i + lead > 0 ? row - row_bytes_ : nullptr, row_bytes_, pixel_, scratch.data(),
                     filtered.data() + (row_bytes_ + 1) * static_cast<std::size_t>(i));
    }
    strip.filtered = filtered.size();
    strip.adler = adler32(adler32(0, nullptr, 0), filtered.data(), static_cast<uInt>(filtered.size()));
    deflate_strip(filtered, strip);
  }

 private:
  void deflate_strip(std::vector<std::uint8_t>& filtered, Strip& strip) const {
    z_stream stream{};
    constexpr int kRaw = -15, kMemory = 9;
    strip.failure = deflateInit2(&stream, level_, Z_DEFLATED, kRaw, kMemory, Z_FILTERED);
    if (strip.failure != Z_OK) return;
    strip.compressed.resize(deflateBound(&stream, static_cast<uLong>(filtered.size())) + 16);
    stream.next_in = filtered.data();
    stream.avail_in = static_cast<uInt>(filtered.size());
    stream.next_out = strip.compressed.data();
    stream.avail_out = static_cast<uInt>(strip.compressed.size());
    const int ended = deflate(&stream, strip.last ? Z_FINISH : Z_FULL_FLUSH);
    if (ended != (strip.last ? Z_STREAM_END : Z_OK) || stream.avail_in != 0) strip.failure = Z_BUF_ERROR;
    strip.compressed.resize(strip.compressed.size() - stream.avail_out);
    deflateEnd(&stream);
  }

  const Picture& picture_;
  StripForm form_;
  std::size_t row_bytes_, pixel_;
  int level_;
};

/// Works on all strips of a batch, on as many threads.
void run_batch(const StripEncoder& encoder, std::vector<Strip>& batch) {
  constexpr long long kWorthAThread = 1ll << 32;
  parallel_rows(static_cast<int>(batch.size()), kWorthAThread, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) encoder.run(batch[static_cast<std::size_t>(i)]);
  });
}

}  // namespace

Result<void> write_png(const Picture& picture, const StripForm& form, OutputFile& out, int level) {
  write_header(picture, form, out);
  const StripEncoder encoder(picture, form, std::clamp(level, 0, 9));
  const int height = picture.display_window.height, rows = encoder.rows_per_strip();
  const int threads = static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 16u));
  uLong adler = adler32(0, nullptr, 0);
  for (int y = 0; y < height && !out.failure();) {
    std::vector<Strip> batch;
    for (; y < height && static_cast<int>(batch.size()) < threads; y += rows) {
      const int count = std::min(rows, height - y);
      batch.push_back({y, count, y + count == height, {}, 0, 0, Z_OK});
    }
    run_batch(encoder, batch);
    for (const Strip& strip : batch) {
      if (strip.failure != Z_OK)
        return Error{ErrorKind::io, fmt::format("cannot be written: compression failed ({})", zError(strip.failure))};
      adler = adler32_combine(adler, strip.adler, static_cast<z_off_t>(strip.filtered));
      std::string data;
      if (strip.first == 0) data += "\x78\x01";  // a zlib stream with a window of 32 KiB
      data.append(reinterpret_cast<const char*>(strip.compressed.data()), strip.compressed.size());
      if (strip.last) put_number(data, static_cast<std::uint32_t>(adler));
      write_chunk(out, "IDAT", data);
    }
  }
  write_chunk(out, "IEND", "");
  return {};
}

}  // namespace afterglow

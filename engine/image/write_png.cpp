// SPDX-License-Identifier: MIT
#include "image/write_png.h"

#include <libdeflate.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/spares.h"
#include "core/text.h"
#include "image/deflate.h"
#include "image/kept_values.h"
#include "image/metadata.h"
#include "image/output_metadata.h"
#include "image/output_space.h"
#include "image/png_filter.h"
#include "image/strips.h"

namespace afterglow {
namespace {

constexpr std::size_t kChunkBytes = 1 << 20;  // readers check the sum of a chunk once they have all of it

void put_number(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
}

void write_chunk(OutputFile& out, const char* type, const void* data, std::size_t size) {
  std::string head;
  put_number(head, static_cast<std::uint32_t>(size));
  head += type;
  std::string tail;
  put_number(tail, libdeflate_crc32(libdeflate_crc32(0, type, 4), data, size));
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
    const std::string number = is_kept_as_text(name) ? text_of_number(value) : "";
    const auto* text = number.empty() ? std::get_if<std::string>(&value) : &number;
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

/// What is not to be taken for sRGB: by the numbers of ITU-T H.273 where it has such, else as power and primaries.
void write_space(const OutputSpace& space, OutputFile& out) {
  if (!must_be_told(space)) return;
  const auto [primaries, transfer] = space_codes(space);
  if (primaries != SpaceCodes{}.primaries && transfer != SpaceCodes{}.transfer)
    return write_chunk(out, "cICP", {static_cast<char>(primaries), static_cast<char>(transfer), '\0', '\1'});
  constexpr std::uint32_t kAdobeGamma = 45471;  // 256/563
  std::string gamma, chromaticities;
  put_number(gamma, kAdobeGamma);
  const Chromaticities& p = space.primaries();
  for (const auto& xy : {p.white, p.red, p.green, p.blue})
    for (const double v : xy) put_number(chromaticities, static_cast<std::uint32_t>(std::lround(v * 100000)));
  write_chunk(out, "gAMA", gamma);
  write_chunk(out, "cHRM", chromaticities);
}

void write_header(const Picture& picture, const StripForm& form, OutputFile& out) {
  out.write("\x89PNG\r\n\x1a\n", 8);
  std::string head;
  put_number(head, static_cast<std::uint32_t>(picture.display_window.width));
  put_number(head, static_cast<std::uint32_t>(picture.display_window.height));
  head += {static_cast<char>(form.type == SampleType::uint16 ? 16 : 8), static_cast<char>(form.alpha ? 6 : 2), 0, 0, 0};
  write_chunk(out, "IHDR", head);
  if (!form.space && !form.view) {
    write_chunk(out, "sRGB", std::string(1, '\1'));  // relative colorimetric
    std::string gamma;
    put_number(gamma, 45455);
    write_chunk(out, "gAMA", gamma);
  }
  if (form.space && !form.view) write_space(*form.space, out);
  if (!picture.facts) return;
  const Metadata metadata = kept_metadata(*picture.facts);
  write_resolution(out, metadata);
  write_texts(out, metadata);
}

/// What a thread needs to filter rows.
struct FilterRoom {
  static constexpr int kRows = 16;  ///< that are encoded at a time
  explicit FilterRoom(std::size_t row_bytes) : rows((1 + kRows) * row_bytes), scratch(4 * row_bytes) {}
  std::vector<std::uint8_t> rows;  ///< the first: above the others
  std::vector<std::uint8_t> scratch;
};

/// Rows [begin, end), each behind the number of its filter.
void filter_rows(const Picture& picture, const StripForm& form, int begin, int end, FilterRoom& room,
                 std::uint8_t* filtered) {
  const std::size_t row_bytes = form.row_bytes(picture), pixel = (form.alpha ? 4 : 3) * form.sample_bytes();
  const auto encode = [&](int y, int rows, std::uint8_t* samples) {
    encode_rows(picture, form, y, rows, samples);
    if (form.type == SampleType::uint16)
      for (std::size_t i = 0; i + 1 < row_bytes * static_cast<std::size_t>(rows); i += 2)
        std::swap(samples[i], samples[i + 1]);  // PNG is big-endian
  };
  auto& [rows, scratch] = room;
  if (begin > 0) encode(begin - 1, 1, rows.data());
  for (int y = begin; y < end;) {
    const int count = std::min(FilterRoom::kRows, end - y);
    encode(y, count, &rows[row_bytes]);
    const std::uint8_t* row = rows.data();
    for (int i = 0; i < count; ++i, ++y) {
      row += row_bytes;
      png_filter_row(row, y > 0 ? row - row_bytes : nullptr, row_bytes, pixel, scratch.data(), filtered);
      filtered += row_bytes + 1;
    }
    std::copy_n(row, row_bytes, rows.data());
  }
}

void write_data(OutputFile& out, std::span<const std::uint8_t> packed) {
  for (std::size_t i = 0; i < packed.size() && !out.failure(); i += kChunkBytes)
    write_chunk(out, "IDAT", &packed[i], std::min(kChunkBytes, packed.size() - i));
}

Error no_room() { return {ErrorKind::other, "PNG: what was packed is longer than it can be"}; }

/// What a thread needs for one strip after the other.
struct StripPacker {
  StripPacker(int level, std::size_t row_bytes, std::size_t strip_bytes)
      : deflate(level), room(row_bytes), filtered(std::make_unique_for_overwrite<std::uint8_t[]>(strip_bytes)) {}
  Deflate deflate;
  FilterRoom room;
  std::unique_ptr<std::uint8_t[]> filtered;
};

/// Strips of rows are filtered and packed by several threads.
Result<void> write_strips(const Picture& picture, const StripForm& form, OutputFile& out, int level,
                          WorkMemory& memory) {
  constexpr std::size_t kStripBytes = 512 << 10;
  const std::size_t row = form.row_bytes(picture) + 1;
  const int height = picture.display_window.height;
  const int rows = static_cast<int>(std::clamp<std::size_t>(kStripBytes / row, 1, static_cast<std::size_t>(height)));
  struct Strip {
    std::size_t bytes = 0, packed = 0;
    std::uint32_t sum = 0;
  };
  std::vector<Strip> strips(static_cast<std::size_t>((height + rows - 1) / rows));
  const std::size_t strip_bytes = row * static_cast<std::size_t>(rows);
  const std::size_t room = Deflate::bound(strip_bytes);
  WorkMemory::Block block = memory.take(room * strips.size());
  const auto place = [&](std::size_t i) { return std::span(block.bytes.get() + room * i, room); };
  Spares<StripPacker> packers;
  parallel_rows(static_cast<int>(strips.size()), static_cast<long long>(row) * height, [&](int begin, int end) {
    const auto packer =
        packers.borrow([&] { return std::make_unique<StripPacker>(level, form.row_bytes(picture), strip_bytes); });
    for (int i = begin; i < end; ++i) {
      Strip& strip = strips[static_cast<std::size_t>(i)];
      const int first = i * rows, last = std::min(first + rows, height);
      filter_rows(picture, form, first, last, packer->room, packer->filtered.get());
      strip.bytes = row * static_cast<std::size_t>(last - first);
      const std::span bytes(packer->filtered.get(), strip.bytes);
      strip.sum = adler32_of(bytes);
      strip.packed = packer->deflate.piece(bytes, last == height, place(static_cast<std::size_t>(i)));
    }
  });
  write_chunk(out, "IDAT", kStreamHead, sizeof kStreamHead);
  std::uint32_t sum = 1;
  for (std::size_t i = 0; i < strips.size(); ++i) {
    if (strips[i].packed == 0) return no_room();
    write_data(out, place(i).first(strips[i].packed));
    sum = adler32_of(sum, strips[i].sum, strips[i].bytes);
  }
  std::string end;
  put_number(end, sum);
  write_chunk(out, "IDAT", end);
  memory.give(std::move(block));
  return {};
}

Result<void> write_whole(const Picture& picture, const StripForm& form, OutputFile& out, int level,
                         WorkMemory& memory) {
  const std::size_t row = form.row_bytes(picture) + 1;
  const int height = picture.display_window.height;
  const std::size_t size = row * static_cast<std::size_t>(height);
  Deflate deflate(level);
  const std::size_t room = Deflate::bound(size);
  WorkMemory::Block block = memory.take(size + room);
  const std::span filtered(block.bytes.get(), size), packed(block.bytes.get() + size, room);
  parallel_rows(height, static_cast<long long>(size), [&](int begin, int end) {
    FilterRoom scratch(form.row_bytes(picture));
    filter_rows(picture, form, begin, end, scratch, &filtered[row * static_cast<std::size_t>(begin)]);
  });
  const std::size_t length = deflate.stream(filtered, packed);
  if (length == 0) return no_room();
  write_data(out, packed.first(length));
  memory.give(std::move(block));
  return {};
}

}  // namespace

Result<void> write_png(const Picture& picture, const StripForm& form, OutputFile& out, int level, WorkMemory* memory) {
  write_header(picture, form, out);
  WorkMemory own;
  level = std::clamp(level, 0, 9);
  const auto write = Deflate::makes_pieces(level) ? write_strips : write_whole;
  AFTERGLOW_CHECK(write(picture, form, out, level, memory ? *memory : own));
  write_chunk(out, "IEND", "");
  return {};
}

}  // namespace afterglow

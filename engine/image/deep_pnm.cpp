// SPDX-License-Identifier: MIT
#include "image/deep_pnm.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/ascii.h"
#include "image/container_bytes.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr int kMostOfBit = 1, kMostOfByte = 255, kMostOfPnm = 65535;

/// The next number of text, behind white space and comments.
std::optional<int> next_number(std::istream& in) {
  constexpr int kLargest = 100'000'000;
  int c = in.get();
  while (c == '#' || c == ' ' || (c >= '\t' && c <= '\r')) {
    if (c == '#')
      while (c != '\n' && c != '\r' && in) c = in.get();
    c = in.get();
  }
  if (!in || !is_digit(static_cast<char>(c))) return std::nullopt;
  int value = 0;
  for (; in && is_digit(static_cast<char>(c)); c = in.get()) value = std::min(value * 10 + (c - '0'), kLargest);
  return value;  // one character behind it is taken too
}

Result<std::vector<float>> ends_too_early(const fs::path& file) {
  return malformed(file, "is damaged: it ends before its last pixel");
}

}  // namespace

Result<std::optional<DeepPnm>> deep_pnm(const fs::path& file, std::ifstream& in, std::uint64_t file_size) {
  in.clear();
  in.seekg(0);
  const int p = in.get(), kind = in.get();
  if (p != 'P' || (kind != '2' && kind != '3' && kind != '5' && kind != '6')) return std::optional<DeepPnm>();
  const auto width = next_number(in), height = next_number(in), most = next_number(in);
  if (!width || !height || !most) return std::optional<DeepPnm>();  // OpenImageIO says what is wrong
  if (*most < 1 || *most > kMostOfPnm)
    return malformed(file, fmt::format("says that {} is its largest value; a PNM has 1 to {}", *most, kMostOfPnm));
  if (*most == kMostOfBit || *most == kMostOfByte || *width < 1 || *height < 1) return std::optional<DeepPnm>();
  DeepPnm form{{*width, *height}, kind == '3' || kind == '6' ? 3 : 1, *most, kind < '5'};
  form.data_at = static_cast<std::uint64_t>(in.tellg());
  // Of text, a digit and what parts it from the next one.
  const std::uint64_t bytes = form.text ? 2 : form.sample_bytes();
  if (file_size + 1 < form.data_at + bytes * form.samples()) return ends_too_early(file).error();
  return std::optional(form);
}

Result<std::vector<float>> read_deep_pnm(const fs::path& file, const DeepPnm& form) {
  std::ifstream in(file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(form.data_at));
  std::vector<float> samples(form.samples());
  const auto value = [&](int code) {
    return static_cast<float>(std::min(code, form.most)) / static_cast<float>(form.most);
  };
  if (form.text) {
    for (float& sample : samples) {
      const auto code = next_number(in);
      if (!code) return ends_too_early(file);
      sample = value(*code);
    }
    return samples;
  }
  const std::size_t row = static_cast<std::size_t>(form.size.width) * static_cast<std::size_t>(form.channels);
  const std::size_t size = form.sample_bytes();
  std::vector<unsigned char> bytes(size * row);
  for (std::size_t at = 0; at < samples.size(); at += row) {
    if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
      return ends_too_early(file);
    for (std::size_t i = 0; i < row; ++i)
      samples[at + i] = value(size == 1 ? bytes[i] : bytes[2 * i] << 8 | bytes[2 * i + 1]);
  }
  return samples;
}

}  // namespace afterglow

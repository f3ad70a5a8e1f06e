// SPDX-License-Identifier: MIT
#include "clips.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

namespace afterglow {
namespace {

constexpr int kBits = 12, kBarsHeight = 32;

/// Bars of the number's bits, the highest first, and behind each its opposite: a picture of another kind says nothing.
bool bar(int number, int x) {
  const int place = x * kBits * 2 / kClipWidth;
  return ((number >> (kBits - 1 - place / 2) & 1) != 0) != (place % 2 != 0);
}

std::uint8_t code(double v) { return static_cast<std::uint8_t>(std::lround(255 * std::min(std::max(v, 0.0), 1.0))); }

}  // namespace

void Clips::SetUp() {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  folder_ = std::filesystem::temp_directory_path() / fmt::format("afterglow_video_{}_{}", info->name(), getpid());
  std::filesystem::create_directories(folder_);
}

void Clips::TearDown() { std::filesystem::remove_all(folder_); }

std::string Clips::numbered_frames(int count, int first, bool alpha) const {
  const std::string file = path(fmt::format("frames{}_{}{}.raw", first, count, alpha ? "a" : ""));
  std::ofstream out(file, std::ios::binary);
  std::vector<std::uint8_t> row;
  for (int number = first; number < first + count; ++number)
    for (int y = 0; y < kClipHeight; ++y) {
      row.clear();
      for (int x = 0; x < kClipWidth; ++x) {
        if (y < kBarsHeight) {
          row.insert(row.end(), 3, bar(number, x) ? 235 : 16);
        } else {
          const double u = (x + 3.0 * number) / 40, v = (y - number) / 23.0;
          for (const double phase : {0.0, 1.0, 2.1}) row.push_back(code(0.5 + 0.4 * std::sin(u + phase) * std::cos(v)));
        }
        if (alpha) row.push_back(y < kBarsHeight ? 255 : code((x + 0.5) / kClipWidth));
      }
      out.write(reinterpret_cast<const char*>(row.data()), static_cast<std::streamsize>(row.size()));
    }
  return file;
}

void Clips::ffmpeg(const std::string& arguments) const {
  const std::string log = path("ffmpeg.log");
  const std::string command =
      fmt::format("ffmpeg -hide_banner -nostdin -loglevel error -y {} >'{}' 2>&1", arguments, log);
  if (std::system(command.c_str()) == 0) return;
  std::ifstream in(log);
  FAIL() << command << "\n" << std::string(std::istreambuf_iterator<char>(in), {});
}

std::string Clips::clip(const std::string& name, const std::string& arguments, int count, bool alpha) const {
  const std::string raw = numbered_frames(count, 1, alpha);
  ffmpeg(fmt::format("-f rawvideo -pix_fmt {} -s {}x{} -r 24 -i '{}' {} '{}'", alpha ? "rgba" : "rgb24", kClipWidth,
                     kClipHeight, raw, arguments, path(name)));
  return path(name);
}

Result<std::shared_ptr<Movie>> Clips::try_open(const std::string& file) {
  Diagnostics diagnostics([this](Severity, const std::string& text) { messages_.push_back(text); });
  return Movie::open(file, {}, diagnostics);
}

std::shared_ptr<Movie> Clips::open(const std::string& file) {
  auto movie = try_open(file);
  if (movie) return *movie;
  ADD_FAILURE() << movie.error().text();
  return nullptr;
}

Result<Picture> Clips::read(const std::shared_ptr<Movie>& movie, int frame) {
  ReadOptions options;
  options.movie = movie;
  options.movie_frame = frame;
  Diagnostics quiet;
  return read_picture(movie->file(), options, quiet);
}

Hash Clips::hash_of(const std::shared_ptr<Movie>& movie, int frame) {
  auto picture = read(movie, frame);
  if (!picture) {
    ADD_FAILURE() << picture.error().text();
    return {};
  }
  note_content(*picture);
  return picture->content.at("source");
}

std::vector<int> Clips::numbers_by_ffmpeg(const std::string& file) const {
  const std::string raw = path("decoded.raw");
  ffmpeg(fmt::format("-i '{}' -vsync passthrough -f rawvideo -pix_fmt rgb24 '{}'", file, raw));
  std::ifstream in(raw, std::ios::binary);
  std::vector<int> numbers;
  std::vector<char> bytes(static_cast<std::size_t>(kClipWidth) * kClipHeight * 3);
  while (in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    Picture picture;
    picture.color = Image(kClipWidth, kClipHeight, 4);
    for (std::size_t i = 0; i < bytes.size() / 3; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        picture.color.pixels[i * 4 + c] = static_cast<float>(static_cast<std::uint8_t>(bytes[i * 3 + c])) / 255;
    numbers.push_back(number_of(picture));
  }
  return numbers;
}

int Clips::number_of(const Picture& picture) {
  const Image& image = picture.color;
  int number = 0;
  for (int bit = 0; bit < kBits; ++bit) {
    const auto light = [&](int place) {
      const int x = (2 * place + 1) * image.width / (kBits * 4);
      return image.at(x, kBarsHeight / 2 * image.height / kClipHeight)[1];
    };
    const float one = light(2 * bit), other = light(2 * bit + 1);
    if (std::abs(one - other) < 0.2f) return -1;
    number = number << 1 | (one > other ? 1 : 0);
  }
  return number;
}

}  // namespace afterglow

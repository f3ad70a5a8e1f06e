// SPDX-License-Identifier: MIT
#include "files.h"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "image/writer.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

struct Folder {
  fs::path path;
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "afterglow-effects-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    path = pattern;
  }
  ~Folder() {
    std::error_code ec;
    fs::remove_all(path, ec);
  }
};

}  // namespace

const fs::path& test_files() {
  static const Folder folder;
  return folder.path;
}

fs::path write_test_file(const std::string& name, const std::string& text) {
  const fs::path file = test_files() / name;
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

reference::DoubleImage write_test_picture(const std::string& name, Size size, double light) {
  Picture picture;
  picture.color = Image(size.width, size.height, 4);
  picture.has_alpha = true;
  picture.data_window = picture.display_window = {0, 0, size.width, size.height};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const int i = (y * 7 + x * 5) % 9;
      float* p = &picture.color.pixels[4 * (static_cast<std::size_t>(y) * size.width + x)];
      p[3] = static_cast<float>(i) / 8;
      for (int c = 0; c < 3; ++c) p[c] = p[3] * static_cast<float>(light * ((i * (c + 2) + x) % 5) / 4);
    }
  Diagnostics diagnostics;
  if (!write_picture(picture, test_files() / name, {.type = SampleType::float32}, diagnostics))
    throw std::runtime_error("a picture for tests could not be written");
  return reference::from_floats(picture.color.pixels.data(), size, 4);
}

}  // namespace afterglow

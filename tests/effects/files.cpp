// SPDX-License-Identifier: MIT
#include "files.h"

#include <cstdlib>
#include <fstream>
#include <stdexcept>

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

}  // namespace afterglow

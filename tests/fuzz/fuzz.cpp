// SPDX-License-Identifier: MIT
#include "fuzz.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <system_error>

namespace afterglow::fuzz {
namespace fs = std::filesystem;
namespace {

struct Scratch {
  fs::path path = fs::temp_directory_path() / ("afterglow_fuzz_" + std::to_string(getpid()));
  Scratch() { fs::create_directories(path); }
  ~Scratch() {
    std::error_code ec;
    fs::remove_all(path, ec);
  }
};

}  // namespace

const fs::path& scratch() {
  static const Scratch folder;
  return folder.path;
}

fs::path write(const std::string& name, std::string_view bytes) {
  const fs::path file = scratch() / name;
  std::error_code ec;
  fs::create_directories(file.parent_path(), ec);
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

std::vector<NamedText> split_files(std::string_view input) {
  static constexpr std::string_view kMark = "=== ";
  std::vector<NamedText> files{{"", {}}};
  std::size_t begin = 0;
  for (std::size_t at = 0; at < input.size();) {
    const std::size_t end = std::min(input.find('\n', at), input.size());
    const std::string_view line = input.substr(at, end - at);
    const std::size_t next = std::min(end + 1, input.size());
    if (line.starts_with(kMark)) {
      files.back().text = input.substr(begin, at - begin);
      files.push_back({std::string(line.substr(kMark.size())), {}});
      begin = next;
    }
    at = next;
  }
  files.back().text = input.substr(begin);
  return files;
}

void broken(const char* claim, const std::string& detail) {
  std::fprintf(stderr, "broken claim: %s\n%s\n", claim, detail.c_str());
  std::abort();
}

void check_error(const Error& error, std::initializer_list<ErrorKind> kinds) {
  FUZZ_CLAIM(std::find(kinds.begin(), kinds.end(), error.kind) != kinds.end(), error.text());
  FUZZ_CLAIM(!error.message.empty(), error.text());
  FUZZ_CLAIM(error.line >= 0, error.text());
  Error line = error;  // without the lines behind it
  line.trail.clear();
  const std::string text = line.text();
  const auto control = [](unsigned char c) { return c < 0x20 || c == 0x7F; };
  FUZZ_CLAIM(std::none_of(text.begin(), text.end(), control), text);
  FUZZ_CLAIM(text.size() < 20'000, text);
}

}  // namespace afterglow::fuzz

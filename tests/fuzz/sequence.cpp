// SPDX-License-Identifier: MIT
// Frame lists and patterns of numbered files.
#include "image/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "fuzz.h"
#include "image/reader.h"

using namespace afterglow;

namespace {

constexpr std::size_t kMostFrames = 1'000'000;  // as image/sequence.h says

void check_frames(const std::string& text) {
  const auto frames = parse_frames(text);
  if (!frames) return fuzz::check_error(frames.error(), {ErrorKind::usage});
  FUZZ_CLAIM(!frames->empty() && frames->size() <= kMostFrames, text);
  if (frames->size() > 10'000) return;
  FUZZ_CLAIM(std::set<int>(frames->begin(), frames->end()).size() == frames->size(), text);
}

/// Lists of a million frames take a quarter of a second under the sanitizers: one input in sixteen may have one.
bool may_take_long(const std::string& text) {
  int digits = 0, most = 0;
  for (const char c : text) {
    digits = c >= '0' && c <= '9' ? digits + 1 : 0;
    most = std::max(most, digits);
  }
  return most > 5 && text.size() % 16 != 0;
}

void make_frames() {
  static const bool made = [] {
    for (const char* name : {"shot.0001.exr", "shot.0002.exr", "shot.12.exr", "shot.-3.exr", "shot.99999999999.exr",
                             "plain7.png", "a%d.exr"})
      fuzz::write(name, "");
    return true;
  }();
  (void)made;
}

void check_pattern(const std::string& text) {
  make_frames();
  const auto pattern = parse_pattern(text);
  if (!pattern) return fuzz::check_error(pattern.error(), {ErrorKind::usage});
  for (const int frame : {-3, 0, 1, 12, 2147483647}) {
    const std::string name = pattern->file(frame).string();
    FUZZ_CLAIM(name.starts_with(pattern->prefix) && name.ends_with(pattern->suffix), name);
  }
  const auto found = find_frames(*pattern, std::nullopt);
  if (!found) return fuzz::check_error(found.error(), {ErrorKind::io, ErrorKind::usage});
  for (std::size_t i = 0; i < found->size(); ++i) {
    if (pattern->numbered) FUZZ_CLAIM(std::filesystem::exists((*found)[i].file), (*found)[i].file.string());
    FUZZ_CLAIM(i == 0 || (*found)[i - 1].frame < (*found)[i].frame, text);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text(fuzz::text_of(data, size));
  if (!may_take_long(text)) check_frames(text);
  (void)parse_layer_choice(text);
  std::replace(text.begin(), text.end(), '/', '_');  // stays in the scratch folder
  check_pattern(text.empty() ? text : (fuzz::scratch() / text).string());
  return 0;
}

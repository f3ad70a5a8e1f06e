// SPDX-License-Identifier: MIT
// Standard input: what it is, pictures one behind the other, frames of streams that cannot be sought in.
#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "clip.h"
#include "image/reader.h"
#include "image/several_pictures.h"

using namespace afterglow;

namespace {

constexpr int kMostFrames = 6;

/// On memory of just that size, so that the sanitizer sees who looks behind it.
std::optional<FirstOfSeveral> several_of(const std::uint8_t* data, std::size_t size) {
  const std::vector<std::uint8_t> exact(data, data + size);
  return first_of_several(fuzz::text_of(exact.data(), exact.size()));
}

void read_frames(MovieStream& stream) {
  Diagnostics quiet;
  for (int i = 0; i < kMostFrames; ++i) {
    auto frame = stream.next();
    if (!frame) return fuzz::check_error(frame.error(), {ErrorKind::io});
    if (!frame->movie) return;
    FUZZ_CLAIM(std::isfinite(frame->time) && (i > 0 || frame->time == 0), std::to_string(frame->time));
    ReadOptions options;
    options.movie = frame->movie;
    options.max_side = fuzz::kSmallClips.max_side;
    options.max_bytes = fuzz::kSmallClips.max_bytes;
    const auto picture = read_picture("-", options, quiet);
    if (!picture) {
      fuzz::check_error(picture.error(), {ErrorKind::io});
      continue;
    }
    for (const float v : picture->color.pixels) FUZZ_CLAIM(std::isfinite(v) && v >= 0, "");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto all = several_of(data, size), half = several_of(data, size / 2);
  FUZZ_CLAIM(!half || (all && all->kind == half->kind), "what was seen of a part is not there in the whole");

  const auto file = fuzz::write("input", fuzz::text_of(data, size));
  const FileDescriptor from(open(file.c_str(), O_RDONLY | O_CLOEXEC));
  FUZZ_CLAIM(dup2(from.get(), STDIN_FILENO) == STDIN_FILENO, "");
  Diagnostics quiet;
  const auto input = open_standard_input("", fuzz::kSmallClips, quiet);
  if (!input)
    fuzz::check_error(input.error(), {ErrorKind::io});
  else if (input->stream)
    read_frames(*input->stream);
  else
    FUZZ_CLAIM(input->file != nullptr, "");
  return 0;
}

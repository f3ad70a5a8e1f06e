// SPDX-License-Identifier: MIT
// Videos that are written beside what others wrote: sound, subtitles, chapters and texts that are copied from a
// stranger's file, and pieces that are joined.
#include <algorithm>
#include <array>

#include "fuzz.h"
#include "image/movie.h"
#include "image/video_writer.h"

using namespace afterglow;

namespace {

constexpr int kSide = 16, kFrames = 3;
constexpr std::array kOutputs{"out.mkv", "out.mov"};  // FFV1, ProRes

Picture picture() {
  Picture out;
  out.color = Image(kSide, kSide, 4);
  out.data_window = out.display_window = {0, 0, kSide, kSide};
  return out;
}

VideoPlan plan_of(const std::filesystem::path& out) {
  WriteOptions options;
  if (out.extension() == ".mkv") options.video.codec = "ffv1";
  VideoPlan plan = plan_video(out, options, false, false).value();
  plan.size = {kSide, kSide};
  return plan;
}

Result<void> write_beside(const std::filesystem::path& source, const std::filesystem::path& out) {
  Diagnostics quiet;
  VideoPlan plan = plan_of(out);
  plan.source = source;
  AFTERGLOW_TRY(const auto writer, VideoWriter::open(out, std::move(plan), quiet));
  for (int frame = 0; frame < kFrames; ++frame) {
    AFTERGLOW_TRY(PackedFrame packed, writer->pack(picture()));
    AFTERGLOW_CHECK(writer->write(std::move(packed), {frame, 1}));
  }
  return writer->finish(true);
}

Result<void> join_piece(const std::filesystem::path& piece, const std::filesystem::path& out) {
  Diagnostics quiet;
  return join_video(out, plan_of(out),
                    {.pieces = {{piece, {{0, 1}, {1, 1}, {2, 1}}}}, .whole = true, .interrupted = {}}, quiet);
}

/// An error leaves nothing.
void check(const Result<void>& done, const std::filesystem::path& out) {
  const auto files = std::distance(std::filesystem::directory_iterator(out.parent_path()), {});
  FUZZ_CLAIM(files == (done ? 2 : 1), done ? "" : done.error().text());
  if (!done) fuzz::check_error(done.error(), {ErrorKind::io});
}

}  // namespace

/// Modules take seconds to load under the sanitizers: not in the time of an input.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  (void)write_beside({}, fuzz::scratch() / "out.mkv");
  std::filesystem::remove(fuzz::scratch() / "out.mkv");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto source = fuzz::write("source", fuzz::text_of(data, size));
  for (const char* name : kOutputs) {
    const auto out = fuzz::scratch() / name;
    const auto written = write_beside(source, out);
    check(written, out);
    if (written) {
      Diagnostics quiet;
      const auto movie = Movie::open(out, {}, quiet);
      FUZZ_CLAIM(movie.ok() && (*movie)->frames() == kFrames, movie ? name : movie.error().text());
    }
    std::filesystem::remove(out);
    check(join_piece(source, out), out);
    std::filesystem::remove(out);
  }
  return 0;
}

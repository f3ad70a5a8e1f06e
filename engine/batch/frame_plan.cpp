// SPDX-License-Identifier: MIT
#include "batch/frame_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "batch/crop.h"
#include "core/memory_limit.h"
#include "core/text.h"
#include "image/metadata.h"
#include "image/movie.h"
#include "session/picture_inputs.h"

namespace afterglow {

Error named(Error error, const FrameJob& job) {
  if (error.file.empty()) error.file = job.input.string();
  return error;
}

namespace {

/// Frames that a video's decoder keeps: those of its cache, and those that others refer to.
std::uint64_t decoder_bytes(const FrameJob& job, std::uint64_t max_bytes) {
  if (!job.movie) return 0;
  constexpr std::uint64_t kReferences = 20, kMostSampleBytes = 6;  // 16 and some in work; 4:4:4 of more than 8 bits
  const MovieFacts& facts = job.movie->facts();
  const std::uint64_t frame = static_cast<std::uint64_t>(facts.stored.area()) * kMostSampleBytes;
  const std::uint64_t cached = job.passing ? 0 : std::min(movie_cache_bytes(max_bytes), facts.pts.size() * frame);
  return cached + std::min<std::uint64_t>(kReferences, std::max<std::size_t>(facts.pts.size(), 1)) * frame;
}

}  // namespace

/// A file's own work keeps one or two processors busy: half as many files as there are processors keep all of them so.
Overlap overlap_of(const FrameNeed& need, std::uint64_t max_memory, unsigned processors, bool in_order) {
  constexpr std::size_t kMost = 8;
  const std::size_t half = processors / 2;
  const std::size_t most_read = in_order ? 1 : std::clamp<std::size_t>(half, 2, kMost);
  const std::size_t most_written = std::clamp<std::size_t>(half, 3, kMost);
  const auto fits = [&](std::size_t read, std::size_t written) { return need.frames(read, written) <= max_memory; };
  if (!fits(1, 1)) return {};
  Overlap overlap{1, 1};
  while (true) {
    const Overlap before = overlap;
    if (overlap.written < most_written && fits(overlap.read, overlap.written + 1)) ++overlap.written;
    if (overlap.read < most_read && fits(overlap.read + 1, overlap.written)) ++overlap.read;
    if (overlap == before) return overlap;
  }
}

/// Of a picture that is made smaller, what reading it takes is told apart: a smaller --size changes nothing of that.
Error FramePlanner::too_large(const FrameNeed& need, Size source, Size made, const std::string& file) const {
  std::string pixels = fmt::format("{}x{} pixels", made.width, made.height);
  if (source != made) pixels += fmt::format(" of a picture of {}x{}", source.width, source.height);
  const std::uint64_t all = need.one_frame();
  const bool by_reading = need.reading > all / 2;
  const std::string largest = by_reading ? fmt::format(", {} of them to read it", needed_memory(need.reading)) : "";
  return {ErrorKind::io,
          fmt::format("{} need about {} with this preset{}, more than the {}", pixels, needed_memory(all), largest,
                      allowed_memory(options_.max_memory)),
          file, 0,
          by_reading ? "a larger --max-memory, or a smaller file" : "a larger --max-memory, or a smaller --size"};
}

Result<FrameNeed> FramePlanner::need_of(const PictureHeader& header, const Build& build, const FrameJob& job) {
  const BuildContext& context = build.context;
  FrameNeed need;
  need.reading = header.host_bytes;
  need.result = static_cast<std::uint64_t>(context.size.area()) * 4 * sizeof(float);
  need.result += sink_.bytes_of_frame(job, context.size, header.has_alpha, header.facts.get());
  need.held = sink_.bytes_held(context.size) + decoder_bytes(job, options_.read.max_bytes);
  need.device = session_.stack().memory_needed(build);
  // Each of those beside the one that is processed has its picture, and on the device a source and a result, which all
  // are staged in buffers.
  const auto others = static_cast<std::uint64_t>(session_.frames() - 1);
  if (others > 0 && !options_.histories && options_.nan_policy != NanPolicy::fail)
    need.in_flight = others * need.reading + (4 * others + 2) * static_cast<std::uint64_t>(context.size.area()) * 16;
  largest_need_ = std::max(largest_need_, need.one_frame());
  if (need.one_frame() > options_.max_memory)
    return too_large(need, header.display_window.size(), context.size, job.input.string());
  return need;
}

ReadOptions FramePlanner::read_options(const FrameJob& job) const {
  ReadOptions options = options_.read;
  options.auxiliary = session_.preset().needs();
  options.depth = job.depth;
  options.normal = job.normal;
  options.motion = job.motion;
  options.mattes = job.mattes.file;
  options.movie = job.movie;
  options.movie_frame = job.movie_frame;
  options.nan_policy = options_.nan_policy;
  return options;
}

/// A preview of half the size or less is made at twice its size when a look depends on single pixels.
std::optional<Scaling> FramePlanner::scaling_of(const PictureHeader& header) const {
  if (!options_.size) return std::nullopt;
  const Size whole = header.display_window.size(), size = options_.size->of(whole);
  const bool half = 2 * size.width <= whole.width && 2 * size.height <= whole.height;
  return Scaling{size, half && session_.preset().detailed() ? 2 : 1};
}

void FramePlanner::tell_of_shape(const PictureHeader& header, const FrameJob& job, Diagnostics& diagnostics) const {
  const Size whole = header.display_window.size();
  const MetadataValue* pixels = find_metadata(header.facts->metadata, "PixelAspectRatio");
  if (!options_.size || !options_.size->reshapes(whole) || (pixels && metadata_number(*pixels, 1) != 1)) return;
  const auto& [width, height, share] = *options_.size;
  diagnostics.warn_once(
      "shape", fmt::format("{}: --size {}x{} changes the shape of the picture, which has {}x{} pixels; --size {} or "
                           "--size x{} keeps it",
                           job.input.string(), width, height, whole.width, whole.height, width, height));
}

FramePlanner::Shape FramePlanner::shape_of(const PictureHeader& header) const {
  Shape shape{.data = header.data_window, .display = header.display_window};
  if (const auto scaling = scaling_of(header)) {
    shape.finer = scaling->finer;
    const Size whole = shape.display.size(), size = scaling->display;
    shape.length_scale = shape.finer * std::sqrt(static_cast<double>(size.area()) / static_cast<double>(whole.area()));
    shape.data = scaled_window(shape.data, shape.display, size);
    shape.display = {shape.display.x, shape.display.y, size.width, size.height};
  }
  return shape;
}

Result<void> FramePlanner::check_region(const PictureHeader& header) const {
  if (!options_.region) return {};
  const Shape shape = shape_of(header);
  const auto part = part_of_region(*options_.region, shape.data, shape.display);
  return part ? Result<void>() : part.error();
}

BuildContext FramePlanner::context_of(const FrameJob& job, const PictureHeader& header) const {
  BuildContext context;
  const Shape shape = shape_of(header);
  context.length_scale = shape.length_scale;
  context.size = shape.size();
  const auto& wanted = session_.preset().needs();
  for (const auto& name : header.auxiliary)
    if (std::find(wanted.begin(), wanted.end(), name) != wanted.end()) context.auxiliary[name] = context.size;
  context.layers = header.layers;
  context.hints = header.hints;
  context.notes_lacks = true;  // SequenceRecord tells of them
  note_files(header.facts, context);
  context.frame = job.frame;
  context.fps = job.fps > 0 ? job.fps : options_.fps;
  context.time = job.time.value_or(job.frame / options_.fps);
  context.position = camera_position(header.facts->metadata);
  return context;
}

/// What is wanted of the picture with this header.
Result<FrameRequest> FramePlanner::request_of(const FrameJob& job, const PictureHeader& header, double step,
                                              bool restart) {
  FrameRequest request;
  BuildContext context = context_of(job, header);
  const Shape shape = shape_of(header);
  const int finer = shape.finer;
  if (options_.region) {
    AFTERGLOW_TRY(const Rect part, part_of_region(*options_.region, shape.data, shape.display));
    request.region = Rect{part.x * finer, part.y * finer, part.width * finer, part.height * finer};
  }
  context.step = request.step = step;
  context.restart = request.restart = restart;
  const auto codes = sink_.codes(job, header.has_alpha, header.facts.get());
  if (codes && finer == 1)  // codes of pixels that are still to be put together would be no colours
    request.encoding = DisplayEncoding{codes->straight_alpha, codes->dither};
  auto build = session_.evaluate(context);
  if (!build) return std::move(build).error();
  request.build = std::move(*build);
  return request;
}

Result<PlannedFrame> FramePlanner::plan(const FrameJob& job, double step, bool restart) {
  if (job.refused) return *job.refused;
  PlannedFrame planned;
  // A header tells of the inputs that it was asked for. Which those are may depend on the frame, and on what it tells.
  constexpr int kMostReads = 4;
  bool more = true;
  for (int reads = 0; more && reads < kMostReads; ++reads) {
    auto header = read_header(job.input, read_options(job));
    if (!header) return named(std::move(header).error(), job);
    planned.header = std::move(*header);
    auto asked = session_.preset().note_needs(context_of(job, planned.header));
    if (!asked) return named(std::move(asked).error(), job);
    more = *asked && !job.passing;
  }
  auto request = request_of(job, planned.header, step, restart);
  if (!request) return named(std::move(request).error(), job);
  planned.request = std::move(*request);
  return planned;
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "image/movie.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "image/container_check.h"
#include "image/container_color.h"
#include "image/ffmpeg_module.h"
#include "image/movie_color.h"
#include "image/oiio_module.h"
#include "image/time_code.h"
#include "image/video_output.h"

namespace afterglow {

/// One frame, as the reader sees files.
class MovieFrameFile : public PictureFile {
 public:
  MovieFrameFile(std::shared_ptr<Movie> movie, int frame) : movie_(std::move(movie)), frame_(frame) {
    path_ = movie_->file();
    format_ = "ffmpeg";
    const MovieFacts& facts = movie_->facts();
    FilePart part;
    part.data_window = part.display_window = {0, 0, facts.size.width, facts.size.height};
    part.channels = {"R", "G", "B"};
    if (facts.has_alpha) part.channels.emplace_back("A");
    part.orientation = movie_->container_ ? movie_->container_->orientation.value_or(1) : facts.orientation;
    parts_.push_back(std::move(part));
  }

  std::uint64_t buffer_bytes(int) const override {
    const MovieFacts& facts = movie_->facts();
    constexpr std::uint64_t kSamples = 4, kPlanes = 2;  // as decoded, and as copied for zimg
    return static_cast<std::uint64_t>(facts.stored.area()) * kSamples * kPlanes * sizeof(std::uint16_t);
  }

  Result<bool> read_targets(int, std::span<const ReadTarget> targets, const RowsArrived&) override {
    const Size size = parts_.front().data_window.size();
    const std::size_t row = static_cast<std::size_t>(size.width) * 4;
    // What the reader asks for as a rule: all channels of RGBA at once.
    const bool together = !targets.empty() && std::ranges::all_of(targets, [&](const ReadTarget& target) {
      return target.pixel_stride == 4 && target.row_stride == row &&
             target.base - target.channel == targets[0].base - targets[0].channel;
    });
    if (together && targets[0].channel == 0 && targets.size() == parts_.front().channels.size()) {
      AFTERGLOW_CHECK(read_into(targets[0].base, row));
      return false;
    }
    Image whole(size.width, size.height, 4);
    AFTERGLOW_CHECK(read_into(whole.pixels.data(), row));
    for (const ReadTarget& target : targets)
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
          target.base[static_cast<std::size_t>(y) * target.row_stride +
                      static_cast<std::size_t>(x) * target.pixel_stride] = whole.at(x, y)[target.channel];
    return false;
  }

  ColorEncoding color_encoding(const ChannelChoice&, Diagnostics& diagnostics) const override {
    ColorEncoding encoding = movie_encoding(movie_->facts());
    const auto& container = movie_->container_;
    if (!container) return encoding;
    encoding.dense = false;
    encoding.grey = movie_->facts().grey;
    encoding.max_code = (1 << movie_->facts().bits) - 1;
    use_container_color(*container, container->profile, path_.string(), encoding, diagnostics);
    return encoding;
  }

  FileFacts facts(const ChannelChoice& color) const override {
    const MovieFacts& movie = movie_->facts();
    FileFacts facts;
    facts.file = path_;
    facts.format = format_;
    facts.bits = movie.bits;
    facts.floating = movie.floating;
    facts.orientation = parts_.front().orientation;
    facts.had_profile = movie_->container_ && !movie_->container_->profile.empty();
    for (std::size_t i = 0; i < 4; ++i)
      if (color.channels[i] >= 0)
        facts.color_channels[i] = parts_.front().channels[static_cast<std::size_t>(color.channels[i])];
    facts.yuv = !movie_->facts().color.rgb && !movie_->facts().floating;
    facts.metadata = metadata();
    return facts;
  }

 private:
  /// A time code and the rate that it counts by, or the rate alone where frames come evenly; by the frame's time, as
  /// numbers of frames tell nothing where the rate changes.
  Metadata metadata() const {
    const MovieFacts& movie = movie_->facts();
    const auto at = static_cast<std::size_t>(frame_);
    Metadata rate;
    if (const auto even = movie_->even_rate()) rate.push_back({"FramesPerSecond", *even});
    if (movie.time_code.empty() || movie.rate.denominator <= 0 || at >= movie.pts.size()) return rate;
    const double seconds = static_cast<double>(movie.pts[at] - movie.pts.front()) * movie.time_base.numerator /
                           movie.time_base.denominator;
    const auto frames = std::llround(seconds * movie.rate.numerator / movie.rate.denominator);
    std::string code = time_code_after(movie.time_code, frames, movie.rate);
    if (code.empty()) return rate;
    return {{kTimeCodeName, std::move(code)}, {"FramesPerSecond", movie.rate}};
  }
  Result<void> read_into(float* rgba, std::size_t row) {
    auto read = movie_->source_->read(frame_, rgba, row);
    if (read) return read;
    Error error = std::move(read).error();
    error.message = fmt::format("frame {} {}", frame_ + 1, error.message);
    error.file = path_.string();
    return error;
  }

  std::shared_ptr<Movie> movie_;
  int frame_;
};

namespace {

double seconds(const MovieFacts& facts, long long units) {
  const Rational base = facts.time_base;
  return base.denominator > 0 ? static_cast<double>(units) * base.numerator / base.denominator : 0;
}

void tell(const Movie& movie, Diagnostics& diagnostics) {
  const MovieFacts& facts = movie.facts();
  const std::string name = movie.file().string();
  for (const std::string& note : facts.notes) diagnostics.note(fmt::format("{}: {}", name, note));
  for (const std::string& warning : facts.warnings) diagnostics.warn(fmt::format("{}: {}", name, warning));
  if (facts.interlaced)
    diagnostics.warn(fmt::format("{}: is interlaced; its frames are read with both fields in them", name));
  if (facts.leaves_alpha)
    diagnostics.warn(fmt::format("{}: its alpha is in a track of its own, which is not read", name));
  if (facts.turned != 0)
    diagnostics.warn(fmt::format("{}: asks to be turned by {:.4g} degrees, which is not done", name, facts.turned));
  if (facts.missing > 0) {
    const std::size_t whole = facts.pts.size() - facts.missing;
    diagnostics.warn(facts.missing == 1 ? fmt::format("{}: is truncated: it ends after frame {}", name, whole)
                                        : fmt::format("{}: is truncated: frames {}-{} are missing", name, whole + 1,
                                                      facts.pts.size()));
  }
}

Result<std::shared_ptr<MovieSource>> open_source(const MovieRequest& request) {
  const std::string name = request.file.string();
  if (request.format == "webp") {
    const auto module = oiio_module();
    return module ? (*module)->open_webp(request) : Error{ErrorKind::io, module.error().message, name};
  }
  const auto module = ffmpeg_module();
  return module ? (*module)->open(request) : Error{ErrorKind::io, module.error().message, name};
}

/// Whether frames follow each other so, but for a rounding of each stamp to the clock's units; of an odd rate exactly.
bool is_even(const MovieFacts& of, const Rational& rate) {
  const bool usual = rate.denominator == 1 || rate.denominator == 1001;
  const double unit = static_cast<double>(of.time_base.numerator) / of.time_base.denominator;
  const double step = static_cast<double>(rate.denominator) / rate.numerator / unit;
  double early = 0, late = 0;
  for (std::size_t i = 0; i < of.pts.size(); ++i) {
    const double off = static_cast<double>(of.pts[i] - of.pts.front()) - static_cast<double>(i) * step;
    early = std::min(early, off);
    late = std::max(late, off);
  }
  return step >= 0.999 && late - early <= (usual && step >= 2 ? 1.001 : 0.001);  // a clock may tick once a frame
}

/// The usual rates first: an average may count a last frame whose length was guessed. `fps`: what the file says, or its
/// average.
std::optional<Rational> even_rate_of(const MovieFacts& of, double fps) {
  if (of.pts.empty() || of.time_base.denominator <= 0 || (of.pts.size() == 1 && of.pictures_alone)) return std::nullopt;
  std::vector<Rational> rates;
  if (fps > 0) rates.push_back(frame_rate(fps));
  if (const double length = seconds(of, of.pts.back() - of.pts.front()); length > 0) {
    const double mean = static_cast<double>(of.pts.size() - 1) / length;
    rates.push_back(frame_rate(std::round(mean)));
    rates.push_back(frame_rate(std::round(mean * 1.001) / 1.001));
  }
  if (of.rate.numerator > 0 && of.rate.denominator > 0 && of.pts.size() > 1) rates.push_back(of.rate);
  for (const Rational& rate : rates)
    if (is_even(of, rate)) return rate;
  return std::nullopt;
}

}  // namespace

Result<std::shared_ptr<Movie>> Movie::open(const std::filesystem::path& file, const SizeLimits& limits,
                                           Diagnostics& diagnostics, const ContainerFacts* checked) {
  std::shared_ptr<Movie> movie(new Movie());
  movie->file_ = file;
  AFTERGLOW_TRY(const Patience patience, patience_of_process());
  const std::string format = movie_format(file);
  AFTERGLOW_TRY(movie->source_, open_source({file, format, limits, patience}));
  if (format == "apng" || format == "webp") {
    auto container = checked ? Result(*checked) : check_container(file);
    if (container)  // one that is cut off is told of, and taken for sRGB
      movie->container_ = std::make_shared<const ContainerFacts>(*std::move(container));
  }
  movie->even_rate_ = even_rate_of(movie->facts(), movie->fps());
  tell(*movie, diagnostics);
  return movie;
}

std::shared_ptr<Movie> Movie::of(const std::filesystem::path& name, std::shared_ptr<MovieSource> source) {
  std::shared_ptr<Movie> movie(new Movie());
  movie->file_ = name;
  movie->source_ = std::move(source);
  return movie;
}

double Movie::fps() const {
  const Rational rate = facts().rate;
  if (rate.numerator > 0 && rate.denominator > 0) return static_cast<double>(rate.numerator) / rate.denominator;
  const double length = frames() > 1 ? time(frames() - 1) : 0;
  return length > 0 ? (frames() - 1) / length : 0;
}

bool Movie::variable_rate() const {
  const auto& pts = facts().pts;
  long long least = 0, most = 0;
  for (std::size_t i = 1; i + facts().missing < pts.size(); ++i) {
    const long long step = pts[i] - pts[i - 1];
    least = i == 1 ? step : std::min(least, step);
    most = i == 1 ? step : std::max(most, step);
  }
  constexpr long long kRounding = 2;  // of stamps in coarse units
  return most - least > kRounding && static_cast<double>(most - least) > 0.01 * static_cast<double>(most);
}

double Movie::time(int frame) const {
  const auto& pts = facts().pts;
  return seconds(facts(), pts[static_cast<std::size_t>(frame)] - pts.front());
}

std::unique_ptr<PictureFile> Movie::frame(std::shared_ptr<Movie> movie, int frame) {
  return std::make_unique<MovieFrameFile>(std::move(movie), frame);
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "play/footage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <system_error>
#include <unordered_map>

#include "core/file.h"
#include "core/text.h"
#include "image/scale.h"
#include "image/sequence.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr int kProxies[] = {1, 2, 4, 8};
constexpr std::size_t kMostFrames = 1'000'000;

/// The frames of a sequence without gaps, in order; a list that was asked for is taken as it is.
std::vector<int> numbers_of(const std::vector<FrameFile>& files, const std::optional<std::vector<int>>& wanted) {
  if (wanted) return *wanted;
  std::vector<int> numbers;
  for (const FrameFile& file : files) {
    const long long gap = numbers.empty() ? 1 : static_cast<long long>(file.frame) - numbers.back();
    // What lies so far apart is no sequence with holes.
    if (gap > 1 && numbers.size() + static_cast<std::size_t>(gap) <= kMostFrames)
      for (int number = numbers.back() + 1; number < file.frame; ++number) numbers.push_back(number);
    numbers.push_back(file.frame);
  }
  return numbers;
}

Result<LayerChoice> resolved(const LayerChoice& choice, int frame) {
  if (choice.file.empty()) return choice;
  AFTERGLOW_TRY(const Pattern pattern, parse_pattern(choice.file.string()));
  return LayerChoice{pattern.file(frame), choice.name};
}

/// The same for shot.####.exr and shot.%04d.exr.
std::string clip_key(const std::string& input) {
  std::string name = input;
  if (const auto pattern = parse_pattern(input); pattern && pattern->numbered)
    name = pattern->prefix + std::string(static_cast<std::size_t>(std::max(pattern->digits, 1)), '#') + pattern->suffix;
  std::error_code ignored;
  return fs::absolute(name, ignored).lexically_normal().string();
}

}  // namespace

Result<void> Footage::add_sequence(const std::string& input, const std::optional<std::vector<int>>& wanted,
                                   Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const Pattern pattern, parse_pattern(input));
  LeftOut others;
  AFTERGLOW_TRY(auto files, find_frames(pattern, wanted, &others));
  others.tell(input, pattern, diagnostics);
  // A plain file that is missing is an error when it is read; a hole in a sequence is none.
  if (pattern.numbered) std::erase_if(files, [&](const FrameFile& file) { return !there_(file.file); });
  std::unordered_map<int, int> picture_of;
  for (const FrameFile& file : files) {
    picture_of[file.frame] = pictures();
    pictures_.push_back({.file = file.file, .number = file.frame, .movie = {}, .movie_frame = 0});
  }
  if (picture_of.empty()) return Error{ErrorKind::io, "none of the frames that --frames asks for exists", input};
  const std::vector<int> numbers = pattern.numbered ? numbers_of(files, wanted) : std::vector<int>{files[0].frame};
  int last = -1;
  for (const int number : numbers)
    if (const auto found = picture_of.find(number); last < 0 && found != picture_of.end()) last = found->second;
  for (const int number : numbers) {
    const auto found = picture_of.find(number);
    const bool held = found == picture_of.end();
    if (!held) last = found->second;
    if (held) missing_.push_back(number);
    frames_.push_back({.number = number, .picture = last, .held = held, .time = {}});
  }
  return {};
}

/// How many turns each frame of a video stays, so that turns at one rate show frames at their own times. Returns the
/// rate.
double Footage::pace(const Movie& movie, std::vector<int>& turns) const {
  turns.assign(static_cast<std::size_t>(movie.frames()), 1);
  if (!movie.variable_rate()) return movie.fps();
  // A turn is as long as the shortest frame; more of them than this a second no screen shows.
  constexpr double kMostTurns = 240;
  double shortest = 0;
  for (int i = 1; i < movie.frames(); ++i) {
    const double length = movie.time(i) - movie.time(i - 1);
    if (length > 0 && (shortest == 0 || length < shortest)) shortest = length;
  }
  if (shortest <= 0) return movie.fps();
  const double rate = std::min(kMostTurns, 1 / shortest);
  if (movie.time(movie.frames() - 1) * rate > static_cast<double>(kMostFrames)) return movie.fps();
  long long at = 0;
  for (int i = 0; i + 1 < movie.frames(); ++i) {
    const long long next = std::max(at + 1, std::llround(movie.time(i + 1) * rate));
    turns[static_cast<std::size_t>(i)] = static_cast<int>(next - at);
    at = next;
  }
  return rate;
}

Result<void> Footage::add_movie(const fs::path& file, const std::optional<std::vector<int>>& wanted,
                                Diagnostics& diagnostics) {
  AFTERGLOW_TRY(std::shared_ptr<Movie> movie, Movie::open(file, {read_.max_side, read_.max_bytes}, diagnostics));
  std::optional<std::set<int>> chosen;
  if (wanted) chosen.emplace(wanted->begin(), wanted->end());
  std::vector<int> turns;
  const double rate = pace(*movie, turns);
  const int first = pictures();
  for (int frame = 0; frame < movie->frames(); ++frame) {
    if (chosen && !chosen->contains(frame + 1)) continue;
    for (int turn = 0; turn < turns[static_cast<std::size_t>(frame)]; ++turn)
      frames_.push_back({.number = frame + 1, .picture = pictures(), .held = false, .time = movie->time(frame)});
    pictures_.push_back({.file = file, .number = frame + 1, .movie = movie, .movie_frame = frame});
  }
  if (pictures() == first)
    return Error{ErrorKind::io, fmt::format("has no frame that --frames asks for; it has {}", movie->frames()),
                 file.string()};
  if (!fps_ && rate > 0) fps_ = rate;
  variable_rate_ = variable_rate_ || movie->variable_rate();
  video_ = true;
  return {};
}

Result<void> Footage::add(const std::string& input, const std::optional<std::vector<int>>& wanted,
                          Diagnostics& diagnostics) {
  AFTERGLOW_TRY(const Pattern pattern, parse_pattern(input));
  if (pattern.numbered) return add_sequence(input, wanted, diagnostics);
  if (!movie_format(pattern.file(0)).empty()) return add_movie(pattern.file(0), wanted, diagnostics);
  if (wanted)
    return Error{ErrorKind::usage,
                 fmt::format("--frames needs a numbered input like shot.####.exr or a video, not {}", input),
                 "afterglow play"};
  std::error_code none;
  if (!fs::exists(pattern.file(0), none)) return missing_file(pattern.file(0));
  return add_sequence(input, {}, diagnostics);
}

Result<int> parse_proxy(const std::string& text) {
  for (const int proxy : kProxies)
    if (text == proxy_name(proxy)) return proxy;
  return Error{ErrorKind::usage, fmt::format("'{}' is no size of proxies", text), "--proxy", 0, "1, 1/2, 1/4, 1/8"};
}

std::string proxy_name(int proxy) { return proxy == 1 ? "1" : fmt::format("1/{}", proxy); }

Result<std::shared_ptr<const Footage>> Footage::open(const FootageOptions& options, Diagnostics& diagnostics) {
  std::shared_ptr<Footage> footage(new Footage());
  footage->there_ = [](const fs::path& file) {
    std::error_code ignored;
    return fs::exists(file, ignored);
  };
  AFTERGLOW_CHECK(footage->add_inputs(options, diagnostics));
  return std::shared_ptr<const Footage>(std::move(footage));
}

Result<std::shared_ptr<const Footage>> Footage::anew(const FootageOptions& options, const Footage& before,
                                                     const std::set<fs::path>& changed, const There& there) {
  std::shared_ptr<Footage> footage(new Footage());
  footage->there_ = there;
  Diagnostics quiet;  // holes were told of; those that come are filled as they are rendered
  AFTERGLOW_CHECK(footage->add_inputs(options, quiet));
  footage->renumber(before, changed);
  if (changed.empty() && footage->frames_ == before.frames_) return std::shared_ptr<const Footage>();
  return std::shared_ptr<const Footage>(std::move(footage));
}

void Footage::renumber(const Footage& before, const std::set<fs::path>& changed) {
  std::map<fs::path, int> known;  // of a file that was rendered again the last number
  for (int picture = 0; picture < before.pictures(); ++picture) known[before.file(picture)] = picture;
  for (const auto& file : changed) known.erase(file);
  std::vector<Source> pictures = before.pictures_;
  std::vector<int> number;
  for (Source& source : pictures_) {
    const auto [at, is_new] = known.emplace(source.file, static_cast<int>(pictures.size()));
    number.push_back(at->second);
    if (is_new) pictures.push_back(std::move(source));
  }
  for (FootageFrame& frame : frames_) frame.picture = number[static_cast<std::size_t>(frame.picture)];
  pictures_ = std::move(pictures);
}

Result<void> Footage::add_inputs(const FootageOptions& options, Diagnostics& diagnostics) {
  read_ = options.read;
  proxy_ = options.proxy;
  std::optional<std::vector<int>> wanted;
  if (!options.frames.empty()) {
    AFTERGLOW_TRY(wanted, parse_frames(options.frames));
  }
  AFTERGLOW_TRY(const auto inputs, with_sequences(options.inputs, diagnostics));
  for (const std::string& input : inputs) {
    const std::size_t before = missing_.size();
    const int first = frames();
    AFTERGLOW_CHECK(add(input, wanted, diagnostics));
    clips_.push_back({.label = fs::path(input).filename().string(),
                      .key = clip_key(input),
                      .first = first,
                      .frames = frames() - first});
    const std::vector<int> missing(missing_.begin() + static_cast<std::ptrdiff_t>(before), missing_.end());
    if (!missing.empty())
      diagnostics.warn(fmt::format("{}: {} {} missing, the picture before is held: {}", input, missing.size(),
                                   missing.size() == 1 ? "frame is" : "frames are", frames_text(missing)));
  }
  if (frames_.empty()) return Error{ErrorKind::usage, "there is nothing to play", "afterglow play"};
  if (frames_.size() > kMostFrames)
    return Error{ErrorKind::usage, fmt::format("there are more than {} frames", kMostFrames), "afterglow play"};
  there_ = {};
  return {};
}

std::shared_ptr<const Footage> Footage::at_proxy(int proxy) const {
  std::shared_ptr<Footage> other(new Footage(*this));
  other->proxy_ = proxy;
  return other;
}

int Footage::clip_at(int position) const {
  const auto behind = std::ranges::upper_bound(clips_, position, {}, [](const Clip& clip) { return clip.first; });
  return std::max(0, static_cast<int>(behind - clips_.begin()) - 1);
}

std::vector<fs::path> Footage::files(int picture) const {
  const Source& source = pictures_[static_cast<std::size_t>(picture)];
  std::vector<fs::path> out{source.file};
  for (const LayerChoice& choice : {read_.depth, read_.normal, read_.motion, LayerChoice{read_.mattes, ""}})
    if (const auto layer = resolved(choice, source.number); layer && !layer->file.empty()) out.push_back(layer->file);
  return out;
}

std::string Footage::picture_name(int picture) const {
  const Source& source = pictures_[static_cast<std::size_t>(picture)];
  const std::string name = source.file.filename().string();
  return source.movie ? fmt::format("{}, frame {}", name, source.number) : name;
}

Result<Picture> Footage::read(int picture, const FootageNeeds& needs, Diagnostics& diagnostics) const {
  auto read = read_whole(picture, needs, diagnostics);
  if (!read) return read;
  if (proxy_ > 1) scale_picture(*read, {SizeWish{.share = 1.0 / proxy_}.of(read->display_window.size())});
  note_content(*read);
  return read;
}

Result<Picture> Footage::read_whole(int picture, const FootageNeeds& needs, Diagnostics& diagnostics) const {
  const Source& source = pictures_[static_cast<std::size_t>(picture)];
  ReadOptions options = read_;
  options.auxiliary = needs.auxiliary;
  if (options.input_space.empty()) options.input_space = needs.input_space;
  if (!options.keep_negative) options.keep_negative = needs.keep_negative;
  AFTERGLOW_TRY(options.depth, resolved(read_.depth, source.number));
  AFTERGLOW_TRY(options.normal, resolved(read_.normal, source.number));
  AFTERGLOW_TRY(options.motion, resolved(read_.motion, source.number));
  AFTERGLOW_TRY(const LayerChoice mattes, resolved({read_.mattes, ""}, source.number));
  options.mattes = mattes.file;
  options.movie = source.movie;
  options.movie_frame = source.movie_frame;
  auto read = read_picture(source.file, options, diagnostics);
  if (!read && read.error().file.empty()) {
    Error error = std::move(read).error();
    error.file = source.file.string();
    return error;
  }
  return read;
}

}  // namespace afterglow

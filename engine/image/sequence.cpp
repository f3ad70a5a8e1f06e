// SPDX-License-Identifier: MIT
#include "image/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <limits>
#include <system_error>
#include <unordered_set>

#include "core/ascii.h"
#include "core/decomposed.h"
#include "core/text.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxFrames = 1'000'000;

Error bad_frames(const std::string& text, const std::string& why) {
  return Error{ErrorKind::usage, fmt::format("bad frame list '{}': {}", text, why), "", 0,
               "N, N-M, N-MxSTEP, joined by commas"};
}

/// Reads a number (with a sign) from the front of `text` and removes it.
std::optional<int> take_number(std::string_view& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

struct Range {
  int first = 0, last = 0, step = 1;
};

Result<Range> parse_range(const std::string& text, std::string_view part) {
  Range range;
  const auto first = take_number(part);
  if (!first) return bad_frames(text, "a number is missing");
  range.first = range.last = *first;
  if (!part.empty() && part.front() == '-') {
    part.remove_prefix(1);
    const auto last = take_number(part);
    if (!last) return bad_frames(text, "the end of a range is missing");
    range.last = *last;
    if (!part.empty() && part.front() == 'x') {
      part.remove_prefix(1);
      const auto step = take_number(part);
      if (!step || *step < 1) return bad_frames(text, "the step must be a number of at least 1");
      range.step = *step;
    }
  }
  if (!part.empty()) return bad_frames(text, fmt::format("'{}' is not understood", part));
  if (range.last < range.first) return bad_frames(text, "a range must go upwards");
  return range;
}

/// Digits, and a sign in front of them.
bool is_number(std::string_view text) {
  if (text.starts_with('-')) text.remove_prefix(1);
  return !text.empty() && std::ranges::all_of(text, is_digit);
}

/// Sorts by number. Of "-003" and "-0003" the first is the frame.
void leave_out_twins(const Pattern& pattern, std::vector<FrameFile>& found, LeftOut& others) {
  std::ranges::sort(found, [&](const FrameFile& a, const FrameFile& b) {
    return a.frame != b.frame ? a.frame < b.frame : a.file == pattern.file(a.frame) && b.file != a.file;
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (kept > 0 && found[kept - 1].frame == found[i].frame) {
      others.add(found[i].file);
    } else {
      found[kept++] = found[i];
    }
  }
  found.resize(kept);
}

/// One place for a number in a name: where, how long its text is, and how many digits it asks for.
struct Place {
  std::size_t begin = 0, length = 0;
  int digits = 0;
};

Error bad_pattern(const std::string& text, const std::string& why) {
  return Error{ErrorKind::usage, fmt::format("'{}' {}", text, why), "", 0,
               "one run of #, or one %d or %04d, in the file name; %% is a percent sign"};
}

/// Folders have no place for a number; of one that is not there %% is %.
std::string folder_of_pattern(std::string text) {
  std::error_code ignored;
  if (text.empty() || fs::exists(text, ignored)) return text;
  for (std::size_t at = 0; (at = text.find("%%", at)) != std::string::npos; ++at) text.erase(at, 1);
  return text;
}

/// "1", "1-24" or "1-47x2".
std::string range_text(int first, int last, int step) {
  if (first == last) return fmt::format("{}", first);
  return step == 1 ? fmt::format("{}-{}", first, last) : fmt::format("{}-{}x{}", first, last, step);
}

bool is_ascii(const std::string& text) {
  return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

/// What stands between two parts of a name, whichever way its letters are written; nothing: it has other parts.
std::optional<std::string> between(const std::string& name, const std::string& stem, const std::string& suffix) {
  const auto cut = [](const auto& whole, const auto& front, const auto& back) {
    const bool fits = whole.size() > front.size() + back.size() && whole.starts_with(front) && whole.ends_with(back);
    return fits ? std::optional(whole.substr(front.size(), whole.size() - front.size() - back.size())) : std::nullopt;
  };
  if (auto middle = cut(name, stem, suffix)) return middle;
  if (is_ascii(stem) && is_ascii(suffix)) return std::nullopt;
  const auto middle = cut(decomposed(name), decomposed(stem), decomposed(suffix));
  if (!middle || !std::ranges::all_of(*middle, [](char32_t c) { return c < 0x80; })) return std::nullopt;
  return std::string(middle->begin(), middle->end());
}

/// The pattern of a file whose name differs in the case of its letters alone; "": it differs otherwise.
std::string pattern_in_case(const fs::path& folder, const std::string& name, const std::string& stem,
                            const std::string& suffix) {
  const auto middle = between(lower(name), lower(stem), lower(suffix));
  if (!middle || !is_number(*middle) || !lower(name).starts_with(lower(stem))) return "";
  const auto digits = static_cast<std::size_t>(std::ranges::count_if(*middle, is_digit));
  return (folder / name.substr(0, stem.size())).string() + std::string(digits, '#') +
         name.substr(stem.size() + middle->size());
}

bool looks_like_place(const std::string& folder) {
  return folder.find('#') != std::string::npos || folder.find("%0") != std::string::npos ||
         folder.find("%d") != std::string::npos;
}

}  // namespace

std::size_t number_begin(std::string_view name, std::size_t end) {
  std::size_t begin = end;
  while (begin > 0 && is_digit(name[begin - 1])) --begin;
  const bool sign = begin < end && begin > 0 && name[begin - 1] == '-' &&
                    (begin == 1 || name[begin - 2] == '.' || name[begin - 2] == '_');
  return sign ? begin - 1 : begin;
}

FrameNumber frame_number(const fs::path& file) {
  const std::string stem = file.stem().string();
  for (std::size_t end = stem.size(); end > 0; --end) {
    const bool last = is_digit(stem[end - 1]) && (end == stem.size() || !is_digit(stem[end]));
    if (!last || (end < stem.size() && is_letter(stem[end]))) continue;
    const std::size_t begin = number_begin(stem, end);
    const std::size_t sign = begin < end && stem[begin] == '-' ? 1 : 0;
    return {begin, end, static_cast<int>(end - begin - sign)};
  }
  return {};
}

std::optional<int> own_frame_number(const fs::path& file) {
  const FrameNumber number = frame_number(file);
  if (number.digits == 0 || number.digits > kMostFrameDigits) return std::nullopt;
  return std::stoi(file.stem().string().substr(number.begin, number.end - number.begin));
}

std::string without_frame_number(const fs::path& file) {
  const FrameNumber number = frame_number(file);
  std::string name = file.filename().string();
  if (number.digits > 0 && number.digits <= kMostFrameDigits)
    name.replace(number.begin, number.end - number.begin, "*");
  return (file.parent_path() / name).string();
}

Result<std::vector<int>> parse_frames(const std::string& text) {
  std::vector<int> frames;
  std::unordered_set<int> seen;
  long long looked = 0;  // frames that are named again and again take time too
  for (const std::string& raw : split(text, ',')) {
    AFTERGLOW_TRY(const Range range, parse_range(text, trim(raw)));
    const long long count = (static_cast<long long>(range.last) - range.first) / range.step + 1;
    looked += count;
    if (count > static_cast<long long>(kMaxFrames) || looked > 4 * static_cast<long long>(kMaxFrames))
      return bad_frames(text, fmt::format("more than {} frames", kMaxFrames));
    for (long long i = 0; i < count; ++i) {
      const int frame = static_cast<int>(range.first + i * range.step);
      if (seen.insert(frame).second) frames.push_back(frame);
    }
    if (frames.size() > kMaxFrames) return bad_frames(text, fmt::format("more than {} frames", kMaxFrames));
  }
  return frames;
}

std::string frames_text(const std::vector<int>& frames) {
  std::string out;
  for (std::size_t i = 0; i < frames.size();) {
    const int step = i + 1 < frames.size() ? frames[i + 1] - frames[i] : 1;
    std::size_t last = i;
    while (step > 0 && last + 1 < frames.size() && frames[last + 1] - frames[last] == step) ++last;
    if (step != 1 && last < i + 2) last = i;  // two frames that are far apart are no range
    out += (out.empty() ? "" : ",") + range_text(frames[i], frames[last], step);
    i = last + 1;
  }
  return out;
}

fs::path Pattern::file(int frame) const {
  if (!numbered) return prefix + suffix;
  return fmt::format("{}{:0{}d}{}", prefix, frame, digits, suffix);
}

fs::path Pattern::file_with_sign(int frame) const {
  if (!numbered || frame >= 0) return file(frame);
  return fmt::format("{}-{:0{}d}{}", prefix, -static_cast<long long>(frame), digits, suffix);
}

fs::path Pattern::existing(int frame) const {
  const fs::path asked = file(frame);
  std::error_code ec;
  if (!numbered || fs::exists(asked, ec)) return asked;
  for (const fs::path& one : {asked, file_with_sign(frame)})
    for (const std::string& name :
         {one.filename().string(), put_together(one.filename().string()), taken_apart(one.filename().string())})
      if (const fs::path other = one.parent_path() / name; other != asked && fs::exists(other, ec)) return other;
  return asked;
}

void LeftOut::add(const fs::path& file) {
  if (files++ == 0 || file < first) first = file;
}

std::string LeftOut::names() const {
  const std::string name = first.filename().string();
  return files == 1 ? name + " is" : fmt::format("{} and {} more are", name, files - 1);
}

void LeftOut::tell(const std::string& input, const Pattern& pattern, Diagnostics& diagnostics) const {
  if (files == 0) return;
  const std::string digits = pattern.digits == 1
                                 ? "no zeros in front"
                                 : fmt::format("{} digits, or more without zeros in front", pattern.digits);
  diagnostics.warn(fmt::format("{}: {} left out: numbers have {} here, and go to {}", input, names(), digits,
                               std::numeric_limits<int>::max()));
}

Result<Pattern> parse_pattern(const std::string& text) {
  if (text.empty()) return Error{ErrorKind::usage, "an empty file name"};
  std::error_code ignored;
  if (fs::exists(text, ignored)) return Pattern{text, "", 0, false};  // a name that merely looks like a pattern
  const std::size_t name = text.rfind('/') + 1;
  const std::string folder = folder_of_pattern(text.substr(0, name));
  std::vector<Place> places;
  std::string plain = folder;  // `text` with %% made %
  for (std::size_t i = name; i < text.size();) {
    if (text[i] == '#') {
      const std::size_t end = std::min(text.find_first_not_of('#', i), text.size());
      places.push_back({plain.size(), 0, static_cast<int>(end - i)});
      i = end;
    } else if (text[i] == '%' && i + 1 < text.size() && text[i + 1] == '%') {
      plain += '%';
      i += 2;
    } else if (text[i] == '%' && i + 1 < text.size() && is_name_char(text[i + 1]) && text[i + 1] != '_') {
      std::size_t end = i + 1;
      while (end < text.size() && is_digit(text[end])) ++end;
      if (end >= text.size() || text[end] != 'd' || end - i > 3 || (end > i + 1 && text[i + 1] != '0'))
        return bad_pattern(text, "has a % code that is not understood");
      places.push_back({plain.size(), 0, end > i + 1 ? std::stoi(text.substr(i + 1, end - i - 1)) : 1});
      i = end + 1;
    } else {
      plain += text[i++];
    }
  }
  if (places.empty() && looks_like_place(folder) && !fs::exists(folder, ignored))
    return bad_pattern(text, "has the place for the frame number in a folder's name");
  if (places.empty()) return Pattern{plain, "", 0, false};
  if (places.size() > 1) return bad_pattern(text, "has more than one place for the frame number");
  const Place place = places.front();
  if (place.digits > kMostFrameDigits)
    return bad_pattern(text, fmt::format("asks for more than {} digits", kMostFrameDigits));
  return Pattern{plain.substr(0, place.begin), plain.substr(place.begin), std::max(place.digits, 1), true};
}

Result<std::vector<FrameFile>> find_frames(const Pattern& pattern, const std::optional<std::vector<int>>& frames,
                                           LeftOut* left_out) {
  if (!pattern.numbered) {
    const fs::path file = pattern.file(0);
    return std::vector<FrameFile>{{own_frame_number(file).value_or(1), file}};
  }
  std::vector<FrameFile> found;
  if (frames) {
    for (const int frame : *frames) found.push_back({frame, pattern.existing(frame)});
    return found;
  }
  const std::string shown =
      pattern.prefix + std::string(static_cast<std::size_t>(pattern.digits), '#') + pattern.suffix;
  const fs::path prefix(pattern.prefix);
  const fs::path folder = prefix.has_parent_path() ? prefix.parent_path() : fs::path(".");
  const std::string stem = prefix.filename().string();
  LeftOut others;
  std::string in_case;  // a pattern with other letters of the same names
  std::error_code ec;
  fs::directory_iterator entry(folder, ec);
  if (ec)
    return Error{ErrorKind::io, fmt::format("folder '{}' cannot be read: {}", folder.string(), ec.message()), shown};
  for (; !ec && entry != fs::directory_iterator(); entry.increment(ec)) {
    const std::string name = entry->path().filename().string();
    const auto middle = between(name, stem, pattern.suffix);
    if (!middle || !is_number(*middle)) {
      if (in_case.empty()) in_case = pattern_in_case(prefix.parent_path(), name, stem, pattern.suffix);
      continue;
    }
    std::string_view rest = *middle;
    const auto frame = take_number(rest);
    // Only the number that the pattern itself makes: "shot.007" is no frame of shot.#.
    const auto is = [&](const fs::path& file) { return same_letters(file.filename().string(), name); };
    if (frame && (is(pattern.file(*frame)) || is(pattern.file_with_sign(*frame)))) {
      const bool as_written = pattern.file(*frame).filename() == name;
      found.push_back({*frame, as_written ? pattern.file(*frame) : prefix.parent_path() / name});
    } else {
      others.add(entry->path());
    }
  }
  if (ec)
    return Error{ErrorKind::io, fmt::format("folder '{}' cannot be read: {}", folder.string(), ec.message()), shown};
  if (found.empty()) {
    Error error{ErrorKind::io, "no file matches this pattern", shown};
    error.nearest = in_case;
    if (others.files == 0) return error;
    const std::string name = others.first.filename().string();
    const std::string middle = between(name, stem, pattern.suffix).value_or("");
    const auto digits = static_cast<std::size_t>(std::ranges::count_if(middle, is_digit));
    error.message +=
        fmt::format(": it has {} digit{}, and {} has {}", pattern.digits, pattern.digits == 1 ? "" : "s", name, digits);
    error.nearest = pattern.prefix + std::string(digits, '#') + pattern.suffix;
    return error;
  }
  leave_out_twins(pattern, found, others);
  if (left_out) *left_out = others;
  return found;
}

}  // namespace afterglow

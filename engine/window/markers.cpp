// SPDX-License-Identifier: MIT
#include "window/markers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>

#include "core/file.h"
#include "core/file_lock.h"
#include "core/hash.h"
#include "core/text.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

std::string in_one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return text;
}

}  // namespace

fs::path Markers::file(const std::string& key) const { return folder_ / (hash_text(key).hex().substr(0, 16) + ".txt"); }

Markers::Numbers Markers::read(const std::string& key) const {
  Numbers out;
  if (folder_.empty()) return out;
  const auto text = read_file(file(key));
  if (!text) return out;
  const auto lines = split(*text, '\n');
  if (lines.empty() || lines.front() != in_one_line(key)) return out;  // another clip's, whose name has the same hash
  for (auto line = std::next(lines.begin()); line != lines.end(); ++line) {
    int number = 0;
    const char* const end = line->data() + line->size();
    const auto parsed = std::from_chars(line->data(), end, number);
    if (parsed.ec != std::errc{} || (parsed.ptr != end && *parsed.ptr != ' ')) continue;
    out[number] = trim({parsed.ptr, static_cast<std::size_t>(end - parsed.ptr)});
  }
  return out;
}

void Markers::follow(const std::shared_ptr<const Footage>& footage) {
  if (footage == footage_) return;
  footage_ = footage;
  for (const auto& clip : footage_->clips())
    if (!clips_.contains(clip.key)) clips_[clip.key] = read(clip.key);
  list();
}

/// Positions of the markers. A number that several positions have (a video whose rate varies) stands at the first.
void Markers::list() {
  shown_.clear();
  for (const auto& clip : footage_->clips()) {
    const Numbers& marked = clips_[clip.key];
    if (marked.empty()) continue;
    for (int at = clip.first; at < clip.first + clip.frames; ++at) {
      const auto found = marked.find(number(at));
      if (found == marked.end() || (at > clip.first && number(at - 1) == number(at))) continue;
      shown_.push_back({at, found->second});
    }
  }
}

std::optional<Marker> Markers::at(int position) const {
  const int clip = footage_->clip_at(position);
  for (const Marker& marker : shown_)
    if (footage_->clip_at(marker.position) == clip && number(marker.position) == number(position)) return marker;
  return std::nullopt;
}

std::optional<Marker> Markers::next(int position) const {
  const auto found = std::ranges::find_if(shown_, [&](const Marker& m) { return m.position > position; });
  return found == shown_.end() ? std::nullopt : std::optional(*found);
}

std::optional<Marker> Markers::previous(int position) const {
  const auto found =
      std::find_if(shown_.rbegin(), shown_.rend(), [&](const Marker& m) { return m.position < position; });
  return found == shown_.rend() ? std::nullopt : std::optional(*found);
}

/// Another window may have set markers of the same clip since: the change is made to those that are in the file.
Result<void> Markers::change(const std::string& key, const std::function<void(Numbers&)>& made) {
  Numbers& marked = clips_[key];
  std::error_code ignored;
  if (folder_.empty()) {
    made(marked);
    list();
    return {};
  }
  fs::create_directories(folder_, ignored);
  const FileLock lock(folder_);
  marked = read(key);
  made(marked);
  list();
  if (marked.empty()) {
    fs::remove(file(key), ignored);
    return {};
  }
  std::string text = in_one_line(key) + "\n";
  for (const auto& [number, name] : marked) text += fmt::format("{} {}\n", number, name);
  return write_file_atomically(file(key), text);
}

Result<bool> Markers::toggle(int position) {
  const std::string key = footage_->clips()[static_cast<std::size_t>(footage_->clip_at(position))].key;
  const bool marks = !clips_[key].contains(number(position));
  AFTERGLOW_CHECK(change(key, [&](Numbers& marked) {
    if (marks)
      marked.emplace(number(position), "");
    else
      marked.erase(number(position));
  }));
  return marks;
}

Result<void> Markers::name(int position, const std::string& text) {
  const std::string key = footage_->clips()[static_cast<std::size_t>(footage_->clip_at(position))].key;
  return change(key, [&](Numbers& marked) { marked[number(position)] = trim(in_one_line(text)); });
}

}  // namespace afterglow

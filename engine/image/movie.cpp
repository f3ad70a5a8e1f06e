// SPDX-License-Identifier: MIT
#include "image/movie.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <fstream>
#include <string_view>
#include <vector>

#include "core/exception.h"
#include "core/text.h"
#include "image/metadata.h"

namespace afterglow {
namespace {

struct Signature {
  std::size_t at;
  std::string_view bytes;
  MovieContainer kind;
  const char* name;
};

using namespace std::string_view_literals;
constexpr std::array<Signature, 13> kSignatures{{
    {4, "ftyp"sv, MovieContainer::movie, "MP4"},
    {4, "moov"sv, MovieContainer::movie, "QuickTime"},
    {4, "mdat"sv, MovieContainer::movie, "QuickTime"},
    {4, "wide"sv, MovieContainer::movie, "QuickTime"},
    {8, "AVI "sv, MovieContainer::movie, "AVI"},
    {0, "\x1a\x45\xdf\xa3"sv, MovieContainer::unreadable_movie, "Matroska or WebM"},
    {0, "\0\0\1\xba"sv, MovieContainer::unreadable_movie, "MPEG program stream"},
    {0, "\0\0\1\xb3"sv, MovieContainer::unreadable_movie, "MPEG video"},
    {0, "OggS"sv, MovieContainer::unreadable_movie, "Ogg"},
    {0, "FLV\1"sv, MovieContainer::unreadable_movie, "Flash video"},
    {0, "\x30\x26\xb2\x75\x8e\x66\xcf\x11"sv, MovieContainer::unreadable_movie, "Windows Media"},
    {0, "\x06\x0e\x2b\x34\x02\x05\x01\x01"sv, MovieContainer::unreadable_movie, "MXF"},
    {0, "DKIF"sv, MovieContainer::unreadable_movie, "IVF"},
}};

/// Pictures whose files are boxes too.
bool is_still(std::string_view brand) {
  for (const std::string_view still : {"avif"sv, "heic"sv, "heix"sv, "mif1"sv, "jxl "sv, "jp2 "sv, "crx "sv})
    if (brand == still) return true;
  return false;
}

}  // namespace

MovieContainer movie_container(const std::filesystem::path& file, const char** name) {
  std::array<char, 377> head{};
  std::ifstream in(file, std::ios::binary);
  in.read(head.data(), head.size());
  const std::string_view bytes(head.data(), static_cast<std::size_t>(in.gcount()));
  const auto found = [&](MovieContainer kind, const char* container) {
    if (name) *name = container;
    return kind;
  };
  for (const Signature& signature : kSignatures) {
    if (bytes.size() < signature.at + signature.bytes.size() ||
        bytes.substr(signature.at, signature.bytes.size()) != signature.bytes)
      continue;
    if (signature.bytes == "ftyp" && bytes.size() >= 12 && is_still(bytes.substr(8, 4))) return MovieContainer::none;
    return found(signature.kind, signature.name);
  }
  // Transport streams have no name, but a mark at the start of every packet.
  constexpr std::size_t kPacket = 188;
  if (bytes.size() == head.size() && bytes[0] == 'G' && bytes[kPacket] == 'G' && bytes[2 * kPacket] == 'G')
    return found(MovieContainer::unreadable_movie, "MPEG transport stream");
  return MovieContainer::none;
}

Size Movie::size() const { return file_->parts()[static_cast<std::size_t>(color_.part)].data_window.size(); }

Result<std::unique_ptr<Movie>> Movie::open(const std::filesystem::path& file, const SizeLimits& limits,
                                           Diagnostics& diagnostics) {
  AFTERGLOW_TRY(std::unique_ptr<PictureFile> opened, open_picture(file, limits));
  if (opened->frames() < 1)
    return Error{ErrorKind::io, "is a video that says of no frame where it is; remultiplex it with ffmpeg -c copy",
                 file.string()};
  std::unique_ptr<Movie> movie(new Movie());
  auto color = find_color(opened->parts(), "");
  if (!color) return Error{ErrorKind::io, color.error().message, file.string()};
  movie->color_ = std::move(color).value();
  movie->encoding_ = opened->color_encoding(movie->color_, diagnostics);
  movie->facts_ = std::make_shared<const FileFacts>(opened->facts(movie->color_));
  movie->frames_ = opened->frames();
  movie->fps_ = opened->frames_per_second();
  movie->file_ = std::move(opened);
  return movie;
}

Result<Picture> Movie::read(int frame) {
  const std::string name = file_->path().string();
  if (frame < 0 || frame >= frames_)
    return Error{ErrorKind::io, fmt::format("has no frame {}; it has {}", frame + 1, frames_), name};
  try {
    Picture picture;
    const FilePart& part = file_->parts()[static_cast<std::size_t>(color_.part)];
    picture.color = Image(part.data_window.width, part.data_window.height, 4);
    picture.data_window = part.data_window;
    picture.display_window = part.display_window;
    picture.has_alpha = color_.channels[3] >= 0;
    picture.facts = facts_;
    std::vector<ReadTarget> targets;
    for (std::size_t c = 0; c < 4; ++c)
      if (color_.channels[c] >= 0 && (c == 0 || color_.channels[c] != color_.channels[c - 1]))
        targets.push_back({color_.channels[c], picture.color.pixels.data() + c, 4,
                           static_cast<std::size_t>(picture.color.width) * 4});
    {
      const std::lock_guard lock(mutex_);
      file_->select_frame(frame);
      if (auto read = file_->read(color_.part, targets); !read) {
        Error error = std::move(read).error();
        error.message = fmt::format("frame {} {}", frame + 1, error.message);
        return error;
      }
    }
    decode_color(encoding_, picture.color, picture.sanitized);
    return picture;
  } catch (const std::exception& error) {
    return Error{ErrorKind::io, "cannot be read: " + exception_text(error), name};
  }
}

}  // namespace afterglow

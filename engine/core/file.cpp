// SPDX-License-Identifier: MIT
#include "core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include "core/ascii.h"
#include "core/file_descriptor.h"
#include "core/file_record.h"
#include "core/temporary.h"
#include "core/text.h"

namespace afterglow {
namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostNames = 4096;  ///< of a folder that are looked at

bool looks_like_frame(const fs::path& path) {
  const std::string stem = path.stem().string();
  return std::ranges::adjacent_find(stem, [](char a, char b) { return is_digit(a) && is_digit(b); }) != stem.end();
}

std::string without_digits(std::string name) {
  std::erase_if(name, is_digit);
  return name;
}

/// Names in the folder of a file that could be meant by its name: no hidden ones, no copies of editors, no other
/// numbers.
std::vector<std::string> names_beside(const fs::path& path) {
  const std::string wanted = without_digits(path.filename().string());
  std::vector<std::string> names = names_in(path.parent_path());
  std::erase_if(names, [&](const std::string& name) {
    return name.front() == '.' || name.back() == '~' || without_digits(name) == wanted;
  });
  return names;
}

/// Nobody can say whether it is there.
bool is_unseen(const fs::file_status& status) { return status.type() == fs::file_type::none; }

Error unseen(const fs::path& path, const std::error_code& why) {
  return {ErrorKind::io, fmt::format("cannot be read: {}", why.message()), path.string()};
}

Result<void> write_stream(const fs::path& path, std::string_view content) {
  const auto failed = [&] {
    const char* why = errno == ENXIO ? "nobody reads it" : std::strerror(errno);
    return Error{ErrorKind::io, fmt::format("cannot be written: {}", why), path.string()};
  };
  // A pipe that nobody reads would wait for ever.
  const int out = open(path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NONBLOCK);
  if (out < 0) return failed();
  fcntl(out, F_SETFL, O_APPEND);
  if (!write_all(out, content)) {
    const Error error = failed();
    close(out);
    return error;
  }
  return close(out) == 0 ? Result<void>() : failed();
}

}  // namespace

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code ec;
  for (fs::directory_iterator it(folder.empty() ? "." : folder, ec), end; !ec && it != end && names.size() < kMostNames;
       it.increment(ec))
    names.push_back(it->path().filename().string());
  std::ranges::sort(names);  // folders have no order
  return names;
}

Error missing_file(const fs::path& path) {
  std::error_code ec;
  if (is_unseen(fs::status(path, ec))) return unseen(path, ec);
  Error error{ErrorKind::io, "no such file", path.string()};
  if (std::string name = path.filename().string(); name.find('@') != std::string::npos) {
    std::ranges::replace(name, '@', '#');
    error.message += "; the place of a frame's number is written #";
    error.nearest = (path.parent_path() / name).string();
    return error;
  }
  if (looks_like_frame(path)) return error;
  const std::string near = nearest_name(path.filename().string(), names_beside(path));
  if (!near.empty()) error.nearest = (path.parent_path() / near).string();
  return error;
}

bool is_file(const fs::path& path, FileRecord* record) {
  if (record && record->keeps(path)) return true;
  if (record) record->note(path, FileProbe::Kind::existence);
  std::error_code ec;
  return fs::is_regular_file(path, ec);
}

namespace {

/// Gives the content piece by piece. Errors: those of `take`, and as read_file.
template <class Take>
Result<void> read_pieces(const fs::path& path, Take&& take) {
  std::error_code ec;
  const auto status = fs::status(path, ec);
  if (is_unseen(status)) return unseen(path, ec);
  if (!fs::exists(status)) return Error{ErrorKind::io, "no such file", path.string()};
  if (fs::is_directory(status)) return Error{ErrorKind::io, "is a folder, not a file", path.string()};
  // Reading a pipe waits for whoever may write it, which may be nobody.
  if (fs::is_fifo(status)) return Error{ErrorKind::io, "is a pipe, not a file", path.string()};
  std::ifstream in(path, std::ios::binary);
  if (!in) return Error{ErrorKind::io, fmt::format("cannot be read: {}", std::strerror(errno)), path.string()};
  char buffer[65536];
  while (in.read(buffer, sizeof buffer) || in.gcount() > 0)
    AFTERGLOW_CHECK(take(std::string_view(buffer, static_cast<std::size_t>(in.gcount()))));
  if (in.bad()) return Error{ErrorKind::io, "read error", path.string()};
  return {};
}

}  // namespace

Result<std::string> read_file(const fs::path& path, std::size_t limit, FileRecord* record) {
  if (record)
    if (auto text = record->kept(path)) return *std::move(text);
  FileRecord::Reading reading(record, path);
  std::string content;
  AFTERGLOW_CHECK(read_pieces(path, [&](std::string_view piece) -> Result<void> {
    content.append(piece);
    if (content.size() <= limit) return {};
    return Error{ErrorKind::io, fmt::format("is larger than {} bytes", limit), path.string()};
  }));
  reading.done(content);
  return content;
}

Result<Hash> hash_file(const fs::path& path) {
  HashStream stream;
  AFTERGLOW_CHECK(read_pieces(path, [&](std::string_view piece) -> Result<void> {
    stream.add(piece);
    return {};
  }));
  return stream.finish();
}

Result<std::string> read_named_file(const fs::path& path, std::size_t limit, FileRecord* record) {
  auto content = read_file(path, limit, record);
  std::error_code ec;
  if (!content && !fs::exists(path, ec)) return missing_file(path);
  return content;
}

bool is_disk_full(const Error& error) {
  const auto says = [&](int reason) { return error.message.find(std::strerror(reason)) != std::string::npos; };
  return error.kind == ErrorKind::io && (says(ENOSPC) || says(EDQUOT));
}

Result<void> write_file_atomically(const fs::path& path, std::string_view content) {
  if (is_stream(path)) return write_stream(path, content);
  Temporary temporary(path);
  std::ofstream out(temporary.path(), std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out) {
    const int reason = errno;
    return Error{ErrorKind::io, fmt::format("cannot be written: {}", std::strerror(reason)), path.string()};
  }
  return temporary.commit();
}

}  // namespace afterglow

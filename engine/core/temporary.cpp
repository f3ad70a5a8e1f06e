// SPDX-License-Identifier: MIT
#include "core/temporary.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/file_descriptor.h"
#include "core/hash.h"
#include "core/printable.h"

namespace afterglow {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMachineDigits = 8;
constexpr int kMostLinks = 40;           // as many as Linux follows
constexpr std::size_t kMostName = 96;    // bytes: with the mark below 143, the least that file systems take
constexpr std::size_t kMostEnding = 12;  // no format's is longer

/// Processes with the same one can tell by their numbers whether they live: they share a running kernel and its
/// numbers.
const std::string& machine() {
  static const std::string name = [] {
    std::string boot;
    std::ifstream("/proc/sys/kernel/random/boot_id") >> boot;
    struct stat numbers {};
    if (stat("/proc/self/ns/pid", &numbers) != 0) numbers.st_ino = 0;
    return Hasher().add(boot).add(static_cast<std::uint64_t>(numbers.st_ino)).finish().hex().substr(0, kMachineDigits);
  }();
  return name;
}

/// The process of a name that temporary_beside made on this machine; 0: it is none.
pid_t process_of(std::string_view name) {
  const std::size_t end = name.rfind(".tmp");
  const std::string mark = "." + machine() + "-";
  const std::size_t begin = name.substr(0, end).rfind(mark);
  if (!name.starts_with('.') || end == std::string_view::npos || begin == std::string_view::npos) return 0;
  const std::string_view numbers = name.substr(begin + mark.size(), end - begin - mark.size());
  pid_t process = 0;
  unsigned count = 0;
  const auto first = std::from_chars(numbers.data(), numbers.data() + numbers.size(), process);
  if (first.ec != std::errc() || first.ptr == numbers.data() + numbers.size() || *first.ptr != '-') return 0;
  const auto second = std::from_chars(first.ptr + 1, numbers.data() + numbers.size(), count);
  return second.ec == std::errc() && second.ptr == numbers.data() + numbers.size() ? process : 0;
}

/// The names given last, where a signal handler can read them.
struct Given {
  std::atomic<bool> whole{false};
  std::array<char, 4096> path{};
};
constexpr std::size_t kGiven = 64;  // more than are written at a time
std::array<Given, kGiven> g_given;

void remember(unsigned count, const std::string& path) {
  Given& given = g_given[count % kGiven];
  given.whole = false;
  if (path.size() >= given.path.size()) return;
  path.copy(given.path.data(), path.size());
  given.path[path.size()] = '\0';
  given.whole = true;
}

/// One that was killed and that nobody has asked after (a zombie) does not: in a container it may stay so for ever.
bool lives(pid_t process) {
  if (kill(process, 0) != 0 && errno == ESRCH) return false;
  std::ifstream file(fmt::format("/proc/{}/stat", process));
  std::string line;
  std::getline(file, line);
  const std::size_t state = line.rfind(')') + 2;  // npos + 2 is 1
  return line.size() <= state || (line[state] != 'Z' && line[state] != 'X');
}

/// By the open file: a confined process may not by its name (core/confine_calls.h).
void give_mode(const fs::path& path, fs::perms mode) {
  const FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  if (file.get() >= 0) (void)!fchmod(file.get(), static_cast<mode_t>(mode));
}

}  // namespace

fs::path temporary_beside(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  const unsigned count = counter++;
  const auto name = fmt::format(".{}.{}-{}.tmp{}", cut_utf8(path.stem().string(), kMostName), temporary_mark(), count,
                                cut_utf8(path.extension().string(), kMostEnding));
  fs::path temporary = path.parent_path() / name;
  remember(count, temporary.string());
  return temporary;
}

fs::path behind_links(const fs::path& path) {
  fs::path at = path;
  std::error_code ec;
  for (int links = 0; links < kMostLinks && fs::is_symlink(at, ec); ++links) {
    const fs::path next = fs::read_symlink(at, ec);
    if (ec) break;
    at = at.parent_path() / next;
  }
  return at;
}

Result<void> check_replaceable(const fs::path& path) {
  if (access(path.c_str(), W_OK) == 0 || errno == ENOENT) return {};
  return Error{ErrorKind::io, fmt::format("cannot be written: {}", std::strerror(errno)), path.string()};
}

bool is_stream(const fs::path& path) {
  const std::string name = path.string();
  for (const char* of_processes : {"/dev/std", "/dev/fd/", "/proc/"})
    if (name.starts_with(of_processes)) return true;
  std::error_code ec;
  const auto status = fs::status(path, ec);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

Temporary::Temporary(fs::path target)
    : named_(std::move(target)), target_(behind_links(named_)), path_(temporary_beside(target_)) {}

Temporary::~Temporary() {
  if (!there_ || unlink(path_.c_str()) == 0 || errno == ENOENT) return;
  try {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  } catch (...) {  // no memory for a walk through a folder
  }
}

Result<void> Temporary::commit() {
  AFTERGLOW_CHECK(check_replaceable(named_));
  std::error_code ec, ignored;
  if (const auto there = fs::status(target_, ignored); fs::is_regular_file(there))
    give_mode(path_, there.permissions());
  fs::rename(path_, target_, ec);
  there_ = static_cast<bool>(ec);
  if (ec) return Error{ErrorKind::io, fmt::format("cannot be written: {}", ec.message()), named_.string()};
  return {};
}

void remove_own_temporaries() noexcept {
  for (const auto& given : g_given)
    if (given.whole) unlink(given.path.data());
}

int remove_abandoned_temporaries(const fs::path& folder) {
  int removed = 0;
  std::error_code ec, ignored;
  for (fs::directory_iterator it(folder.empty() ? fs::path(".") : folder, ec), end; !ec && it != end;
       it.increment(ec)) {
    const pid_t process = process_of(it->path().filename().string());
    if (process > 0 && !lives(process) && it->is_regular_file(ignored) && fs::remove(it->path(), ignored)) ++removed;
  }
  return removed;
}

std::string temporary_mark() { return fmt::format("{}-{}", machine(), getpid()); }

int remove_temporaries_of(const std::string& mark, const fs::path& folder) {
  const pid_t process = process_of(fmt::format(".{}-0.tmp", mark));
  if (process > 0 && lives(process)) return 0;
  int removed = 0;
  std::error_code ec, ignored;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    const std::string name = it->path().filename().string();
    const bool theirs = name.starts_with('.') && name.find("." + mark + "-") != std::string::npos &&
                        name.find(".tmp") != std::string::npos;
    if (theirs && it->is_regular_file(ignored) && fs::remove(it->path(), ignored)) ++removed;
  }
  return removed;
}

}  // namespace afterglow

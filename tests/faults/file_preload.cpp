// SPDX-License-Identifier: MIT
// Preloaded before the program (LD_PRELOAD): what disks and other programs do to its files.
//
//   AFTERGLOW_FAULT_ROOT=FOLDER  only files in it are touched
//   AFTERGLOW_FAULT_KIND=…       error: the Nth call fails with EIO
//                                full: from the Nth write on the disk is full
//                                kill: the process dies before the Nth call
//                                interrupt: it gets a SIGINT before the Nth call, as from Ctrl-C
//                                terminate: it gets a SIGTERM there, as from a scheduler
//                                stall: from the Nth read on none comes back, as on a network that is gone
//                                circle: the file never ends: its last 188 bytes come again and again
//                                writes, reads: such calls do a few bytes each, and every third is interrupted first
//                                cut: at the Nth read the file becomes half as long
//                                swap: at the Nth read every byte of the file becomes another
//   AFTERGLOW_FAULT_CALL=N       from 1; 0: none
//   AFTERGLOW_FAULT_LOG=FILE     written at each call: its number, its name and the file
#include <dlfcn.h>
#include <fcntl.h>
#include <limits.h>
#include <stdarg.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#define EXPORT extern "C" __attribute__((visibility("default")))

namespace {

enum class What { other, read, write };
enum class Kind { none, error, full, kill, interrupt, terminate, stall, circle, writes, reads, cut, swap };

/// The next definition of a function behind ours.
template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

struct Wanted {
  std::string root = variable("AFTERGLOW_FAULT_ROOT"), log = variable("AFTERGLOW_FAULT_LOG");
  Kind kind = Kind::none;
  long call = std::atol(variable("AFTERGLOW_FAULT_CALL").c_str());
  Wanted() {
    const std::string name = variable("AFTERGLOW_FAULT_KIND");
    kind = name == "error"       ? Kind::error
           : name == "full"      ? Kind::full
           : name == "kill"      ? Kind::kill
           : name == "interrupt" ? Kind::interrupt
           : name == "terminate" ? Kind::terminate
           : name == "stall"     ? Kind::stall
           : name == "circle"    ? Kind::circle
           : name == "writes"    ? Kind::writes
           : name == "reads"     ? Kind::reads
           : name == "cut"       ? Kind::cut
           : name == "swap"      ? Kind::swap
                                 : Kind::none;
  }
};

const Wanted& wanted() {
  static const Wanted& wanted = *new Wanted;  // files are read after the last destructor too
  return wanted;
}

bool is_ours(const std::string& path) {
  const auto& root = wanted().root;
  return !root.empty() && path.compare(0, root.size(), root) == 0;
}

std::string path_of(int file) {
  char link[64], path[PATH_MAX];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t size = readlink(link, path, sizeof path);
  return size > 0 ? std::string(path, static_cast<std::size_t>(size)) : "";
}

std::string path_of(int folder, const char* name) {
  if (name[0] == '/') return name;
  if (folder == AT_FDCWD) {
    char here[PATH_MAX];
    return getcwd(here, sizeof here) ? std::string(here) + "/" + name : name;
  }
  return path_of(folder) + "/" + name;
}

bool counts(What what) {
  switch (wanted().kind) {
    case Kind::full:
      return what == What::write;
    case Kind::cut:
    case Kind::stall:
    case Kind::swap:
      return what == What::read;
    default:
      return true;
  }
}

void damage(const std::string& path) {
  const int file = static_cast<int>(syscall(SYS_openat, AT_FDCWD, path.c_str(), O_RDWR | O_CLOEXEC, 0));
  struct stat status {};
  if (file < 0 || fstat(file, &status) != 0) return;
  if (wanted().kind == Kind::cut) {
    static_cast<void>(syscall(SYS_ftruncate, file, status.st_size / 2));
  } else {
    for (off_t at = 0; at < status.st_size; ++at) {
      unsigned char byte = 0;
      if (syscall(SYS_pread64, file, &byte, 1, at) != 1) break;
      byte = static_cast<unsigned char>(~byte);
      static_cast<void>(syscall(SYS_pwrite64, file, &byte, 1, at));
    }
  }
  syscall(SYS_close, file);
}

/// Before a call that touches `path`: the error that it fails with, or 0.
int strike(const char* name, const std::string& path, What what) {
  static std::atomic<long> calls{0};
  if (!is_ours(path) || !counts(what)) return 0;
  const long number = ++calls;
  if (!wanted().log.empty()) {
    const std::string line = std::to_string(number) + " " + name + " " + path + "\n";
    const int log = static_cast<int>(
        syscall(SYS_openat, AT_FDCWD, wanted().log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
    static_cast<void>(syscall(SYS_write, log, line.data(), line.size()));
    syscall(SYS_close, log);
  }
  if (wanted().call == 0 || number < wanted().call) return 0;
  if (wanted().kind == Kind::full) return ENOSPC;
  while (wanted().kind == Kind::stall) pause();
  if (number > wanted().call) return 0;
  if (wanted().kind == Kind::error) return EIO;
  if (wanted().kind == Kind::kill) syscall(SYS_kill, getpid(), SIGKILL);
  if (wanted().kind == Kind::interrupt) syscall(SYS_kill, getpid(), SIGINT);
  if (wanted().kind == Kind::terminate) syscall(SYS_kill, getpid(), SIGTERM);
  if (wanted().kind == Kind::cut || wanted().kind == Kind::swap) damage(path);
  return 0;
}

/// How many of `size` bytes a read or a write does; -1 with EINTR: none yet.
ssize_t most(const std::string& path, std::size_t size, What what) {
  static std::atomic<unsigned> turns{0};
  constexpr std::size_t kFew = 1021;
  const bool fits = wanted().kind == (what == What::write ? Kind::writes : Kind::reads);
  if (!fits || !is_ours(path)) return static_cast<ssize_t>(size);
  if (++turns % 3 == 0) {
    errno = EINTR;
    return -1;
  }
  return static_cast<ssize_t>(size < kFew ? (size + 1) / 2 : kFew);
}

template <typename Value>
Value failed(int error, Value value) {
  errno = error;
  return value;
}

/// Shared by all reads and writes: `go` does the real call with so many bytes.
template <typename Go>
ssize_t transfer(const char* name, int file, std::size_t size, What what, Go go) {
  const std::string path = path_of(file);
  if (const int error = strike(name, path, what)) return failed<ssize_t>(error, -1);
  const ssize_t bytes = most(path, size, what);
  return bytes < 0 ? bytes : go(static_cast<std::size_t>(bytes));
}

mode_t mode_of(int flags, va_list arguments) {
  return flags & (O_CREAT | O_TMPFILE) ? static_cast<mode_t>(va_arg(arguments, unsigned)) : 0;
}

int open_file(const char* name, int folder, const char* path, int flags, mode_t mode) {
  if (const int error = strike(name, path_of(folder, path), What::other)) return failed(error, -1);
  return static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
}

std::FILE* open_stream(const char* name, const char* path, const char* mode) {
  if (const int error = strike(name, path_of(AT_FDCWD, path), What::other)) return failed<std::FILE*>(error, nullptr);
  return next<std::FILE*(const char*, const char*)>(name)(path, mode);
}

}  // namespace

#define OPEN(name)                                        \
  EXPORT int name(const char* path, int flags, ...) {     \
    va_list arguments;                                    \
    va_start(arguments, flags);                           \
    const mode_t mode = mode_of(flags, arguments);        \
    va_end(arguments);                                    \
    return open_file(#name, AT_FDCWD, path, flags, mode); \
  }
OPEN(open)
OPEN(open64)
#define OPENAT(name)                                              \
  EXPORT int name(int folder, const char* path, int flags, ...) { \
    va_list arguments;                                            \
    va_start(arguments, flags);                                   \
    const mode_t mode = mode_of(flags, arguments);                \
    va_end(arguments);                                            \
    return open_file(#name, folder, path, flags, mode);           \
  }
OPENAT(openat)
OPENAT(openat64)
EXPORT std::FILE* fopen(const char* path, const char* mode) { return open_stream("fopen", path, mode); }
EXPORT std::FILE* fopen64(const char* path, const char* mode) { return open_stream("fopen64", path, mode); }

EXPORT ssize_t read(int file, void* data, std::size_t size) {
  const auto go = [&](std::size_t n) { return syscall(SYS_read, file, data, n); };
  const ssize_t got = transfer("read", file, size, What::read, go);
  constexpr off_t kPacket = 188;  // of MPEG transport streams
  const bool again = got == 0 && wanted().kind == Kind::circle && is_ours(path_of(file)) &&
                     syscall(SYS_lseek, file, -kPacket, SEEK_END) >= 0;
  return again ? go(size) : got;
}
/// Whether it lies in memory is the system's to know, not ours.
#define PREADV2(name)                                                                        \
  EXPORT ssize_t name(int file, const iovec* parts, int count, off64_t at, int flags) {      \
    if (is_ours(path_of(file))) return failed<ssize_t>(EOPNOTSUPP, -1);                      \
    return syscall(SYS_preadv2, file, parts, count, static_cast<long>(at), at >> 63, flags); \
  }
PREADV2(preadv2)
PREADV2(preadv64v2)
EXPORT ssize_t write(int file, const void* data, std::size_t size) {
  return transfer("write", file, size, What::write, [&](std::size_t n) { return syscall(SYS_write, file, data, n); });
}
#define PREAD(name)                                                                          \
  EXPORT ssize_t name(int file, void* data, std::size_t size, off64_t at) {                  \
    return transfer(#name, file, size, What::read,                                           \
                    [&](std::size_t n) { return syscall(SYS_pread64, file, data, n, at); }); \
  }
PREAD(pread)
PREAD(pread64)
#define PWRITE(name)                                                                          \
  EXPORT ssize_t name(int file, const void* data, std::size_t size, off64_t at) {             \
    return transfer(#name, file, size, What::write,                                           \
                    [&](std::size_t n) { return syscall(SYS_pwrite64, file, data, n, at); }); \
  }
PWRITE(pwrite)
PWRITE(pwrite64)
EXPORT ssize_t writev(int file, const iovec* parts, int count) {
  const std::string path = path_of(file);
  if (const int error = strike("writev", path, What::write)) return failed<ssize_t>(error, -1);
  if (wanted().kind == Kind::writes && is_ours(path) && count > 0) {
    const ssize_t bytes = most(path, parts->iov_len, What::write);
    return bytes < 0 ? bytes : syscall(SYS_write, file, parts->iov_base, static_cast<std::size_t>(bytes));
  }
  return syscall(SYS_writev, file, parts, count);
}

EXPORT int close(int file) {
  const int error = strike("close", path_of(file), What::other);
  const auto done = static_cast<int>(syscall(SYS_close, file));  // a failed close closes
  return error ? failed(error, -1) : done;
}
EXPORT int fsync(int file) {
  if (const int error = strike("fsync", path_of(file), What::other)) return failed(error, -1);
  return static_cast<int>(syscall(SYS_fsync, file));
}
EXPORT int rename(const char* from, const char* to) {
  if (const int error = strike("rename", path_of(AT_FDCWD, to), What::other)) return failed(error, -1);
  return static_cast<int>(syscall(SYS_rename, from, to));
}
EXPORT int mkdir(const char* path, mode_t mode) {
  if (const int error = strike("mkdir", path_of(AT_FDCWD, path), What::other)) return failed(error, -1);
  return static_cast<int>(syscall(SYS_mkdir, path, mode));
}
EXPORT int unlink(const char* path) {
  if (const int error = strike("unlink", path_of(AT_FDCWD, path), What::other)) return failed(error, -1);
  return static_cast<int>(syscall(SYS_unlink, path));
}

// SPDX-License-Identifier: MIT
#include "core/patient_reader.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "core/text.h"

namespace afterglow {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFilesWait{300'000};
constexpr milliseconds kLook{50};  // after which it is seen that nobody waits any more
constexpr std::size_t kMostBytes = 1 << 18;

Error unreadable(int code) { return {ErrorKind::io, fmt::format("cannot be read: {}", std::strerror(code))}; }

}  // namespace

/// Of one read.
class PatientReader::Wait {
 public:
  explicit Wait(const PatientReader& reader) : reader_(reader) {}
  /// Why it is no use to look again.
  std::optional<Error> over() const {
    const auto is_set = [](const std::atomic<bool>* flag) { return flag && *flag; };
    if (is_set(reader_.cancelled_) || is_set(reader_.patience_.given_up))
      return Error{ErrorKind::interrupted, "interrupted"};
    const milliseconds most = reader_.patience_.most.value_or(reader_.is_file_ ? kFilesWait : milliseconds(0));
    if (most.count() == 0 || std::chrono::steady_clock::now() - begin_ < most) return std::nullopt;
    return Error{ErrorKind::io,
                 fmt::format("has given no bytes for {} s (AFTERGLOW_INPUT_TIMEOUT says how long to wait, 0: for ever)",
                             number_text(static_cast<float>(most.count()) / 1000))};
  }

 private:
  const PatientReader& reader_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// A thread that may stay in the system's hands for ever; it and the reader share this.
struct PatientReader::Worker {
  explicit Worker(std::shared_ptr<FileDescriptor> file) : from(std::move(file)) {}
  std::shared_ptr<FileDescriptor> from;
  std::mutex mutex;
  std::condition_variable changed;
  std::size_t wanted = 0;      ///< bytes; 0: nothing is asked for
  std::optional<ssize_t> got;  ///< what the system answered
  int code = 0;
  bool ends = false;
  std::vector<char> bytes;

  void run() {
    std::unique_lock lock(mutex);
    while (true) {
      changed.wait(lock, [&] { return ends || wanted > 0; });
      if (ends) return;
      const std::size_t size = std::exchange(wanted, 0);
      bytes.resize(std::max(bytes.size(), size));
      lock.unlock();
      const ssize_t count = ::read(from->get(), bytes.data(), size);
      const int problem = errno;
      lock.lock();
      got = count;
      code = problem;
      changed.notify_all();
    }
  }
};

PatientReader::PatientReader(std::shared_ptr<FileDescriptor> from, Patience patience,
                             const std::atomic<bool>* cancelled)
    : from_(std::move(from)), patience_(patience), cancelled_(cancelled) {
  struct stat status {};
  is_file_ = fstat(from_->get(), &status) == 0 && (S_ISREG(status.st_mode) || S_ISBLK(status.st_mode));
}

PatientReader::~PatientReader() {
  if (!worker_) return;
  const std::lock_guard lock(worker_->mutex);
  worker_->ends = true;
  worker_->changed.notify_all();
}

Result<std::size_t> PatientReader::read(void* to, std::size_t size) {
  if (over_) return *over_;
  return is_file_ ? read_file(to, size) : read_when_ready(to, size);
}

Result<std::size_t> PatientReader::read_when_ready(void* to, std::size_t size) {
  for (const Wait wait(*this);;) {
    pollfd waiting{.fd = descriptor(), .events = POLLIN, .revents = 0};
    const int ready = poll(&waiting, 1, static_cast<int>(kLook.count()));
    if ((over_ = wait.over()) && (ready <= 0 || over_->kind == ErrorKind::interrupted)) return *over_;
    over_.reset();
    if (ready <= 0) continue;
    const ssize_t got = ::read(descriptor(), to, size);
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR && errno != EAGAIN) return unreadable(errno);
  }
}

/// False: there are no more threads to be had.
bool PatientReader::start_worker() {
  auto worker = std::make_shared<Worker>(from_);
  try {
    std::thread([worker] { worker->run(); }).detach();
  } catch (const std::system_error&) {
    return false;
  }
  worker_ = std::move(worker);
  return true;
}

/// As long as the system takes.
Result<std::size_t> PatientReader::read_now(void* to, std::size_t size) {
  while (true) {
    const ssize_t got = ::read(descriptor(), to, size);
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR) return unreadable(errno);
  }
}

Result<std::size_t> PatientReader::read_file(void* to, std::size_t size) {
  while (asks_memory_) {
    const iovec part{to, size};
    constexpr off64_t kHere = -1;
    const ssize_t got = preadv2(descriptor(), &part, 1, kHere, RWF_NOWAIT);
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno == EINTR) continue;
    asks_memory_ = errno == EAGAIN;
    break;
  }
  return read_by_worker(to, size);
}

Result<std::size_t> PatientReader::read_by_worker(void* to, std::size_t size) {
  if (!worker_ && !start_worker()) return read_now(to, size);
  Worker& worker = *worker_;
  std::unique_lock lock(worker.mutex);
  for (const Wait wait(*this);;) {
    worker.got.reset();
    worker.wanted = std::min(size, kMostBytes);
    worker.changed.notify_all();
    while (!worker.changed.wait_for(lock, kLook, [&] { return worker.got.has_value(); }))
      if ((over_ = wait.over())) return *over_;
    if (*worker.got >= 0) break;
    if (worker.code != EINTR) return unreadable(worker.code);
  }
  const auto count = static_cast<std::size_t>(*worker.got);
  std::memcpy(to, worker.bytes.data(), count);
  return count;
}

}  // namespace afterglow

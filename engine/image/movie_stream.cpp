// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <future>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "core/beside.h"
#include "core/patient_reader.h"
#include "core/text.h"
#include "image/ffmpeg_module.h"
#include "image/movie.h"
#include "image/several_pictures.h"

namespace afterglow {
namespace {

using namespace std::string_view_literals;
constexpr const char* kName = "-";

Error in_stream(std::string why, ErrorKind kind = ErrorKind::io) { return {kind, std::move(why), kName}; }

/// What can be read as it comes, by its first bytes: FFmpeg's name of it.
std::string stream_format(std::string_view head) {
  if (head.starts_with("YUV4MPEG2"sv)) return "yuv4mpegpipe";
  if (head.starts_with("nut/multimedia container\0"sv)) return "nut";
  if (head.starts_with("\x1a\x45\xdf\xa3"sv)) return "matroska";
  constexpr std::size_t kPacket = 188;
  if (head.size() > kPacket && head[0] == 'G' && head[kPacket] == 'G') return "mpegts";
  if (head.size() < 3 || head[0] != 'P' || " \t\r\n#"sv.find(head[2]) == std::string_view::npos) return "";
  switch (head[1]) {
    case '2':
    case '5':
      return "pgm_pipe";
    case '3':
    case '6':
      return "ppm_pipe";
    case '7':
      return "pam_pipe";
    case 'F':
    case 'f':
      return "pfm_pipe";
    default:
      return "";
  }
}

/// "1920x1080:rgb48le:24" as options of FFmpeg's demuxer.
Result<std::string> raw_options(const std::string& raw) {
  const std::vector<std::string> parts = split(raw, ':');
  const auto wrong = [&] {
    return Error{ErrorKind::usage, fmt::format("'{}' is no format of raw frames", raw), "--raw", 0,
                 "WIDTHxHEIGHT:PIXELS[:FPS], as 1920x1080:rgb48le:24; pixels by FFmpeg's names"};
  };
  if (parts.size() < 2 || parts.size() > 3) return wrong();
  const auto digits = [](const std::string& text, const char* allowed) {
    return !text.empty() && text.find_first_not_of(allowed) == std::string::npos;
  };
  const std::vector<std::string> sides = split(parts[0], 'x');
  if (sides.size() != 2 || !digits(sides[0], "0123456789") || !digits(sides[1], "0123456789")) return wrong();
  if (!digits(parts[1], "abcdefghijklmnopqrstuvwxyz0123456789_")) return wrong();
  if (parts.size() == 3 && !digits(parts[2], "0123456789./")) return wrong();
  return fmt::format("video_size={}:pixel_format={}:framerate={}", parts[0], parts[1],
                     parts.size() == 3 ? parts[2] : "24");
}

/// An error of a reader, of this input.
Error of_stream(Error error) {
  error.file = kName;
  return error;
}

/// As many bytes as tell what it is, or all that there are.
Result<std::string> first_bytes(PatientReader& from) {
  std::array<char, 400> bytes{};
  std::size_t have = 0;
  while (have < bytes.size()) {
    const auto got = from.read(bytes.data() + have, bytes.size() - have);
    if (!got) return of_stream(got.error());
    if (*got == 0) break;
    have += *got;
  }
  if (have == 0) return in_stream("nothing comes on standard input");
  return std::string(bytes.data(), have);
}

/// What has come so far, for as long as it is looked at.
class Mapped {
 public:
  Mapped(int descriptor, std::size_t size) : size_(size) {
    bytes_ = size > 0 ? mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0) : MAP_FAILED;
  }
  ~Mapped() {
    if (bytes_ != MAP_FAILED) munmap(bytes_, size_);
  }
  Mapped(const Mapped&) = delete;
  Mapped& operator=(const Mapped&) = delete;
  std::string_view bytes() const {
    return bytes_ == MAP_FAILED ? std::string_view() : std::string_view(static_cast<const char*>(bytes_), size_);
  }

 private:
  std::size_t size_;
  void* bytes_;
};

/// A file that was read to its end, or the beginning of frames that a video reader takes.
struct WholeFile {
  std::shared_ptr<const MemoryFile> file;
  std::string head;  ///< of a stream of frames; "": it is a file
};

/// Looks for a second picture behind the first each time that twice as much has come, so that neither a long stream is
/// read to its end in vain nor its bytes are looked at over and over.
Result<WholeFile> whole_file(PatientReader& from, const std::string& head, const SizeLimits& limits) {
  WholeFile whole;
  AFTERGLOW_TRY(MemoryFile file, MemoryFile::create());
  const FileDescriptor out(::open(file.name().c_str(), O_RDWR | O_CLOEXEC));
  std::uint64_t size = 0;
  const auto look = [&]() -> Result<void> {
    const Mapped so_far(out.get(), size);
    const auto several = first_of_several(so_far.bytes());
    if (several && several->video.empty())
      return in_stream(
          fmt::format("holds several {}s; frames come as PPM, PAM, PFM, Y4M, JPEG or a video", several->kind));
    if (several) whole.head = so_far.bytes();
    return {};
  };
  const auto put = [&](const char* bytes, std::size_t count) -> Result<void> {
    size += count;
    if (size > limits.max_bytes) return in_stream("is larger than --max-memory allows");
    while (count > 0) {
      const ssize_t written = ::write(out.get(), bytes, count);
      if (written < 0 && errno == EINTR) continue;
      if (written <= 0) return in_stream("there is no memory for what comes on standard input");
      bytes += written;
      count -= static_cast<std::size_t>(written);
    }
    return {};
  };
  AFTERGLOW_CHECK(put(head.data(), head.size()));
  std::vector<char> buffer(1 << 16);
  std::uint64_t next_look = 2 * size;
  while (whole.head.empty()) {
    const auto got = from.read(buffer.data(), buffer.size());
    if (!got) return of_stream(got.error());
    AFTERGLOW_CHECK(put(buffer.data(), *got));
    if (*got == 0 || size >= next_look) AFTERGLOW_CHECK(look());
    if (size >= next_look) next_look = 2 * size;
    if (*got == 0) break;
  }
  whole.file = std::make_shared<const MemoryFile>(std::move(file));
  return whole;
}

}  // namespace

struct MovieStream::State {
  std::unique_ptr<MovieFrames> frames;
  std::atomic<bool> cancelled = false;
  std::optional<long long> first;  ///< time stamp
  double fps = 0;
  std::future<Result<std::shared_ptr<MovieSource>>> coming;
};

Result<std::unique_ptr<MovieStream>> MovieStream::open(std::shared_ptr<FileDescriptor> from, std::string head,
                                                       const std::string& raw, const SizeLimits& limits,
                                                       Diagnostics& diagnostics) {
  std::unique_ptr<MovieStream> stream(new MovieStream());
  stream->state_ = std::make_unique<State>();
  StreamRequest request{.from = std::move(from),
                        .head = std::move(head),
                        .name = kName,
                        .format = "rawvideo",
                        .options = {},
                        .limits = limits,
                        .patience = {},
                        .cancelled = &stream->state_->cancelled};
  AFTERGLOW_TRY(request.patience, patience_of_process());
  if (!raw.empty()) {
    AFTERGLOW_TRY(request.options, raw_options(raw));
  } else {
    request.format = stream_format(request.head);
    const auto several = request.format.empty() ? first_of_several(request.head) : std::nullopt;
    if (several) request.format = several->video;
    if (several && !several->leaves.empty())
      diagnostics.warn(
          fmt::format("{}: holds several {}s, which are read as a video: their {} is not used, sRGB is taken", kName,
                      several->kind, several->leaves));
  }
  const auto module = ffmpeg_module();
  if (!module) return in_stream(module.error().message);
  AFTERGLOW_TRY(stream->state_->frames, (*module)->stream(request));
  stream->begin_next();
  const auto first = stream->state_->coming.get();
  if (!first) return first.error();
  if (!*first) return in_stream("holds no frame");
  const MovieFacts& facts = (*first)->facts();
  if (facts.rate.denominator > 0)
    stream->state_->fps = static_cast<double>(facts.rate.numerator) / facts.rate.denominator;
  for (const std::string& note : facts.notes) diagnostics.note(fmt::format("{}: {}", kName, note));
  for (const std::string& warning : facts.warnings) diagnostics.warn(fmt::format("{}: {}", kName, warning));
  std::promise<Result<std::shared_ptr<MovieSource>>> there;
  there.set_value(*first);
  stream->state_->coming = there.get_future();
  return stream;
}

MovieStream::~MovieStream() {
  if (state_) state_->cancelled = true;
}

void MovieStream::begin_next() {
  state_->coming = beside([frames = state_->frames.get()] { return frames->next(); });
}

double MovieStream::fps() const { return state_->fps; }

Result<MovieStream::Frame> MovieStream::next() {
  if (!state_->coming.valid()) return Frame{};
  AFTERGLOW_TRY(std::shared_ptr<MovieSource> source, state_->coming.get());
  if (!source) return Frame{};
  begin_next();
  const MovieFacts& facts = source->facts();
  if (!state_->first) state_->first = facts.pts.front();
  Frame frame;
  if (facts.time_base.denominator > 0)
    frame.time = static_cast<double>(facts.pts.front() - *state_->first) * facts.time_base.numerator /
                 facts.time_base.denominator;
  frame.movie = Movie::of(kName, std::move(source));
  return frame;
}

Result<StandardInput> open_standard_input(const std::string& raw, const SizeLimits& limits, Diagnostics& diagnostics) {
  auto descriptor = std::make_shared<FileDescriptor>(fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3));
  if (descriptor->get() < 0) return in_stream("standard input is closed");
  StandardInput input;
  std::string head;
  AFTERGLOW_TRY(const Patience patience, patience_of_process());
  PatientReader reader(descriptor, patience);
  if (raw.empty()) {
    AFTERGLOW_TRY(head, first_bytes(reader));
  }
  if (!raw.empty() || !stream_format(head).empty()) {
    AFTERGLOW_TRY(input.stream, MovieStream::open(std::move(descriptor), std::move(head), raw, limits, diagnostics));
  } else {
    AFTERGLOW_TRY(WholeFile whole, whole_file(reader, head, limits));
    input.file = std::move(whole.file);
    if (!whole.head.empty()) {
      input.file = nullptr;
      AFTERGLOW_TRY(input.stream,
                    MovieStream::open(std::move(descriptor), std::move(whole.head), raw, limits, diagnostics));
    }
  }
  return input;
}

}  // namespace afterglow

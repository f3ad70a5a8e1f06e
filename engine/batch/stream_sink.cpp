// SPDX-License-Identifier: MIT
#include "batch/stream_sink.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "core/text.h"
#include "image/metadata.h"
#include "image/video_writer.h"

namespace afterglow {
namespace {

constexpr const char* kName = "standard output";

Error stream_usage(std::string message, std::string allowed = {}, std::string nearest = {}) {
  return {ErrorKind::usage, std::move(message), kName, 0, std::move(allowed), std::move(nearest)};
}

Error too_many() {
  return stream_usage("takes one picture of this format", "y4m, raw, png, ppm, pam, pfm for several");
}

/// Owns a copy of standard output; standard output itself becomes standard error.
class StandardOutput {
 public:
  ~StandardOutput() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Result<void> take() {
    if (::isatty(STDOUT_FILENO) != 0)
      return stream_usage("is a terminal; frames go into a pipe or a file", "-o - | …, -o - > …");
    descriptor_ = ::dup(STDOUT_FILENO);
    if (descriptor_ < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0) return failed(errno);
    return {};
  }
  Result<void> write(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const char*>(data);
    while (size > 0) {
      const ssize_t written = ::write(descriptor_, bytes, size);
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return failed(errno);
      bytes += written;
      size -= static_cast<std::size_t>(written);
    }
    return {};
  }
  Result<void> close() {
    const int descriptor = std::exchange(descriptor_, -1);
    return descriptor >= 0 && ::close(descriptor) != 0 ? failed(errno) : Result<void>();
  }

 private:
  static Result<void> failed(int number) {
    const char* more = number == EPIPE ? "; whoever was reading it has gone" : "";
    return Error{ErrorKind::io, fmt::format("cannot be written: {}{}", std::strerror(number), more), kName};
  }
  int descriptor_ = -1;
};

/// Makes the bytes of a frame.
class FrameBytes {
 public:
  virtual ~FrameBytes() = default;
  virtual Result<std::string> begin(const Picture&, double /*fps*/) { return std::string(); }
  virtual Result<void> takes(const FrameJob&, const Picture&) { return {}; }
  virtual Result<std::string> frame(const Picture& picture) = 0;
  /// More than one frame can stand behind each other.
  virtual bool many() const { return true; }
};

/// Pictures in a format of files.
class PictureBytes : public FrameBytes {
 public:
  PictureBytes(std::string format, const WriteOptions& options, Diagnostics& diagnostics)
      : format_(std::move(format)), options_(options), once_([&](Severity severity, const std::string& message) {
          const std::string text = fmt::format("{}: {}", kName, message);
          severity == Severity::warning ? diagnostics.warn_once(text, text) : diagnostics.note(text);
        }) {}
  Result<std::string> frame(const Picture& picture) override {
    return picture_bytes(picture, format_, options_, once_);
  }
  bool many() const override {
    constexpr std::array<std::string_view, 5> kStreams{"ppm", "pnm", "pam", "pfm", "png"};
    return std::ranges::find(kStreams, format_) != kStreams.end();
  }

 private:
  std::string format_;
  WriteOptions options_;
  Diagnostics once_;  ///< what all frames say is said once
};

/// Frames of a y4m or raw video.
class VideoBytes : public FrameBytes {
 public:
  VideoBytes(bool y4m, const WriteOptions& options, double fps, Diagnostics& diagnostics)
      : y4m_(y4m), options_(options), rate_(frame_rate(fps)), diagnostics_(diagnostics) {}

  /// The layout that was asked for, or null. Errors: usage.
  Result<const PixelLayout*> asked() const {
    const std::string& wanted = options_.video.pixel_format;
    if (wanted.empty()) return nullptr;
    std::vector<std::string> names;
    const PixelLayout* found = find_pixel_layout(lower(wanted));
    for (const PixelLayout& layout : pixel_layouts())
      if (!y4m_ || (layout.kind == PixelLayout::Kind::yuv && !layout.alpha)) names.emplace_back(layout.name);
    if (found && std::ranges::find(names, found->name) != names.end()) return found;
    return stream_usage(fmt::format("{} has no pixel format '{}'", y4m_ ? "y4m" : "a raw video", wanted), join(names),
                        nearest_name(wanted, names));
  }

  Result<std::string> begin(const Picture& picture, double fps) override {
    if (fps > 0) rate_ = frame_rate(fps);
    AFTERGLOW_TRY(const PixelLayout* layout, asked());
    const bool deep = picture.facts && (picture.facts->floating || picture.facts->bits > 8);
    size_ = picture.display_window.size();
    VideoPlan plan;
    if (picture.facts) keep_facts(*picture.facts, plan);
    aspect_ = plan.pixel_aspect;
    if (!layout && y4m_) layout = find_pixel_layout(deep ? "yuv444p10le" : "yuv444p");
    if (!layout)
      layout = find_pixel_layout(picture.has_alpha ? deep ? "rgba64le" : "rgba" : deep ? "rgb48le" : "rgb24");
    plan.pack.layout = layout;
    AFTERGLOW_CHECK(check_video_size(plan, size_, kName));
    rules_.layout = layout;
    rules_.space = video_space(options_, *layout, picture.view);
    describe_space(*rules_.space, *layout, plan);
    // Nobody is told: readers take BT.601 for the matrix of what is no larger than standard definition.
    constexpr int kSmallWidth = 1024, kSmallHeight = 576;
    rules_.luma = size_.width <= kSmallWidth && size_.height <= kSmallHeight ? kBt601Luma : plan.pack.luma;
    rules_.dither = options_.dither.value_or(layout->bits == 8);
    rules_.beyond = plan.pack.beyond;
    return y4m_ ? header(*layout) : std::string();
  }

  Result<void> takes(const FrameJob& job, const Picture& picture) override { return one_size_.takes(job, picture); }

  Result<std::string> frame(const Picture& picture) override {
    if (!rules_.layout->alpha && !warned_ && has_transparency(picture)) {
      warned_ = true;
      diagnostics_.warn(fmt::format("{}: {} has no alpha; the pictures are put on black", kName, rules_.layout->name));
    }
    const PackedFrame packed = pack_frame(picture, rules_);
    std::string bytes = y4m_ ? "FRAME\n" : "";
    bytes.append(reinterpret_cast<const char*>(packed.bytes.data()), packed.bytes.size());
    return bytes;
  }

 private:
  std::string header(const PixelLayout& layout) const {
    const char* chroma = layout.chroma_y > 0 ? "420" : layout.chroma_x > 0 ? "422" : "444";
    const std::string bits = layout.bits > 8 ? fmt::format("p{}", layout.bits) : layout.chroma_y > 0 ? "mpeg2" : "";
    return fmt::format("YUV4MPEG2 W{} H{} F{}:{} Ip A{}:{} C{}{} XCOLORRANGE=LIMITED\n", size_.width, size_.height,
                       rate_.numerator, rate_.denominator, aspect_.numerator, aspect_.denominator, chroma, bits);
  }

  bool y4m_;
  WriteOptions options_;
  Rational rate_, aspect_{1, 1};
  Diagnostics& diagnostics_;
  PackRules rules_;
  Size size_;
  OneSize one_size_;
  bool warned_ = false;  ///< of alpha
};

class StreamSink : public FrameSink {
 public:
  explicit StreamSink(std::unique_ptr<FrameBytes> bytes) : bytes_(std::move(bytes)) {}
  Result<void> open() { return out_.take(); }

  Result<void> takes(const FrameJob& job, const Picture& picture) override { return bytes_->takes(job, picture); }

  /// A stream has no times: the place of a frame that failed is held by the one before, or by the first one.
  Result<void> write(const FrameJob& job, std::size_t index, const Picture& picture, const Turn& turn) override {
    AFTERGLOW_CHECK(turn());
    if (next_ == 0) {
      AFTERGLOW_TRY(last_, bytes_->begin(picture, job.fps));
      AFTERGLOW_CHECK(out_.write(last_.data(), last_.size()));
      last_.clear();
    }
    if (index > 0 && !bytes_->many()) return too_many();
    AFTERGLOW_TRY(std::string bytes, bytes_->frame(picture));
    if (next_ > 0) AFTERGLOW_CHECK(hold(index));
    last_ = std::move(bytes);
    return hold(index + 1);
  }

  Result<void> finish(std::size_t frames) override {
    if (next_ > 0) AFTERGLOW_CHECK(hold(frames));
    return out_.close();
  }

 private:
  /// The last frame for every place up to `end`.
  Result<void> hold(std::size_t end) {
    for (; next_ < end; ++next_) AFTERGLOW_CHECK(out_.write(last_.data(), last_.size()));
    return {};
  }

  std::unique_ptr<FrameBytes> bytes_;
  StandardOutput out_;
  std::string last_;
  std::size_t next_ = 0;  ///< place of the next frame
};

}  // namespace

Result<std::unique_ptr<FrameSink>> open_stream_sink(const std::string& format, const WriteOptions& options, double fps,
                                                    std::size_t frames, Diagnostics& diagnostics) {
  std::string name = lower(format.empty() ? "y4m" : format.starts_with('.') ? format.substr(1) : format);
  std::unique_ptr<FrameBytes> bytes;
  if (name == "y4m" || name == "raw") {
    auto video = std::make_unique<VideoBytes>(name == "y4m", options, fps, diagnostics);
    AFTERGLOW_TRY([[maybe_unused]] const PixelLayout* layout, video->asked());
    bytes = std::move(video);
  } else {
    if (auto known = check_format("-." + name, options); !known) {
      Error error = std::move(known).error();
      error.file = kName;
      if (!error.allowed.empty() && error.allowed.starts_with('.')) error.allowed = "y4m, raw, " + error.allowed;
      return error;
    }
    if (!options.video.pixel_format.empty()) return stream_usage("--pix-fmt is for videos", "y4m, raw");
    bytes = std::make_unique<PictureBytes>(name, options, diagnostics);
  }
  if (frames > 1 && !bytes->many()) return too_many();
  auto sink = std::make_unique<StreamSink>(std::move(bytes));
  AFTERGLOW_CHECK(sink->open());
  return std::unique_ptr<FrameSink>(std::move(sink));
}

}  // namespace afterglow

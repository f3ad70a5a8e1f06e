// SPDX-License-Identifier: MIT
// One frame through many presets, or through one with an effect more, small: made one after the other on a device and a
// thread of their own, which gives way to whatever else wants the processor.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/result.h"
#include "image/picture.h"
#include "session/stack.h"

namespace afterglow {

/// Immutable, shared.
struct Thumbnail {
  static constexpr int kWidth = 128, kHeight = 72;  ///< pixels; pictures of another form have clear borders
  std::vector<std::uint32_t> pixels;                ///< kHeight rows of RGBA bytes, sRGB; empty when there is an error
  std::optional<Error> error;                       ///< of the preset, with this frame
  std::string note = {};                            ///< why the effect that was added does nothing here; or empty
};

/// What the panel has changed of a preset. Immutable, shared.
struct ChangedLook {
  std::optional<std::string> text;  ///< none: as the file has it
  std::vector<Override> overrides;
  std::vector<ArgumentValue> arguments;
};

/// What a thumbnail shows the frame through.
struct ThumbnailOf {
  ThumbnailOf(std::filesystem::path file, std::shared_ptr<const ChangedLook> changes = {}, std::string effect = {})
      : preset(std::move(file)), changed(std::move(changes)), added(std::move(effect)) {}
  std::filesystem::path preset;
  std::shared_ptr<const ChangedLook> changed;  ///< null: as its file says
  std::string added;                           ///< an effect that the stack gets, with its defaults; or none
  friend auto operator<=>(const ThumbnailOf&, const ThumbnailOf&) = default;
};

/// What thumbnails show.
struct ThumbnailFrame {
  std::shared_ptr<const Picture> picture;  ///< full size; let go of once it was made small
  BuildContext context;                    ///< frame number, time and fps
  /// The same with inputs that other looks want, asked for on the thread that makes thumbnails. Empty, or an error:
  /// `picture` has all there is.
  std::function<Result<Picture>()> read = {};
};

/// Thread-safe.
class Thumbnails {
 public:
  static constexpr std::size_t kMostKept = 128;  ///< 36 KiB each

  /// `device`: is opened by the thread when the first one is wanted, and closed by `rest`. `stack`: as presets are
  /// loaded. `made` is called on that thread after each of them; it must not call back.
  Thumbnails(DeviceOptions device, StackOptions stack, std::function<void()> made);
  /// Waits for the one that is being made.
  ~Thumbnails();
  Thumbnails(const Thumbnails&) = delete;
  Thumbnails& operator=(const Thumbnails&) = delete;

  /// Another frame: all thumbnails are thrown away, that which is being made too.
  void set_frame(ThumbnailFrame frame);
  /// What is wanted, the most urgent first, in place of everything wanted before; no more than kMostKept of them. Those
  /// that are no longer wanted are thrown away.
  void want(std::vector<ThumbnailOf> wanted);
  /// Null: it is not made yet.
  std::shared_ptr<const Thumbnail> find(const ThumbnailOf& of) const;
  /// Throws everything away, and closes the device once the one that is being made is done.
  void rest();
  /// Something that is wanted is not made yet.
  bool busy() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace afterglow

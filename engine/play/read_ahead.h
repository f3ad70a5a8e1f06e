// SPDX-License-Identifier: MIT
// Pictures in memory before they are due: a bounded cache with threads that read what will be wanted next.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/result.h"
#include "image/picture.h"

namespace afterglow {

struct ReadAheadOptions {
  /// Of pictures in memory, which are kept in the smallest form that loses nothing (play/packed_picture.h). The one
  /// that is due is read even beyond it; those that are being read or are held by others are whole, and not part of it.
  std::uint64_t max_bytes = 2ull << 30;
  int threads = 2;
};

/// A picture that was read, or why it could not be. Immutable, shared.
struct ReadPicture {
  int key = 0;
  Picture picture;  ///< empty when there is an error
  std::optional<Error> error;
  double milliseconds = 0;  ///< that reading took
};

/// Reads by key; what a key means is the caller's. Thread-safe.
class ReadAhead {
 public:
  /// Called on several threads at a time.
  using Read = std::function<Result<Picture>(int key)>;
  /// `arrived` is called on reader threads after a picture has come in; it must not call back.
  ReadAhead(Read read, const ReadAheadOptions& options, std::function<void()> arrived = {});
  /// Waits for the pictures that are being read just now.
  ~ReadAhead();
  ReadAhead(const ReadAhead&) = delete;
  ReadAhead& operator=(const ReadAhead&) = delete;

  /// What is wanted, the most urgent first: in place of everything wanted before. What is being read is finished;
  /// what merely waits is forgotten. Pictures that are no longer wanted stay while there is room.
  void want(const std::vector<int>& keys);
  /// The picture, when it is there: the same object as long as somebody holds it. Errors are kept until the key is no
  /// longer wanted; then it is tried again.
  std::shared_ptr<const ReadPicture> find(int key) const;
  /// Whether it is there.
  bool has(int key) const;
  /// Blocks until it is there; wants it before all others.
  std::shared_ptr<const ReadPicture> wait(int key);
  /// Throws everything away; what is being read too. The pictures that others hold stay theirs.
  void forget();

  struct Stats {
    std::uint64_t bytes = 0, most_bytes = 0, max_bytes = 0;
    int pictures = 0;           ///< in memory
    std::uint64_t pixels = 0;   ///< of these
    int ahead = 0;              ///< of what is wanted, from its beginning without a gap
    std::uint64_t read = 0;     ///< since the beginning
    std::uint64_t failed = 0;   ///< of these
    std::uint64_t evicted = 0;  ///< to make room
    double milliseconds = 0;    ///< mean of reading one
  };
  Stats stats() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace afterglow

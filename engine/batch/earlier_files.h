// SPDX-License-Identifier: MIT
// What outputs depend on besides their own frame, where a look looks back: files of earlier frames of the sequence.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace afterglow {

/// Files of the frames of a sequence that others look back to, by ascending number.
struct SequenceFiles {
  struct Frame {
    int number = 0;
    std::size_t begin = 0;  ///< of its files
  };
  std::vector<Frame> frames;
  std::vector<std::filesystem::path> files;

  /// Behind all others.
  void add(int number, const std::vector<std::filesystem::path>& its);
  /// Where the files of that frame begin; of one that is not among them, those of the next.
  std::size_t begin_of(int number) const { return first_before(number, 0); }
  /// Where those of so many frames before it begin, or of as many as there are.
  std::size_t first_before(int number, int count) const;
};

/// A part of a list that all frames of the sequence share: sequences are long, and looks may look far back.
struct EarlierFiles {
  std::shared_ptr<const SequenceFiles> of{};  ///< null: the output depends on its own frame alone
  std::size_t begin = 0, end = 0;

  std::span<const std::filesystem::path> files() const {
    return of ? std::span(of->files).subspan(begin, end - begin) : std::span<const std::filesystem::path>();
  }
};

}  // namespace afterglow

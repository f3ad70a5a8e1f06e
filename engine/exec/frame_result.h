// SPDX-License-Identifier: MIT
// The image that frames are drawn into, and reading it back.
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "exec/barriers.h"
#include "exec/frame.h"
#include "exec/frame_image.h"
#include "exec/staging.h"

namespace afterglow {

/// Not thread-safe.
class FrameResult {
 public:
  /// `direct`: see FrameRunner::Options.
  FrameResult(Device& device, bool direct) : device_(&device), direct_(direct) {}

  static ImageDesc wanted_by(const Program& program);
  /// The image for programs that write so many rows at a time; those for others stay. Errors: device.
  Result<void> take(const ImageDesc& desc, int rows);
  const FrameImage& image() const { return image_; }
  /// Id of the program whose last run the image holds; 0: none.
  std::uint64_t writer() const { return image_.writer; }
  void set_writer(std::uint64_t program) { image_.writer = program; }
  /// Puts back what the image had: what was recorded since is not submitted.
  void set_layout(VkImageLayout layout) { image_.layout = layout; }

  /// Every VkImage of it: itself and its targets by rows.
  std::vector<VkImage> images() const;
  /// Into the layout that Program::record wants; what it held is lost.
  void before(VkCommandBuffer commands);
  /// Into a layout in which the CPU may read a direct image, and later submissions may sample it.
  void after(VkCommandBuffer commands);

  /// Reads that part back. Returns how many samples were clamped to ±65504. `flags`: look for alphas of 0, for
  /// HostResult::flagged. Errors: device.
  Result<std::uint64_t> download(Staging& staging, const Rect& part, HostResult& out, bool flags = false);
  /// Submits the copies of a `download` of that part from an image that is not direct. Staging is whole.
  Result<void> begin_download(Staging& staging, const Rect& part);
  int made() const { return made_; }  ///< images so far

 private:
  using LookAtRow = std::function<void(const std::byte* from, VkFormat format)>;
  Result<std::uint64_t> download_looking(Staging& staging, const Rect& part, HostResult& out, const LookAtRow& look);
  VkImageLayout writing_layout() const;
  Result<std::uint64_t> over_rows_of(Staging& staging, const Rect& part,
                                     const std::function<std::uint64_t(int y, const std::byte* from)>& row);

  Device* device_;
  bool direct_;
  Writing writing_;  ///< how the program that took it last writes
  FrameImage image_;
  std::map<int, FrameImage> others_;  ///< by rows: programs that take turns may write different numbers of them
  int made_ = 0;
};

}  // namespace afterglow

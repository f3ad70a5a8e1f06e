// SPDX-License-Identifier: MIT
// Pixels between host memory and images of any device, over buffers of a few rows, so that a large picture never exists
// a third time; or over buffers of all of them, so that frames can be in flight.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "core/geometry.h"
#include "exec/submit.h"
#include "gpu/image.h"

namespace afterglow {

/// Writes row y of a picture as it lies in an image, or reads it from there; returns how many values were held at
/// ±65504.
using PackRow = std::function<std::uint64_t(int y, std::byte* to)>;
using UnpackRow = std::function<std::uint64_t(int y, const std::byte* from)>;

/// What is moved.
struct StagedImage {
  VkImage image = VK_NULL_HANDLE;
  VkFormat format = VK_FORMAT_UNDEFINED;
  Size size;
};

/// Two bands take turns: while the device copies one, the CPU converts the other. Bands are kept and reused.
class Staging {
 public:
  /// `whole`: there are as many bands as a picture needs, and nothing waits for the device before it must.
  explicit Staging(const Device& device, bool whole = false) : device_(&device), whole_(whole) {}

  /// Leaves the image in SHADER_READ_ONLY_OPTIMAL, visible to fragment shaders; what it held is lost. Returns the sum
  /// of `pack`. With `whole` the copies are on their way still.
  Result<std::uint64_t> upload(const StagedImage& image, const PackRow& pack);

  /// Takes the image in `layout`, written by draws, and leaves it so. Rows `from` … `to` − 1 are moved, no others.
  /// Returns the sum of `unpack`. Where it fails nothing is on its way, and the image may be in another layout.
  Result<std::uint64_t> download(const StagedImage& image, VkImageLayout layout, const UnpackRow& unpack, int from,
                                 int to);
  Result<std::uint64_t> download(const StagedImage& image, VkImageLayout layout, const UnpackRow& unpack) {
    return download(image, layout, unpack, 0, image.size.height);
  }

  /// The uploads that follow are another frame's: with `whole` their bands are used again.
  void begin_uploads() { next_ = 0; }
  /// With `whole`: submits the copies of a `download` with the same arguments, which need only take them then.
  Result<void> begin_download(const StagedImage& image, VkImageLayout layout, int from, int to);
  /// Until no copy is on its way. Errors: device.
  Result<void> wait();

  /// Bytes of the buffers that moving an image of this size takes.
  VkDeviceSize bytes(const StagedImage& image) const;
  int buffers() const { return buffers_; }

 private:
  struct Band {
    Buffer buffer;
    Submitter submitter;          // after the buffer: it waits when it goes
    int first_row = 0, rows = 0;  ///< on their way; 0: none
  };
  using Bands = std::vector<Band>;
  Result<void> prepare(Bands& bands, std::size_t first, const StagedImage& image, HostAccess access);

  Result<std::uint64_t> move_back(const StagedImage& image, VkImageLayout layout, const UnpackRow& unpack, int from,
                                  int to);
  Result<void> submit_download(Band& band, const StagedImage& image, VkImageLayout layout, int first, int from, int to);
  int rows_per_band(const StagedImage& image) const;
  int bands_for(const StagedImage& image) const;

  const Device* device_;
  bool whole_;
  bool begun_ = false;    ///< a download
  std::size_t next_ = 0;  ///< band of the next upload, with `whole`
  Bands uploads_, downloads_;
  std::atomic<int> buffers_ = 0;  ///< asked for while another thread uploads
};

}  // namespace afterglow

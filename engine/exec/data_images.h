// SPDX-License-Identifier: MIT
// The images of a graph that it brings along itself (GraphImage::data), on the device.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "core/hash.h"
#include "exec/staging.h"
#include "gpu/image.h"
#include "graph/graph.h"

namespace afterglow {

class DataImages {
 public:
  /// Makes them, as full floats whatever the storage of the stack. `storage`: to be read as storage images. Submits
  /// nothing: programs are made on any thread. Errors: device.
  static Result<DataImages> create(const Device& device, const Graph& graph, bool storage);
  /// Fills those that do not hold what that graph brings along: it must have such images where the one before had, of
  /// the same sizes. Nothing that reads them may be in flight. Submits, and waits. Errors: device.
  Result<void> fill(const Device& device, const Graph& graph);

  /// The image, or null when the graph does not bring it along.
  const GpuImage* image(ImageId id) const {
    const auto found = images_.find(id);
    return found == images_.end() ? nullptr : &found->second.image;
  }
  /// In which they stay.
  VkImageLayout layout() const { return layout_; }
  int size() const { return static_cast<int>(images_.size()); }

 private:
  struct Held {
    GpuImage image;
    std::optional<Hash> pixels{};  ///< that it holds
  };
  std::map<ImageId, Held> images_;
  bool filled_ = false;               ///< at least once
  std::unique_ptr<Staging> staging_;  ///< of images that change from frame to frame
  VkImageLayout layout_ = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
};

}  // namespace afterglow

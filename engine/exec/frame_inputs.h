// SPDX-License-Identifier: MIT
// The images that frames bring to the device, and what they hold: pixels that are there already are not uploaded again.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exec/frame.h"
#include "exec/frame_image.h"
#include "exec/staging.h"
#include "graph/condition.h"

namespace afterglow {

/// Not thread-safe.
class FrameInputs {
 public:
  /// `direct`: see FrameRunner::Options.
  FrameInputs(Device& device, bool direct) : device_(&device), direct_(direct) {}

  /// What this program reads of the given images. Errors: those of check_input.
  static Result<std::map<std::string, ImageDesc>> wanted_by(const Program& program,
                                                            const std::map<std::string, HostImage>& host);
  /// Makes images for these inputs and no others; those that fit stay. Errors: device.
  Result<void> prepare(const std::map<std::string, ImageDesc>& wanted);

  /// Uploads one input, if it may hold other pixels in `part` than those it is given. `look`: find out what it
  /// shows, as stored so. Errors: device.
  Result<void> upload(Staging& staging, const std::string& name, const HostImage& given, const Rect& part, bool look,
                      Storage storage);
  /// See Program::InputVersions.
  Program::InputVersions versions() const;
  const SourceContent& found(const std::string& name) const { return *held_.at(name).found; }
  /// Samples of what is held that were clamped to ±65504.
  std::uint64_t clamped() const;

  const std::map<std::string, FrameImage>& images() const { return images_; }
  std::map<std::string, ImageBinding> bindings() const;
  /// Into the layouts that Program::record wants.
  void before(const Program& program, VkCommandBuffer commands);
  /// Into layouts in which the CPU may touch the pixels of direct images, and later submissions may sample all of them.
  void after(VkCommandBuffer commands);
  /// New images are not, until `after` was recorded.
  bool readable() const;
  std::vector<VkImageLayout> layouts() const;  ///< as commands that were recorded leave them
  /// Puts back what `layouts` gave: what was recorded since is not submitted.
  void set_layouts(const std::vector<VkImageLayout>& layouts);
  int made() const { return made_; }  ///< images so far

 private:
  struct Held {
    std::optional<Hash> content;
    Rect part;
    std::uint64_t version = 0;
    std::uint64_t clamped = 0;
    std::optional<SourceContent> found;
  };
  Device* device_;
  bool direct_;
  std::map<std::string, FrameImage> images_;
  std::map<std::string, Held> held_;
  int made_ = 0;
};

}  // namespace afterglow

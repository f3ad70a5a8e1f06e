// SPDX-License-Identifier: MIT
// The images of one frame at a time: what it brings, what it is drawn into, and the memory in which pixels travel.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "exec/frame.h"
#include "exec/frame_inputs.h"
#include "exec/frame_result.h"
#include "exec/staging.h"

namespace afterglow {

/// They stay while frames fit them. Not thread-safe.
class FrameImages {
 public:
  struct Options {
    std::uint64_t max_memory = 0;
    bool direct = true, whole_staging = false;  ///< see FrameRunner::Options
  };
  FrameImages(Device& device, const Options& options);

  /// Makes them for this program and these inputs. Errors: other (an input is missing or of another size), io (over
  /// `max_memory`), device.
  Result<void> prepare(const Program& program, const std::map<std::string, HostImage>& host);
  /// The result's alone, for another program that takes the same inputs. Errors: device.
  Result<void> take_result(const Program& program);
  /// Every input that may hold other pixels than those it is given. `look`: find out how bright the source is. Errors:
  /// device.
  Result<void> upload(const Program& program, const std::map<std::string, HostImage>& host, bool look);
  /// Makes and uploads the source alone, for frames without a program. Returns the milliseconds of the upload. Errors:
  /// those of `prepare`.
  Result<double> bring_source(const std::map<std::string, HostImage>& host);

  /// What commands and descriptors that name the images depend on.
  struct Handles {
    std::vector<VkImage> images;
    int made = 0;  ///< a new image may have the handle of one that is gone
    friend bool operator==(const Handles&, const Handles&) = default;
  };
  Handles handles() const;
  int made() const { return inputs.made() + result.made(); }  ///< images so far
  bool whole_staging() const { return options_.whole_staging; }
  /// What the last frame left. `ran`: a program made the result; else it is the source.
  DeviceImages on_device(bool ran) const;

  FrameInputs inputs;
  FrameResult result;
  Staging staging;

 private:
  Result<void> check_memory(const std::map<std::string, ImageDesc>& descs, std::uint64_t other_bytes) const;

  Options options_;
};

}  // namespace afterglow

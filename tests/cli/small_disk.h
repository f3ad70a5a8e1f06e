// SPDX-License-Identifier: MIT
// Disks that are soon full.
#pragma once

#include <filesystem>
#include <string>

namespace afterglow::test {

/// A disk mounted at an empty folder. Seen by this process and its children alone. Without root's rights the process
/// gets a user namespace of its own, which it keeps.
class SmallDisk {
 public:
  /// `size` as tmpfs has it: "16k".
  SmallDisk(std::filesystem::path folder, const std::string& size);
  ~SmallDisk();
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  bool is_mounted() const { return mounted_; }  ///< false where mounting is not allowed
  bool resize(const std::string& size) const;

 private:
  std::filesystem::path folder_;
  bool mounted_;
};

}  // namespace afterglow::test

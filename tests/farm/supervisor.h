// SPDX-License-Identifier: MIT
// Processes that never outlive a test, however it ends: neither they nor what they leave behind.
#pragma once

#include <string>
#include <vector>

namespace afterglow::test {

/// A process of its own starts programs and takes in all that they leave behind. When the test lets go of it, or dies,
/// it kills every one of them.
class Supervisor {
 public:
  /// Programs that can be started, by number: their words.
  explicit Supervisor(const std::vector<std::vector<std::string>>& programs);
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;
  /// What it prints is dropped.
  void start(std::size_t program) const;

 private:
  int commands_ = -1;
  int process_ = 0;
};

}  // namespace afterglow::test

// SPDX-License-Identifier: MIT
// A Slurm cluster of four nodes on this machine: real daemons, in a folder of their own, on ports of the loopback
// address, with a key of their own; as root or as any user, without systemd.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "supervisor.h"

namespace afterglow::test {

class Cluster {
 public:
  static constexpr int kNodes = 4;  ///< n1 to n4, one task each
  static constexpr int kLargestArray = 16;
  /// Why there can be none here; empty: there can.
  static std::string missing();

  /// Starts it in `folder`, which must not exist, and waits until all nodes are idle.
  explicit Cluster(const std::filesystem::path& folder);
  ~Cluster();
  bool is_up() const { return up_; }
  std::string config() const { return (folder_ / "slurm.conf").string(); }  ///< for SLURM_CONF
  /// The last lines of the daemons' logs, for messages.
  std::string logs() const;
  /// Kills the daemon of a node and all that runs below it, as if the machine had lost its power.
  void kill_node(const std::string& node) const;
  void start_node(const std::string& node) const;

 private:
  std::filesystem::path folder_;
  std::unique_ptr<Supervisor> supervisor_;
  bool up_ = false;
};

/// All processes below this one, and it; of `process` its children, theirs and so on.
std::vector<int> family_of(int process);
/// 0: it is none or has none.
int parent_of(int process);

}  // namespace afterglow::test

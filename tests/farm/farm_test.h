// SPDX-License-Identifier: MIT
// What the tests of `afterglow farm` share: small frames, a look that looks back, a cluster.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli_test.h"
#include "cluster.h"

namespace afterglow::test {

/// Looks every few milliseconds until it holds; false after a minute.
bool wait_until(const std::function<bool()>& holds);

class FarmTest : public CliTest {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// Starts the daemons; the test is skipped where there are none.
  void start_cluster();
  /// The program, speaking to the cluster.
  Outcome farm(const std::vector<std::string>& words, RunOptions options = {}) const;
  /// A program of Slurm's.
  Outcome slurm(const std::string& program, const std::vector<std::string>& words) const;

  /// Frames that differ from each other, in shot.####.exr of a folder.
  void make_frames(const std::string& folder, int first, int last, int width = 16, int height = 9) const;
  /// look.lua: the result depends on the three frames before. `work`: how long a frame takes, in turns of a loop.
  void make_look_back(int work = 1) const;
  /// All outputs of a folder by name; not what is hidden.
  std::map<std::string, std::string> pictures(const std::string& folder) const;
  /// The outputs are there and those of one run over the same frames, byte for byte.
  void expect_as_one_run(const std::string& folder, const std::string& one) const;
  /// No temporary file lies in the folder or beside its notes.
  void expect_nothing_half_written(const std::string& folder) const;
  /// The folder of the only job of these outputs.
  fs::path job_of(const std::string& outputs) const;
  /// Files of its attempts that end so: ".begun", ".exit-0".
  std::vector<fs::path> attempts(const std::string& outputs, const std::string& ending) const;
  /// The merged report.
  nlohmann::json report_of(const std::string& outputs) const;

  std::unique_ptr<Cluster> cluster_;
};

#define AFTERGLOW_NEEDS_CLUSTER()                                                    \
  if (const std::string why = Cluster::missing(); !why.empty()) GTEST_SKIP() << why; \
  start_cluster();                                                                   \
  ASSERT_TRUE(cluster_->is_up()) << cluster_->logs()

}  // namespace afterglow::test

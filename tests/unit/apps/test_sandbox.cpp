// SPDX-License-Identifier: MIT
// What `run --sandbox` leaves of the file system, for each kind of output.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "apps/sandbox.h"

namespace afterglow {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

class Sandbox : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("afterglow_sandbox_" + std::to_string(getpid()));
    for (const char* name : {"out", "far"}) fs::create_directories(folder_ / name);
    std::ofstream(folder_ / "look.lua") << "return require('afterglow').stack {}";
  }
  void TearDown() override { fs::remove_all(folder_); }

  Confinement left(const std::string& output) const {
    RunArguments a;
    a.preset.file = (folder_ / "look.lua").string();
    a.files.output = output;
    auto out = sandbox_of(a);
    EXPECT_TRUE(out);
    return out ? *out : Confinement();
  }
  fs::path folder_;
};

TEST_F(Sandbox, FilesAreWrittenInTheFolderTheyEndUpIn) {
  EXPECT_THAT(left((folder_ / "out").string()).write, ElementsAre(folder_ / "out"));
  EXPECT_THAT(left((folder_ / "out/new.png").string()).write, ElementsAre(folder_ / "out"));
  fs::create_symlink(folder_ / "far/old.png", folder_ / "out/link.png");
  std::ofstream(folder_ / "far/old.png") << "x";
  EXPECT_THAT(left((folder_ / "out/link.png").string()).write, ElementsAre(folder_ / "far"));
  EXPECT_THAT(left("-").write, IsEmpty());
}

TEST_F(Sandbox, OfDevicesItLeavesThoseOfGpusAndNobodys) {
  const Confinement usual = left((folder_ / "out").string());
  EXPECT_THAT(usual.devices, Contains(fs::path("/dev/null")));
  EXPECT_THAT(usual.devices, Contains(fs::path("/dev/dri")));
  for (const char* not_left : {"/dev", "/dev/shm", "/dev/tty", "/dev/pts", "/dev/sda"})
    EXPECT_THAT(usual.devices, Not(Contains(fs::path(not_left))));
  const Confinement piped = left("/dev/stdout");
  EXPECT_THAT(piped.devices, Contains(fs::path("/dev/stdout")));
  EXPECT_THAT(piped.write, IsEmpty()) << "not what else is in /dev";
}

}  // namespace
}  // namespace afterglow

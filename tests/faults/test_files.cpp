// SPDX-License-Identifier: MIT
// What disks do, and other programs to our files.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include "fault_test.h"

namespace afterglow::test {
namespace {

class FileFault : public FaultTest {
 protected:
  void SetUp() override {
    FaultTest::SetUp();
    make_exr("in.exr");
  }
  /// Strikes at `most` places of the command and looks at each outcome.
  void strike(const std::vector<std::string>& arguments, const std::vector<std::string>& outputs, const Fault& fault,
              long most, const std::function<void(const Outcome&)>& look) {
    const long last = places(arguments, fault);
    take_reference(outputs);
    for (const long place : some(last, most)) {
      SCOPED_TRACE(fault.name + ", call " + std::to_string(place) + " of " + std::to_string(last));
      const Outcome outcome = run_with(arguments, fault, place);
      expect_clean_end(outcome);
      look(outcome);
      remove_outputs();
    }
  }
  std::vector<std::string> command(const std::string& output) const {
    return {"run", neon_night(), "in.exr", "-o", output};
  }
};

TEST_F(FileFault, AnyCallMayFail) {
  for (const char* output : {"out.png", "out.exr", "out.tif"})
    strike(command(output), {output}, file_fault("error", path("")), 16, [&](const Outcome& outcome) {
      const int there = expect_whole_or_absent();
      expect_nothing_left_over();
      EXPECT_EQ(there, outcome.exit_code == kDone ? 1 : 0);
      EXPECT_THAT(outcome.exit_code, ::testing::AnyOf(kDone, kFiles)) << outcome.err;
    });
}

TEST_F(FileFault, TheDiskIsFullAtSomeByte) {
  for (const char* output : {"out.png", "out.exr", "out.tif", "out.jpg", "out.hdr"})
    strike(command(output), {output}, file_fault("full", path("")), 12, [&](const Outcome& outcome) {
      EXPECT_EQ(expect_whole_or_absent(), 0);
      expect_nothing_left_over();
      EXPECT_EQ(outcome.exit_code, kFiles);
      EXPECT_THAT(outcome.err, HasSubstr(output));
      EXPECT_THAT(outcome.err, HasSubstr("No space left on device"));
    });
}

TEST_F(FileFault, AFullDiskEndsASequenceWithWhatIsWhole) {
  make_exr("in.0001.exr");
  make_exr("in.0002.exr");
  strike({"run", neon_night(), "in.%04d.exr", "-o", "out.%04d.png", "--report", "report.json"},
         {"out.0001.png", "out.0002.png", "report.json"}, file_fault("full", path("")), 12,
         [&](const Outcome& outcome) {
           EXPECT_EQ(outcome.exit_code, kFiles);
           expect_nothing_left_over();
           for (const char* name : {"out.0001.png", "out.0002.png"}) {
             if (fs::exists(path(name))) {
               EXPECT_FALSE(OIIO::ImageBuf(text(name)).has_error()) << name;
             }
           }
           fs::remove(path("report.json"));
         });
}

TEST_F(FileFault, CallsMayDoAFewBytesAndBeInterrupted) {
  const auto same_with = [&](const std::string& output, const std::string& kind) {
    SCOPED_TRACE(kind + " of a few bytes, " + output);
    const Outcome plain = run(command(output));
    ASSERT_EQ(plain.exit_code, kDone) << plain.err;
    take_reference({output});
    const Outcome outcome = run_with(command(output), file_fault(kind, path("")), 1);
    EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
    EXPECT_EQ(expect_whole_or_absent(), 1);
    remove_outputs();
  };
  for (const char* output : {"out.png", "out.exr", "out.tif", "out.jpg", "out.hdr"}) same_with(output, "writes");
  same_with("out.png", "reads");  // of an EXR; other formats are read by libraries, which leave it to the system
}

TEST_F(FileFault, APictureThatChangesWhileItIsRead) {
  const OIIO::ImageBuf picture(text("in.exr"));
  for (const char* input : {"in.exr", "plain.exr", "in.tif", "in.png", "in.jpg", "in.hdr"}) {
    OIIO::ImageBuf copy = picture;
    if (std::string(input) == "plain.exr") copy.specmod().attribute("compression", "none");
    if (std::string(input) == "in.hdr") copy = OIIO::ImageBufAlgo::channels(copy, 3, {});
    ASSERT_TRUE(copy.write(text(input))) << copy.geterror();
    const std::string good = read(input);
    int failed = 0;
    for (const char* kind : {"cut", "swap", "error"})
      strike({"run", neon_night(), input, "-o", "out.png"}, {"out.png"}, file_fault(kind, path(input)), 5,
             [&](const Outcome& outcome) {
               expect_whole_or_absent();
               expect_nothing_left_over();
               if (outcome.exit_code != kDone) {
                 EXPECT_EQ(outcome.exit_code, kFiles) << outcome.err;
                 EXPECT_THAT(outcome.err, HasSubstr(input));
                 ++failed;
               }
               write(input, good);
             });
    EXPECT_GT(failed, 2) << input;
  }
}

TEST_F(FileFault, CachesAreNoReasonToFail) {
  environment_ = {{"AFTERGLOW_CACHE", text("cache")}};
  for (const char* kind : {"error", "full", "cut", "swap"}) {
    const bool warm = std::string(kind) == "cut" || std::string(kind) == "swap";
    const Fault fault = file_fault(kind, path("cache"));
    fs::remove_all(path("cache"));
    if (warm) {
      const Outcome first = run_with(command("out.png"), {}, 0);
      ASSERT_EQ(first.exit_code, kDone) << first.err;
    }
    const long last = places(command("out.png"), fault);
    take_reference({"out.png"});
    for (const long place : some(last, 8)) {
      SCOPED_TRACE(fault.name + ", call " + std::to_string(place) + " of " + std::to_string(last));
      if (!warm) fs::remove_all(path("cache"));
      const Outcome outcome = run_with(command("out.png"), fault, place);
      EXPECT_EQ(outcome.exit_code, kDone) << outcome.err;
      EXPECT_EQ(expect_whole_or_absent(), 1);
      remove_outputs();
    }
  }
}

}  // namespace
}  // namespace afterglow::test

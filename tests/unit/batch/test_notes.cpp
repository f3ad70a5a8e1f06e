// SPDX-License-Identifier: MIT
// What notes and locks say that frames are made of.
#include <gtest/gtest.h>

#include "batch/lock.h"
#include "batch/resume.h"
#include "core/file_stamp.h"
#include "core/paths.h"
#include "temporary_folder.h"

namespace afterglow {
namespace {

/// Of a file that is saved while a run begins it is the text that runs, not the one that lies there by now.
TEST(Notes, AreOfTheFilesThatWereRead) {
  const TemporaryFolder folder;
  const auto file = folder / "look.lua";
  const auto write = [&](const char* exposure) {
    std::ofstream(file) << "local fx = require \"afterglow\"\nreturn fx.stack { fx.color_adjustments { post_exposure = "
                        << exposure << " } }\n";
  };
  struct Noted {
    Hash look;
    std::string lock;
  };
  Diagnostics nowhere;
  const auto load = [&](ShaderLibrary& shaders) { return Preset::load(file, {}, shaders, nowhere); };
  const auto noted = [&](Preset& preset) {
    const auto inventory = take_inventory(preset, {}, nowhere);
    EXPECT_TRUE(inventory);
    const auto lock = look_lock(preset, file, *inventory, {});
    EXPECT_TRUE(lock);
    return Noted{look_hash(preset, *inventory, "").value(), lock_text(*lock)};
  };
  write("1");
  ShaderLibrary shaders(search_path_for(file, {}));
  auto preset = load(shaders);
  ASSERT_TRUE(preset) << preset.error().text();
  const Noted before = noted(*preset);
  write("3");
  const Noted during = noted(*preset);
  EXPECT_EQ(during.look, before.look);
  EXPECT_EQ(during.lock, before.lock);
  auto again = load(shaders);
  ASSERT_TRUE(again) << again.error().text();
  const Noted after = noted(*again);
  EXPECT_NE(after.look, before.look);
  EXPECT_NE(after.lock, before.lock);
}

/// Another run may have replaced the output before its note is written: it vouches for what this run wrote.
TEST(Notes, AreOfTheOutputThatWasWritten) {
  const TemporaryFolder folder;
  std::ofstream(folder / "look.lua") << "return require(\"afterglow\").stack {}\n";
  std::ofstream(folder / "in.png") << "input";
  Diagnostics nowhere;
  ShaderLibrary shaders(search_path_for(folder / "look.lua", {}));
  auto preset = Preset::load(folder / "look.lua", {}, shaders, nowhere);
  ASSERT_TRUE(preset) << preset.error().text();
  FrameNotes notes(Hash{1, 2}, *preset);
  FrameJob job;
  job.input = folder / "in.png";
  job.output = folder / "out.png";
  job.made_of = notes.text(notes.inputs_of(job), {});
  std::ofstream(job.output) << "ours";
  const std::string ours = file_stamp(job.output);
  ASSERT_TRUE(record_made(job, ours));
  EXPECT_TRUE(notes.is_up_to_date(job));
  std::ofstream(job.output) << "theirs, meanwhile";
  ASSERT_TRUE(record_made(job, ours));
  EXPECT_FALSE(notes.is_up_to_date(job));
}

}  // namespace
}  // namespace afterglow

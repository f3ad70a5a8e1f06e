// SPDX-License-Identifier: MIT
// Reloads: what is built again, what stays, and what an error leaves behind. Real files, no window.
#include <gmock/gmock.h>

#include <atomic>
#include <thread>

#include "live_fixture.h"

namespace afterglow {
namespace {
namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class Live : public LiveTest {};

TEST_F(Live, AValueEditTouchesNoShaderAndRunsWhatIsDownstream) {
  open_unwatched();
  EXPECT_EQ(shown(), 1.f);
  const auto before = live().counters();
  const auto images = session_->counters().images;
  save(4);
  EXPECT_EQ(settled(), 2.f);
  EXPECT_EQ(live().status().times.kind, BuildTimes::Kind::values);
  EXPECT_EQ(session_->times().kernels_run, 1);
  EXPECT_EQ(session_->times().kernels_kept, 1);
  const auto after = live().counters();
  EXPECT_EQ(after.compiled, before.compiled);
  EXPECT_EQ(after.pipelines, before.pipelines);
  EXPECT_EQ(after.structures, before.structures);
  EXPECT_EQ(after.values, before.values + 1);
  EXPECT_EQ(session_->counters().images, images);
  EXPECT_EQ(live().status().generation, after.structures + after.values);
  shown();
  EXPECT_EQ(session_->times().kernels_run, 0) << "the frame stands still";
}

TEST_F(Live, SavingWithoutAChangeBuildsNothing) {
  open_unwatched();
  EXPECT_EQ(shown(), 1.f);
  const auto before = live().counters().builds;
  save(2);
  EXPECT_EQ(settled(), 1.f);
  EXPECT_EQ(live().counters().builds, before);
}

TEST_F(Live, AShaderEditMakesTheChangedKernelAlone) {
  open_unwatched();
  EXPECT_EQ(shown(), 1.f);
  const auto before = live().counters();
  write("shaders/t/lib.glsl", "vec3 tinted(vec3 c, float gain) { return c * gain + 1.0; }\n");
  EXPECT_EQ(settled(), 2.f);
  live().settle();  // the old stack is released
  const auto after = live().counters();
  EXPECT_EQ(after.compiled, before.compiled + 1);
  EXPECT_EQ(after.pipelines, before.pipelines + 1);
  EXPECT_EQ(after.pipelines_alive, before.pipelines_alive) << "the old one is gone";
  const BuildTimes times = live().status().times;
  EXPECT_EQ(times.kind, BuildTimes::Kind::structure);
  EXPECT_EQ(times.kernels_compiled, 1);
  EXPECT_EQ(times.pipelines_made, 1);
  EXPECT_GT(times.script, 0);
  EXPECT_GT(times.shader, 0);
  EXPECT_GT(times.pipeline, 0);
}

struct Breakage {
  const char* file;
  std::string broken;
  const char* message;
  const char* line;  ///< of the source, "" when there is none to show
};

class LiveBreakage : public LiveTest {};

TEST_F(LiveBreakage, KeepsTheLastGoodStackUntilRepaired) {
  const Breakage kBreakages[] = {
      {"look.lua", "local fx = require \"afterglow\"\nreturn fx.stack {\n  fx.t { gain = = },\n}\n",
       "look.lua:3: error: ", "fx.t { gain = = },"},
      {"look.lua", "local fx = require \"afterglow\"\nreturn fx.stack {\n  fx.t { gain = \"much\" },\n}\n", "number",
       "fx.t { gain = \"much\" },"},
      {"look.lua", "local fx = require \"afterglow\"\nreturn fx.stack {\n  fx.t { gian = 1 },\n}\n",
       "did you mean 'gain'?", "fx.t { gian = 1 },"},
      {"look.lua", "local fx = require \"afterglow\"\nreturn fx.stack {\n  fx.tt { },\n}\n", "unknown effect 'tt'",
       "fx.tt { },"},
      {"shaders/t/tint.glsl",
       "uniform sampler2D source;\nuniform float gain;\nvec4 sample_at(ivec2 p) {\n  return fetch(source, p) * "
       "gian;\n}\n",
       "tint.glsl:4: error: ", "return fetch(source, p) * gian;"},
      {"shaders/t/tint.glsl", std::string("#include \"missing.glsl\"\n") + kTint,
       "cannot find the include 'missing.glsl'", "#include \"missing.glsl\""},
      {"effects/t.lua", "return 1\n", "an effect's file must return", ""},
      {"look.lua", "", "a preset must return", ""},
  };
  open_unwatched();
  EXPECT_EQ(shown(), 1.f);
  for (const auto& [file, broken, message, line] : kBreakages) {
    std::string whole;
    {
      std::ifstream in(folder_ / file);
      whole.assign(std::istreambuf_iterator<char>(in), {});
    }
    const auto generation = live().status().generation;
    write(file, broken);
    EXPECT_EQ(settled(), 1.f) << message;
    const LiveStatus status = live().status();
    ASSERT_TRUE(status.error) << message;
    EXPECT_THAT(status.error->text(), HasSubstr(message));
    EXPECT_EQ(status.source_line, line);
    EXPECT_THAT(status.error_text(), HasSubstr(line));
    EXPECT_EQ(status.generation, generation);
    write(file, whole);
    EXPECT_EQ(settled(), 1.f);
    EXPECT_FALSE(live().status().error) << live().status().error->text();
  }
  save(4);
  EXPECT_EQ(settled(), 2.f);
}

TEST_F(Live, AnEndlessScriptEndsWithItsBudget) {
  open_unwatched();
  EXPECT_EQ(shown(), 1.f);
  write("look.lua", "while true do end\n");
  EXPECT_EQ(settled(), 1.f);
  ASSERT_TRUE(live().status().error);
  EXPECT_THAT(live().status().error->text(), HasSubstr("instruction budget spent"));
  save(4);
  EXPECT_EQ(settled(), 2.f);
  EXPECT_FALSE(live().status().error);
}

TEST_F(Live, ARepairEndsAnEndlessScriptBeforeItsTime) {
  // Instructions and time without end: only the edit that follows can end it.
  LiveOptions options;
  options.stack.preset.limits.instructions = ~0ull >> 1;
  options.stack.preset.limits.seconds = 1e6;
  open(options);
  EXPECT_EQ(shown(), 1.f);
  // A build that has begun may still read the repaired file: then the script never ran, and we try again.
  for (int attempt = 0; attempt < 1000 && live().counters().given_up == 0; ++attempt) {
    const int gain = 4 + attempt % 90;
    live().settle();
    const auto builds = live().counters().builds;
    write("endless.lua", "while true do end\n");
    fs::rename(folder_ / "endless.lua", folder_ / "look.lua");  // at once: a build must not see half of it
    while (live().counters().builds == builds) std::this_thread::yield();
    save(gain);
    EXPECT_TRUE(comes(static_cast<float>(gain) / 2));
  }
  EXPECT_GE(live().counters().given_up, 1u);

  write("look.lua", "while true do end\n");
  while (!live().status().building) std::this_thread::yield();
  session_.reset();  // and so does the end of the program
}

TEST_F(Live, AnEditDuringABuildIsBuiltAfterIt) {
  open();
  EXPECT_EQ(shown(), 1.f);
  for (int i = 0; i < 8; ++i) {
    live().settle();  // a build that was under way might see the edit and count for none
    const auto builds = live().counters().builds;
    write("shaders/t/lib.glsl", "vec3 tinted(vec3 c, float gain) { return c * gain + " + std::to_string(i) + ".0; }\n");
    while (live().counters().builds == builds) std::this_thread::yield();
    save(2 + 2 * i);
    EXPECT_TRUE(comes(1.f + static_cast<float>(2 * i)));
  }
}

TEST_F(Live, InAStormOfEditsTheLastOneWins) {
  open();
  EXPECT_EQ(shown(), 1.f);
  for (int i = 1; i <= 1000; ++i) {
    save(i % 100);
    if (i % 10 == 0) write("effects/t.lua", effect("t") + (i % 20 ? "" : "\n"));
    if (i % 100 == 0) write("shaders/t/lib.glsl", i % 200 ? kLibrary : std::string(kLibrary) + "// again\n");
    if (i % 7 == 0) {
      const float now = shown();
      EXPECT_EQ(now * 2, std::floor(now * 2)) << "one of the values that were saved";
    }
  }
  save(50);
  EXPECT_TRUE(comes(25.f));
  live().settle();
  EXPECT_LE(live().counters().stacks, 2u);
}

TEST_F(Live, WaitingEndsThoughFilesChangeAllTheTime) {
  constexpr int kEnd = 50;
  std::atomic<bool> storm = false;
  std::atomic<int> edits = 0;
  at_notify_ = [&] {  // by each build, on its thread
    if (!storm || ++edits >= kEnd) return;
    save(10 + edits);
    live().reload();
  };
  open_unwatched();
  storm = true;
  save(4);
  live().settle();
  EXPECT_LT(edits, kEnd) << "it waited for the end of the storm";
  storm = false;
  EXPECT_GE(shown(), 2.f) << "what lay there when it was called, or later";
}

TEST_F(Live, AnEffectMayBeRenamed) {
  open();
  EXPECT_EQ(shown(), 1.f);
  fs::rename(folder_ / "effects/t.lua", folder_ / "effects/u.lua");
  EXPECT_TRUE(fails("unknown effect 't'"));
  EXPECT_EQ(shown(), 1.f);
  write("effects/u.lua", effect("u"));
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.u { gain = 6 } }\n");
  EXPECT_TRUE(comes(3.f));
  EXPECT_THAT(live().images(), ElementsAre("source", "u.blur", "u.tint"));
}

TEST_F(Live, APresetMayAppearLater) {
  fs::remove_all(folder_);
  open();
  EXPECT_EQ(live().stack(), nullptr);
  ASSERT_TRUE(live().status().error);
  EXPECT_EQ(live().status().generation, 0u);
  EXPECT_EQ(shown(), 0.5f) << "the source, until there is a stack";
  write_files();
  EXPECT_TRUE(comes(1.f));
}

TEST_F(Live, WhatShadowsAFileCounts) {
  write("more/effects/t.lua", effect("t"));
  fs::remove(folder_ / "effects/t.lua");
  LiveOptions options;
  options.stack.preset.paths = {folder_ / "more"};
  open(options);
  EXPECT_EQ(shown(), 1.f);
  std::string nearer = effect("t");
  nearer.replace(nearer.find("s.gain"), 6, "s.gain * 3");
  write("effects/t.lua", nearer);  // beside the preset: comes before
  EXPECT_TRUE(comes(3.f));
  write("shaders/t/lib.glsl", "#include \"deep.glsl\"\nvec3 tinted(vec3 c, float gain) { return deeper(c * gain); }\n");
  EXPECT_TRUE(fails("cannot find the include 'deep.glsl'"));
  write("shaders/t/deep.glsl", "vec3 deeper(vec3 c) { return c * 2.0; }\n");
  EXPECT_TRUE(comes(6.f));
  fs::remove(folder_ / "effects/t.lua");
  EXPECT_TRUE(comes(2.f)) << "the one behind it shows again";
}

TEST_F(Live, OverridesSurviveAndThoseThatDoNotFitAreLeftOut) {
  LiveOptions options;
  options.follow = false;
  options.stack.preset.overrides = {{"t", "gain", "10"}};
  open(options);
  EXPECT_EQ(shown(), 5.f);
  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { name = \"other\", fx.t { gain = 3 } }\n");
  EXPECT_EQ(settled(), 5.f);
  live().set_overrides({{"t", "gain", "10"}, {"t", "gain", "20"}});
  EXPECT_EQ(settled(), 10.f) << "the later one wins";
  EXPECT_EQ(live().status().times.kind, BuildTimes::Kind::values);

  live().set_overrides({{"t", "gain", "20"}, {"u", "gain", "4"}, {"t", "size", "4"}});
  EXPECT_EQ(settled(), 10.f);
  EXPECT_FALSE(live().status().error);
  ASSERT_EQ(live().status().warnings.size(), 2u);
  EXPECT_THAT(live().status().warnings[0], HasSubstr("has no entry 'u'; it is left out"));
  EXPECT_THAT(live().status().warnings[1], HasSubstr("has no such setting; it is left out"));

  write("look.lua", "local fx = require \"afterglow\"\nreturn fx.stack { fx.t { name = \"u\", gain = 3 } }\n");
  EXPECT_EQ(settled(), 2.f) << "it has a place now, and is the more exact name";
  live().set_overrides({});
  EXPECT_EQ(settled(), 1.5f);
  EXPECT_TRUE(live().status().warnings.empty());
}

TEST_F(Live, AnotherTextStandsInPlaceOfTheFiles) {
  LiveOptions options;
  options.follow = false;
  open(options);
  const float file = shown();
  const std::string text = "local fx = require \"afterglow\"\nreturn fx.stack { fx.t { gain = 8 } }\n";
  live().set_overrides({}, {}, std::make_shared<const std::string>(text));
  EXPECT_EQ(settled(), 4.f);
  live().set_overrides({{"t", "gain", "10"}});
  EXPECT_EQ(settled(), 5.f) << "overrides alone leave the text";
  live().set_overrides({}, {});
  EXPECT_EQ(settled(), file);
}

TEST_F(Live, ShowsAnyImageOfTheGraph) {
  open_unwatched();
  EXPECT_EQ(shown(), 1.f);
  EXPECT_THAT(live().images(), ElementsAre("source", "t.blur", "t.tint"));
  live().show("t.blur");
  EXPECT_EQ(settled(), 0.5f);
  EXPECT_THAT(session_->kernels(), ElementsAre("t.blur"));
  EXPECT_THAT(live().images(), ElementsAre("source", "t.blur", "t.tint")) << "whatever is shown";
  save(4);
  EXPECT_EQ(settled(), 0.5f);
  live().show("source");
  EXPECT_EQ(settled(), 0.5f);
  EXPECT_FALSE(session_->images().ran);
  live().show("t.gone");
  EXPECT_EQ(settled(), 2.f);
  ASSERT_EQ(live().status().warnings.size(), 1u);
  EXPECT_THAT(live().status().warnings[0], HasSubstr("no image 't.gone'"));
  live().show("");
  EXPECT_EQ(settled(), 2.f);
  EXPECT_TRUE(live().status().warnings.empty());
}

TEST_F(Live, FollowsEachWayOfSaving) {
  open();
  EXPECT_EQ(live().status().watching, "inotify");
  EXPECT_EQ(shown(), 1.f);
  save(4);
  EXPECT_TRUE(comes(2.f)) << "truncated and written";
  write("look.lua~", preset(6));
  fs::rename(folder_ / "look.lua~", folder_ / "look.lua");
  EXPECT_TRUE(comes(3.f)) << "renamed over";
  fs::remove(folder_ / "look.lua");
  EXPECT_TRUE(fails("no such file"));
  EXPECT_EQ(shown(), 3.f);
  save(8);
  EXPECT_TRUE(comes(4.f)) << "gone for a moment";
  const fs::path away = folder_.string() + "_away";
  fs::rename(folder_, away);
  EXPECT_TRUE(fails("no such file"));
  std::ofstream(away / "look.lua") << preset(10);
  fs::rename(away, folder_);
  EXPECT_TRUE(comes(5.f)) << "the folder was moved and came back";
  std::string text = effect("t");
  write("effects/t.lua", text.replace(text.find("gain = s.gain"), 13, "gain = s.gain * 2"));
  write("shaders/t/lib.glsl", "vec3 tinted(vec3 c, float gain) { return c * gain + 1.0; }\n");
  save(2);
  EXPECT_TRUE(comes(3.f)) << "several files at once";
}

TEST_F(Live, FollowsShadersThatOnlyLaterFramesUse) {
  write("shaders/t/late.glsl", "vec4 apply(vec4 color) { return color; }\n");
  std::string late = effect("t");
  late.replace(late.find("return g:pass"), 13,
               "if g.frame > 5 then source = g:pass { shader = \"t/late\", source = blur, "
               "name = \"late\" } return source end return g:pass");
  write("effects/t.lua", late);
  open();
  EXPECT_EQ(shown(), 1.f);
  const auto at_frame = [&](double frame) {
    Picture p = picture();
    BuildContext context;
    context.frame = frame;
    EXPECT_TRUE(session_->process(p, context));
    HostResult out;
    EXPECT_TRUE(session_->read_result(out));
    return out.pixels[0];
  };
  EXPECT_EQ(at_frame(9), 0.5f);
  live().settle();
  write("shaders/t/late.glsl", "vec4 apply(vec4 color) { return color * 8.0; }\n");
  EXPECT_TRUE(wait_for([&] { return at_frame(9) == 4.f; }));
}

TEST_F(Live, PollingFollowsToo) {
  using namespace std::chrono_literals;
  LiveOptions options;
  options.watch = {.poll = true, .interval = 2ms};
  open(options);
  EXPECT_THAT(live().status().watching, HasSubstr("polling every 2 ms"));
  EXPECT_EQ(shown(), 1.f);
  save(4);
  EXPECT_TRUE(comes(2.f));
  save(6);  // of the same size, within the same tick perhaps
  EXPECT_TRUE(comes(3.f));
  write("look.lua", "while true do end\n");
  EXPECT_TRUE(fails("instruction budget spent")) << "looks that find nothing end no script";
}

}  // namespace
}  // namespace afterglow

// SPDX-License-Identifier: MIT
// fx.volume: how settings blend. A table computed by hand, and random stacks against a plain re-implementation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "scene.h"
#include "script/explanation.h"

namespace afterglow::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const char* const kGlow = R"(
  settings = {
    mode = fx.enum { "soft", "hard", "wild", default = "soft" },
    levels = fx.int { min = 0, max = 100, default = 4 },
    gain = fx.float { min = -100, max = 100, default = 1 },
    fade = fx.bool { default = false },
    tint = fx.color { default = { 1, 1, 1 } },
    shift = fx.vec2 { default = { 0, 0 } },
    origin = fx.vec3 { default = { 0, 0, 0 } },
  },
  active = function(s) return s.gain ~= 0, "gain is 0" end,
  build = function(g, s, source)
    return g:pass { shader = "glow", source = source, gain = s.gain, tint = s.tint, levels = s.levels }
  end,)";

struct Volumes : testing::Test {
  Volumes() {
    scene.effect("glow", kGlow);
    scene.write("shaders/glow.glsl",
                "uniform float gain; uniform vec3 tint; uniform int levels;\n"
                "vec4 apply(vec4 color) { return color * gain * float(levels) * vec4(tint, 1.0); }\n");
  }

  // Settings of the first entry at a position, as texts.
  std::vector<std::string> values(const std::optional<Position>& position) {
    scene.context.position = position;
    auto preset = scene.load();
    if (!preset) return {preset.error().text()};
    const auto build = scene.evaluate(*preset);
    if (!build) return {build.error().text()};
    std::vector<std::string> out;
    for (const auto& [name, value] : build->entries->at(0).settings) out.push_back(value.text());
    return out;
  }
  std::string gain(const std::optional<Position>& position) { return values(position).at(2); }
  std::string error(const std::string& volume) {
    scene.stack("fx.glow {},\n" + volume);
    return scene.load_error();
  }
  Scene scene;
};

constexpr const char* kEverything =
    "settings = { glow = { mode = \"hard\", levels = 9, gain = 3, fade = true, tint = { 3, 1, 0 }, shift = { 8, -8 }, "
    "origin = { 0, 4, -4 } } }";

TEST_F(Volumes, EachTypeBlendsByTheFactor) {
  const auto with = [&](const std::string& weight) {
    scene.stack("fx.glow {}, fx.volume { weight = " + weight + ", " + kEverything + " }");
    return values({});
  };
  EXPECT_THAT(with("0"), ElementsAre("\"soft\"", "4", "1", "false", "{1, 1, 1}", "{0, 0}", "{0, 0, 0}"));
  // 4 + 5/4 = 5.25; 1 + 2/4; {1, 1, 1} + {2, 0, -1}/4
  EXPECT_THAT(with("0.25"), ElementsAre("\"soft\"", "5", "1.5", "false", "{1.5, 1, 0.75}", "{2, -2}", "{0, 1, -1}"));
  // 4 + 5/2 = 6.5, rounded up; choices change at a half
  EXPECT_THAT(with("0.5"), ElementsAre("\"hard\"", "7", "2", "true", "{2, 1, 0.5}", "{4, -4}", "{0, 2, -2}"));
  const auto all = ElementsAre("\"hard\"", "9", "3", "true", "{3, 1, 0}", "{8, -8}", "{0, 4, -4}");
  EXPECT_THAT(with("1"), all);
  EXPECT_THAT(with("7"), all);  // weights are held to 0…1
  EXPECT_THAT(with("-1"), ElementsAre("\"soft\"", "4", "1", "false", "{1, 1, 1}", "{0, 0}", "{0, 0, 0}"));
}

TEST_F(Volumes, SnapAtDecidesWhereChoicesChange) {
  const auto mode = [&](const std::string& keys) {
    scene.stack("fx.glow {}, fx.volume { " + keys + ", settings = { glow = { mode = \"hard\", fade = true } } }");
    return values({})[0] + values({})[3];
  };
  EXPECT_EQ(mode("weight = 0.7, snap_at = 0.75"), "\"soft\"false");
  EXPECT_EQ(mode("weight = 0.75, snap_at = 0.75"), "\"hard\"true");
  EXPECT_EQ(mode("weight = 0.01, snap_at = 0"), "\"hard\"true");
  EXPECT_EQ(mode("weight = 0, snap_at = 0"), "\"soft\"false");  // a volume without weight is not there
}

// Sphere of radius 2 around (10, 0, 0), blend distance 4, gain 1 → 5: factor 1 − (d/4)², gain 1 + 4·factor.
TEST_F(Volumes, SphereByHand) {
  const std::string sphere =
      "shape = { \"sphere\", center = { 10, 0, 0 }, radius = 2 }, settings = { glow = { gain = 5 } }";
  scene.stack("fx.glow {}, fx.volume { blend_distance = 4, " + sphere + " }");
  EXPECT_EQ(gain(Position{10, 0, 0}), "5");
  EXPECT_EQ(gain(Position{10, 2, 0}), "5");     // on the surface
  EXPECT_EQ(gain(Position{10, 0, 3}), "4.75");  // d = 1: 1 − 1/16
  EXPECT_EQ(gain(Position{6, 0, 0}), "4");      // d = 2: 3/4
  EXPECT_EQ(gain(Position{15, 0, 0}), "2.75");  // d = 3: 7/16
  EXPECT_EQ(gain(Position{16, 0, 0}), "1");     // d = 4
  EXPECT_EQ(gain(Position{99, 0, 0}), "1");
  scene.stack("fx.glow {}, fx.volume { blend_distance = 4, weight = 0.5, " + sphere + " }");
  EXPECT_EQ(gain(Position{6, 0, 0}), "2.5");                // half of 3/4
  scene.stack("fx.glow {}, fx.volume { " + sphere + " }");  // no blend distance: inside or nothing
  EXPECT_EQ(gain(Position{10, 2, 0}), "5");
  EXPECT_EQ(gain(Position{10, 2.001, 0}), "1");
}

TEST_F(Volumes, BoxByHand) {
  const auto box = [&](const std::string& more) {
    scene.stack(
        "fx.glow {}, fx.volume { blend_distance = 5, shape = { \"box\", center = { 0, 1, 0 }, size = { 4, 2, 8 }" +
        more + " }, settings = { glow = { gain = 26 } } }");
  };
  box("");
  EXPECT_EQ(gain(Position{2, 2, 4}), "26");  // a corner
  EXPECT_EQ(gain(Position{3, 1, 0}), "25");  // d = 1: 1 + 25·(1 − 1/25)
  EXPECT_EQ(gain(Position{5, 6, 4}), "1");   // d = √(9 + 16)
  EXPECT_EQ(gain(Position{4, 4, 4}), "18");  // d² = 8
  box(", rotation = { 0, 90, 0 }");          // x and z change places
  EXPECT_EQ(gain(Position{4, 2, 2}), "26");
  EXPECT_EQ(gain(Position{5, 1, 0}), "25");
  EXPECT_EQ(gain(Position{0, 1, 3}), "25");
  // About z first, then x: the long side lies along z; z → −y goes by x.
  box(", rotation = { 90, 0, 90 }");
  // (x, y, z) of the box go to (−y, 0, x)… : Rz: x→y, y→−x; Rx: y→z, z→−y. So 4 along z, 2 along x, 8 along y.
  EXPECT_EQ(gain(Position{1, 5, 2}), "26");
  EXPECT_EQ(gain(Position{2, 1, 0}), "25");
  EXPECT_EQ(gain(Position{0, 6, 0}), "25");
  EXPECT_EQ(gain(Position{0, 1, 3}), "25");
}

TEST_F(Volumes, PriorityThenPositionInTheList) {
  scene.stack(R"(
    fx.volume { name = "top", priority = 2, settings = { glow = { gain = 10 } } },
    fx.glow { gain = 2 },
    fx.volume { name = "half", priority = 3, weight = 0.5, settings = { glow = { gain = 20 } } },
    fx.volume { name = "first", priority = -1, settings = { glow = { gain = 50, levels = 7 } } },
    fx.volume { name = "second", priority = 2, settings = { glow = { gain = 12 } } },)");
  // 2 → 50 → 10 → 12 → 16
  EXPECT_EQ(gain({}), "16");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  const auto build = scene.evaluate(*preset);
  ASSERT_TRUE(build);
  const Explanation& explanation = *build->explanation;
  std::vector<std::string> names;
  for (const auto& volume : explanation.volumes) names.push_back(volume.name);
  EXPECT_THAT(names, ElementsAre("first", "top", "second", "half"));
  const SettingHistory& history = explanation.entries[0].settings[2];
  EXPECT_EQ(history.default_value.number[0], 1);
  EXPECT_EQ(history.preset->number[0], 2);
  std::vector<double> results;
  for (const auto& step : history.volumes) results.push_back(step.result.number[0]);
  EXPECT_THAT(results, ElementsAre(50, 10, 12, 16));
  EXPECT_EQ(history.value.number[0], 16);
  EXPECT_THAT(explanation.entries[0].settings[3].volumes, IsEmpty());  // not named by any
}

TEST_F(Volumes, OverridesComeLast) {
  scene.stack("fx.glow {}, fx.volume { settings = { glow = { gain = 9 } } }");
  scene.options.overrides.push_back(*parse_override("glow.gain=0.5"));
  EXPECT_EQ(gain({}), "0.5");
}

TEST_F(Volumes, ActivityIsTestedAfterBlending) {
  scene.stack("fx.glow { gain = 0 }, fx.volume { settings = { glow = { gain = 1 } } }");
  EXPECT_EQ(scene.graph().passes.size(), 1u);
  scene.stack("fx.glow { gain = 5 }, fx.volume { settings = { glow = { gain = 0 } } }");
  const Graph off = scene.graph();
  EXPECT_EQ(off.passes.size(), 0u);
  EXPECT_EQ(off.skipped.at(0).reason, "gain is 0");
}

TEST_F(Volumes, ByNameBeforeEffect) {
  scene.stack("fx.glow {}, fx.glow { name = \"rim\" }, fx.volume { settings = { rim = { gain = 2 } } }");
  EXPECT_EQ(gain({}), "1");
  scene.stack("fx.glow { name = \"a\" }, fx.glow { name = \"b\" }, fx.volume { settings = { glow = { gain = 2 } } }");
  EXPECT_EQ(gain({}), "2");
}

TEST_F(Volumes, WhereThePositionComesFrom) {
  const std::string local =
      "fx.volume { name = \"cave\", shape = { \"sphere\", radius = 1 }, settings = { glow = { gain = 5 } } }";
  scene.stack("fx.glow {}, " + local);
  EXPECT_EQ(gain({}), "1");
  EXPECT_THAT(scene.warnings,
              ElementsAre(HasSubstr("volume 'cave' and others like it do not count: no position is known")));
  EXPECT_EQ(gain(Position{0, 0, 0}), "5");
  EXPECT_EQ(gain(Position{2, 0, 0}), "1");
  // The preset's goes before the picture's, and --at before both.
  scene.stack("position = { 0, 0, 0 }, fx.glow {}, " + local);
  EXPECT_EQ(gain(Position{2, 0, 0}), "5");
  scene.options.at = Position{0, 3, 0};
  EXPECT_EQ(gain(Position{0, 0, 0}), "1");
  scene.options.at.reset();
  scene.stack("position = fx.curve { { 1, { 0, 0, 0 } }, { 11, { 10, 0, 0 } } }, fx.glow {}, " + local);
  scene.context.frame = 2;
  EXPECT_EQ(gain({}), "5");
  scene.context.frame = 3;
  EXPECT_EQ(gain({}), "1");
}

TEST_F(Volumes, InputsThatABlendedSettingMayAskForAreNeeded) {
  scene.effect("lines", R"(
    settings = { deep = fx.bool { default = false }, on = fx.bool { default = false } },
    active = function(s) return s.on, "off" end,
    needs = function(s) if s.deep then return { "depth" } end end,
    build = function(g, s, source) return source end,)");
  scene.stack("fx.lines {}");
  EXPECT_THAT(scene.load()->needs(), IsEmpty());
  scene.stack("fx.lines {}, fx.volume { weight = 0, settings = { lines = { deep = true } } }");
  EXPECT_THAT(scene.load()->needs(), IsEmpty()) << "no frame asks for it";
  EXPECT_THAT(scene.load()->possible_needs(), testing::Contains("depth"));
  scene.stack(
      "fx.lines { on = true }, fx.volume { weight = function(t) return t.frame < 5 and 0 or 1 end, settings = { lines "
      "= { deep = true } } }");
  auto preset = scene.load();
  ASSERT_TRUE(preset);
  const auto asked = [&](double frame) {
    return preset->note_needs({.size = {8, 8}, .auxiliary = {}, .frame = frame});
  };
  EXPECT_EQ(asked(1).value(), false);
  EXPECT_THAT(preset->needs(), IsEmpty());
  EXPECT_EQ(asked(5).value(), true);
  EXPECT_THAT(preset->needs(), testing::ElementsAre("depth")) << "and nothing else";
}

TEST_F(Volumes, Messages) {
  const auto volume = [&](const std::string& keys) { return error("fx.volume {\n" + keys + "\n}"); };
  EXPECT_EQ(
      volume("settings = { glow = { gian = 1 } }"),
      "preset.lua:5: error: fx.volume: effect 'glow' has no setting 'gian'; allowed: mode, levels, gain, fade, tint, "
      "shift, origin; did you mean 'gain'?");
  EXPECT_EQ(volume("settings = {\n glw = {} ,\n glw = { gain = 1 } }"),
            "preset.lua:7: error: fx.volume: the stack has no entry 'glw'; allowed: glow; did you mean 'glow'?");
  EXPECT_EQ(volume("settings = { glow = {\n gain = 101 } }"),
            "preset.lua:6: error: fx.volume: glow.gain = 101 is out of range; allowed: -100…100");
  EXPECT_EQ(volume("settings = { glow = {\n mode = \"sfot\" } }"),
            "preset.lua:6: error: fx.volume: glow.mode = \"sfot\" is not a choice; allowed: soft, hard, wild; did you "
            "mean 'soft'?");
  EXPECT_EQ(volume("settings = { glow = 3 }"), "preset.lua:5: error: fx.volume: settings.glow = 3 is not a table");
  EXPECT_EQ(volume("weight = 1"), "preset.lua:4: error: fx.volume: settings = nil is not a table");
  EXPECT_EQ(volume("settings = {}, wieght = 1"),
            "preset.lua:5: error: fx.volume has no 'wieght'; allowed: blend_distance, name, priority, settings, shape, "
            "snap_at, weight; did you mean 'weight'?");
  EXPECT_EQ(
      volume("settings = {},\n shape = { \"spehre\" }"),
      "preset.lua:6: error: fx.volume: unknown shape \"spehre\"; allowed: \"global\", { \"box\", … }, { \"sphere\", … "
      "}; did you mean 'sphere'?");
  EXPECT_EQ(volume("settings = {},\n shape = { \"sphere\",\n size = { 1, 1, 1 } }"),
            "preset.lua:7: error: shape has no 'size'; allowed: center, radius");
  EXPECT_EQ(volume("settings = {},\n shape = { \"box\",\n size = { 1, -1, 1 } }"),
            "preset.lua:7: error: shape: size = {1, -1, 1} is out of range; allowed: {x, y, z}, each ≥ 0");
  EXPECT_EQ(volume("settings = {},\n blend_distance = -1"),
            "preset.lua:6: error: fx.volume: blend_distance = -1 is out of range; allowed: 0…1e+30");
  EXPECT_EQ(volume("settings = {},\n snap_at = 1.5"),
            "preset.lua:6: error: fx.volume: snap_at = 1.5 is out of range; allowed: 0…1");
  EXPECT_EQ(error("fx.volume"),
            "preset.lua:4: error: fx.stack: position 2 is an effect without settings; allowed: fx.NAME { … }, "
            "fx.group { … }, fx.mix { … }, fx.volume { … }, a list of them");
}

// ---- random stacks

struct PlainVolume {
  double priority, weight, blend;
  int shape;  // 0 global, 1 box, 2 sphere
  double center[3], size[3], rotation[3], radius, snap;
  std::optional<double> gain, tint[3];
  std::optional<int> levels;
  std::optional<std::string> mode;
};
struct PlainSettings {
  double gain = 1, tint[3] = {1, 1, 1};
  int levels = 4;
  std::string mode = "soft";
};

// v turned about an axis by the right-hand rule.
void turn(double (&v)[3], int axis, double degrees) {
  const double angle = degrees * 3.14159265358979323846 / 180;
  const int a = (axis + 1) % 3, b = (axis + 2) % 3;
  const double x = v[a], y = v[b];
  v[a] = x * std::cos(angle) - y * std::sin(angle);
  v[b] = x * std::sin(angle) + y * std::cos(angle);
}

// The box's axes as they lie in the scene; the distance from the parts along them that stick out.
double plain_distance(const PlainVolume& v, const double (&p)[3]) {
  const double d[3] = {p[0] - v.center[0], p[1] - v.center[1], p[2] - v.center[2]};
  if (v.shape == 0) return 0;
  if (v.shape == 2) return std::max(0.0, std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - v.radius);
  double squares = 0;
  for (int side = 0; side < 3; ++side) {
    double axis[3] = {side == 0 ? 1. : 0., side == 1 ? 1. : 0., side == 2 ? 1. : 0.};
    turn(axis, 2, v.rotation[2]);
    turn(axis, 0, v.rotation[0]);
    turn(axis, 1, v.rotation[1]);
    const double along = std::abs(d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2]);
    if (along > v.size[side] / 2) squares += std::pow(along - v.size[side] / 2, 2);
  }
  return std::sqrt(squares);
}

PlainSettings plain_blend(std::vector<PlainVolume> volumes, const double (&p)[3]) {
  PlainSettings s;
  // Insertion sort: stable, and not the engine's.
  for (std::size_t i = 1; i < volumes.size(); ++i)
    for (std::size_t j = i; j > 0 && volumes[j].priority < volumes[j - 1].priority; --j)
      std::swap(volumes[j], volumes[j - 1]);
  for (const auto& v : volumes) {
    const double d = plain_distance(v, p);
    if (v.shape != 0 && v.blend == 0 && d > 0) continue;
    if (v.shape != 0 && d * d > v.blend * v.blend) continue;
    double f = v.weight < 0 ? 0 : v.weight > 1 ? 1 : v.weight;
    if (v.shape != 0 && v.blend > 0) f *= 1 - d * d / (v.blend * v.blend);
    if (f <= 0) continue;
    if (v.gain) s.gain += (*v.gain - s.gain) * f;
    if (v.tint[0])
      for (int i = 0; i < 3; ++i) s.tint[i] += (*v.tint[i] - s.tint[i]) * f;
    if (v.levels) s.levels = static_cast<int>(std::floor(s.levels + (*v.levels - s.levels) * f + 0.5));
    if (v.mode && f >= v.snap) s.mode = *v.mode;
  }
  return s;
}

// All digits.
std::string exact(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}
std::string list(const double (&v)[3]) { return "{ " + exact(v[0]) + ", " + exact(v[1]) + ", " + exact(v[2]) + " }"; }

TEST_F(Volumes, AThousandRandomSetsMatchAPlainReimplementation) {
  std::mt19937 random(20261121);
  const auto real = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  const auto chance = [&](double p) { return real(0, 1) < p; };
  int local = 0, snapped = 0;
  for (int set = 0; set < 1000; ++set) {
    std::vector<PlainVolume> volumes(1 + random() % 6);
    std::string items = "fx.glow {},\n";
    for (auto& v : volumes) {
      v.priority = static_cast<int>(random() % 4) - 1;
      v.weight = chance(0.2) ? 1 : real(-0.2, 1.2);
      v.blend = chance(0.2) ? 0 : real(0, 8);
      v.shape = static_cast<int>(random() % 3);
      v.radius = real(0, 4);
      v.snap = chance(0.5) ? 0.5 : real(0, 1);
      for (int i = 0; i < 3; ++i) {
        v.center[i] = real(-4, 4);
        v.size[i] = real(0, 6);
        v.rotation[i] = chance(0.3) ? 0 : real(-180, 180);
      }
      std::string settings;
      if (chance(0.7)) settings += "gain = " + exact(*(v.gain = real(-100, 100))) + ", ";
      if (chance(0.5)) {
        double tint[3];
        for (int i = 0; i < 3; ++i) v.tint[i] = tint[i] = real(0, 4);
        settings += "tint = " + list(tint) + ", ";
      }
      if (chance(0.6)) settings += "levels = " + std::to_string(*(v.levels = static_cast<int>(random() % 101))) + ", ";
      if (chance(0.6)) settings += "mode = \"" + *(v.mode = chance(0.5) ? "hard" : "wild") + "\", ";
      const std::string shapes[] = {
          "\"global\"",
          "{ \"box\", center = " + list(v.center) + ", size = " + list(v.size) + ", rotation = " + list(v.rotation) +
              " }",
          "{ \"sphere\", center = " + list(v.center) + ", radius = " + exact(v.radius) + " }"};
      items += "fx.volume { priority = " + exact(v.priority) + ", weight = " + exact(v.weight) +
               ", blend_distance = " + exact(v.blend) + ", snap_at = " + exact(v.snap) +
               ", shape = " + shapes[v.shape] + ", settings = { glow = { " + settings + "} } },\n";
    }
    const double p[3] = {real(-6, 6), real(-6, 6), real(-6, 6)};
    scene.stack(items);
    scene.context.position = Position{p[0], p[1], p[2]};
    auto preset = scene.load();
    ASSERT_TRUE(preset) << preset.error().text() << items;
    const auto build = scene.evaluate(*preset);
    ASSERT_TRUE(build);
    const auto& settings = build->entries->at(0).settings;
    const PlainSettings expected = plain_blend(volumes, p);
    EXPECT_EQ(settings[0].second.choice, expected.mode) << items;
    EXPECT_EQ(settings[1].second.number[0], expected.levels) << items;
    EXPECT_NEAR(settings[2].second.number[0], expected.gain, 1e-9) << items;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(settings[4].second.number[i], expected.tint[i], 1e-9) << items;
    for (const auto& volume : build->explanation->volumes) local += volume.distance && volume.factor > 0;
    snapped += expected.mode != "soft";
  }
  EXPECT_GT(local, 300) << "the sets must have something to blend";
  EXPECT_GT(snapped, 300);
}

}  // namespace
}  // namespace afterglow::test

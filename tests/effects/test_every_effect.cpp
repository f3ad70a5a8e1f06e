// SPDX-License-Identifier: MIT
// What holds for every effect that is found on the search path, whatever it is: nobody has to write a line here for a
// new one. Its settings are read from its own declaration, and tried at their defaults, limits and choices.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/paths.h"
#include "files.h"
#include "harness.h"

namespace afterglow {
namespace {

using namespace reference;

std::vector<EffectSchema> every_effect() {
  setenv("AFTERGLOW_HOME", AFTERGLOW_PROJECT_FOLDER, 1);
  Diagnostics diagnostics;
  auto found = list_effects(search_path_for({}, {}), diagnostics);
  if (!found) throw std::runtime_error(found.error().text());
  return std::move(*found);
}

/// A file that the setting allows; empty when there is none of its kind here.
std::string sample_file(const SettingSchema& setting) {
  const auto allows = [&](const char* extension) {
    return std::ranges::find(setting.choices, extension) != setting.choices.end();
  };
  if (allows("ocio")) return "ocio/aces.ocio";  // of the installation
  if (!allows("cube")) return {};
  std::string text = "LUT_3D_SIZE 3\n";
  for (int i = 0; i < 27; ++i)
    text += fmt::format("{:.3f} {:.3f} {:.3f}\n", std::sqrt(i % 3 * 0.5), i / 3 % 3 * 0.45 + 0.1, i / 9 * i / 9 * 0.25);
  write_test_file("sample.cube", text);
  return "sample.cube";
}

enum class Side { low, high };

std::string at_limit(const SettingSchema& setting, Side side) {
  const double open = setting.type == SettingType::integer ? 1e4 : 1e12;  // where nothing limits it
  const double low = setting.min.value_or(-open), high = setting.max.value_or(open);
  const std::string value = fmt::format("{}", side == Side::low ? low : high);
  const std::string bright = side == Side::low ? "0" : "1e30";
  switch (setting.type) {
    case SettingType::integer:
      return fmt::format("{}", static_cast<long long>(side == Side::low ? low : high));
    case SettingType::number:
      return value;
    case SettingType::vec2:
      return fmt::format("{{ {0}, {0} }}", value);
    case SettingType::vec3:
      return fmt::format("{{ {0}, {0}, {0} }}", value);
    case SettingType::color:
      return fmt::format("{{ {0}, {0}, {0} }}", bright);
    case SettingType::boolean:
      return side == Side::low ? "false" : "true";
    case SettingType::enumeration:
      return fmt::format("\"{}\"", side == Side::low ? setting.choices.front() : setting.choices.back());
    case SettingType::text:
      return "\"\"";
    case SettingType::file:
      return fmt::format("\"{}\"", sample_file(setting));
  }
  return {};
}

using Values = std::vector<std::pair<std::string, std::string>>;

/// fx.NAME { … }, with a file for each setting that wants one.
std::string entry_of(const EffectSchema& effect, Values values = {}) {
  for (const auto& setting : effect.settings)
    if (setting.type == SettingType::file &&
        std::ranges::find(values, setting.name, &Values::value_type::first) == values.end())
      values.emplace_back(setting.name, fmt::format("\"{}\"", sample_file(setting)));
  std::string out = "fx." + effect.name + " { ";
  for (const auto& [name, value] : values) out += fmt::format("{} = {}, ", name, value);
  return out + "}";
}

/// Everything at one end.
std::string all_at(const EffectSchema& effect, Side side) {
  Values values;
  for (const auto& setting : effect.settings) values.emplace_back(setting.name, at_limit(setting, side));
  return entry_of(effect, values);
}

/// The defaults with one setting at an end or another choice.
std::vector<std::string> one_by_one(const EffectSchema& effect) {
  std::vector<std::string> entries{entry_of(effect)};
  for (const auto& setting : effect.settings) {
    if (setting.type == SettingType::file) continue;
    if (setting.type == SettingType::enumeration) {
      for (const auto& choice : setting.choices)
        entries.push_back(entry_of(effect, {{setting.name, fmt::format("\"{}\"", choice)}}));
      continue;
    }
    for (const Side side : {Side::low, Side::high})
      entries.push_back(entry_of(effect, {{setting.name, at_limit(setting, side)}}));
  }
  return entries;
}

/// Settings that the effect itself refuses (near beyond far) are no settings.
bool is_refused(const std::string& entry, const Scene& scene) { return !build_error(entry, scene).empty(); }

/// With motion of all lengths and directions.
Scene moving(Scene scene) {
  auto& motion = scene.motion.emplace(scene.source.size());
  for (std::size_t i = 0; i < motion.pixels.size(); ++i) {
    const double angle = static_cast<double>(i) * 0.37, length = static_cast<double>(i % 97);
    motion.pixels[i] = Rgba(std::cos(angle) * length, std::sin(angle) * length, 0, 1);
  }
  motion = in_floats(motion);
  return scene;
}

/// The most extreme light that the source of a stack may hold.
Scene stress_scene() {
  static constexpr double kValues[] = {0, 1e30, 65504, 1e4, 1e-38, 1e-10, 0.18, 1, 60, 3e29, 1e20, 65536};
  Scene scene = random_scene({37, 23}, 81);
  scene.name = "stress";
  for (std::size_t i = 0; i < scene.source.pixels.size(); ++i) {
    const auto any = [&](std::size_t k) { return kValues[(i * 7 + k * 5 + i * i / 11) % std::size(kValues)]; };
    scene.source.pixels[i] = Rgba(any(0), any(1), any(2), i % 3 * 0.5);
    scene.depth->pixels[i].r = any(3);
  }
  scene.source = in_floats(scene.source);
  scene.depth = in_floats(*scene.depth);
  return moving(std::move(scene));
}

TEST_F(Effects, EveryEffectStaysFiniteAtTheEndsOfItsSettings) {
  const auto scene = stress_scene();
  int tried = 0;
  for (const auto& effect : every_effect()) {
    auto entries = one_by_one(effect);
    for (const Side side : {Side::low, Side::high}) entries.push_back(all_at(effect, side));
    for (const auto& entry : entries) {
      if (is_refused(entry, scene)) continue;
      const Made made = run_stack(entry, scene, Way::fused);
      EXPECT_TRUE(all_finite(made.result)) << entry;
      EXPECT_TRUE(alpha_is_kept(made, scene)) << entry;
      ++tried;
    }
  }
  EXPECT_GT(tried, 200);
}

TEST_F(Effects, EveryEffectJoinedIsWhatItIsByItself) {
  const auto scene = moving(neon_scene({96, 54}, 560, 330));
  // Pixel passes on both sides, which it is fused with where that can be.
  const std::string before =
      "fx.channel_mixer { name = \"before\", at = \"after_opaque_and_sky\", order = -1000, red_out_green_in = 10 }, ";
  const std::string behind =
      ", fx.channel_mixer { name = \"behind\", at = \"after_post_process\", order = 1000, green_out_blue_in = 10 }";
  for (const auto& effect : every_effect())
    for (const auto& entry : {entry_of(effect), all_at(effect, Side::low)}) {
      if (is_refused(entry, scene)) continue;
      const Made plain = run_stack(before + entry + behind, scene, Way::plain);
      const Made fused = run_stack(before + entry + behind, scene, Way::fused);
      EXPECT_LE(fused.kernels, plain.kernels);
      EXPECT_TRUE(agrees(fused.result, from_floats(plain.result.data(), plain.size, 4), 1e-4, kRgba)) << entry;
    }
}

/// Nothing changes, to the last bit.
bool is_identity(const std::string& entry, const Scene& scene) {
  if (is_refused(entry, scene)) return false;
  const Made made = run_stack(entry, scene, Way::fused);
  for (std::size_t i = 0; i < scene.source.pixels.size(); ++i)
    for (int c = 0; c < 4; ++c)
      if (made.result[4 * i + static_cast<std::size_t>(c)] != static_cast<float>(scene.source.pixels[i][c]))
        return false;
  return true;
}

/// Settings that should leave a picture as it is: the defaults, and whatever says how much at nothing.
std::vector<std::string> neutral_entries(const EffectSchema& effect) {
  Values nothing;
  std::vector<std::string> entries{"fx." + effect.name + " {}"};
  for (const auto& setting : effect.settings) {
    if (setting.type == SettingType::enumeration && std::ranges::find(setting.choices, "none") != setting.choices.end())
      entries.push_back(entry_of(effect, {{setting.name, "\"none\""}}));
    if (setting.type != SettingType::integer && setting.type != SettingType::number) continue;
    const double low = setting.min.value_or(0), at = low <= 0 ? 0 : low;
    nothing.emplace_back(setting.name, fmt::format("{}", at));
    entries.push_back(entry_of(effect, {nothing.back()}));
  }
  entries.push_back(entry_of(effect, nothing));
  return entries;
}

/// fx.NAME { … } with files that change nothing, for effects that cannot do without one: a view that gives every colour
/// the code of an sRGB display.
std::string with_neutral_files(const EffectSchema& effect) {
  std::string settings;
  for (const auto& setting : effect.settings) {
    if (setting.type != SettingType::file || std::ranges::find(setting.choices, "ocio") == setting.choices.end())
      continue;
    write_test_file("neutral.ocio", R"(ocio_profile_version: 2
roles: {default: lin_rec709, scene_linear: lin_rec709}
file_rules: [!<Rule> {name: Default, colorspace: lin_rec709}]
displays: {Monitor: [!<View> {name: Plain, colorspace: sRGB}]}
colorspaces:
  - !<ColorSpace> {name: lin_rec709}
  - !<ColorSpace>
    name: sRGB
    from_scene_reference: !<ExponentWithLinearTransform> {gamma: 2.4, offset: 0.055, direction: inverse}
)");
    settings += setting.name + " = \"neutral.ocio\"";
  }
  return "fx." + effect.name + " { " + settings + " }";
}

TEST_F(Effects, EveryEffectHasSettingsThatChangeNothing) {
  const auto scene = moving(random_scene({24, 18}, 82));
  // What has no such settings, like anti-aliasing, has nothing to do where there is nothing to see.
  Scene flat{"flat", DoubleImage(24, 18, Rgba(0.5, 0.25, 0.125, 1)), DoubleImage(24, 18, Rgba(4, 0, 0, 1)),
             DoubleImage(24, 18, Rgba(0, 0, 1, 0))};
  for (const auto& effect : every_effect()) {
    const auto entries = neutral_entries(effect);
    const bool found = std::ranges::any_of(entries, [&](const auto& entry) { return is_identity(entry, scene); });
    if (found) continue;
    EXPECT_TRUE(agrees(run_stack(with_neutral_files(effect), flat, Way::fused).result, flat.source, 1e-6, kRgba))
        << effect.name << " changes every picture, whatever it is set to";
  }
}

}  // namespace
}  // namespace afterglow

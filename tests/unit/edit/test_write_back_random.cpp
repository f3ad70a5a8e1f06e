// SPDX-License-Identifier: MIT
// Random presets in random layouts with random edits: what is read back is what was wanted, nothing else is touched.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "core/file.h"
#include "core/lua_text.h"
#include "edit/write_back.h"
#include "scene.h"
#include "script/explanation.h"

namespace afterglow::test {
namespace {

namespace fs = std::filesystem;

using Random = std::mt19937;

std::size_t below(Random& random, std::size_t n) { return random() % n; }
const std::string& one_of(Random& random, const std::vector<std::string>& list) {
  return list[below(random, list.size())];
}

/// What stands between two tokens without meaning anything.
std::string space(Random& random, bool needed = false) {
  static const std::vector<std::string> pieces{
      "", " ", "  ", "\n", "\n\n\t", " --[[ c ]] ", " -- amount = 9, }\n", "--[==[ ]] \n { ]==]", "\r\n"};
  const std::string& piece = pieces[below(random, 3) ? below(random, 3) : below(random, pieces.size())];
  return piece.empty() && needed ? " " : piece;
}

std::string text_literal(Random& random, const std::string& content) {
  return one_of(random, {'"' + content + '"', '\'' + content + '\'', "[[" + content + "]]", "[=[" + content + "]=]"});
}

std::string key_text(Random& random, const std::string& key) {
  return below(random, 4)
             ? key
             : "[" + space(random, true) + one_of(random, {'"' + key + '"', '\'' + key + '\''}) + space(random) + "]";
}

/// A value of each setting of the effect below, in a random notation.
std::string value_text(Random& random, const std::string& setting) {
  if (setting == "amount") return one_of(random, {"1", "0.50", ".25", "1e1", "0x1F", "-3", "- 2.5", "3.", "0x.8p1"});
  if (setting == "steps") return one_of(random, {"1", "0x0A", "17", "2.0"});
  if (setting == "soft") return one_of(random, {"true", "false"});
  if (setting == "mode") return text_literal(random, one_of(random, {"plain", "fancy"}));
  if (setting == "tint" && below(random, 2)) return text_literal(random, one_of(random, {"#102030", "#FfEeDd"}));
  std::string out = "{" + space(random);
  for (int i = 0, n = setting == "offset" ? 2 : 3; i < n; ++i)
    out += (i ? "," + space(random) : "") + one_of(random, {"1", "0.5", "2e-1"}) + space(random);
  return out + one_of(random, {"", ",", ";"}) + "}";
}

const std::vector<std::string> kSettings{"amount", "steps", "soft", "mode", "tint", "offset"};

std::string entry_text(Random& random) {
  std::string out = "fx" + space(random) + ".glow" + space(random);
  const bool round = below(random, 4) == 0;
  out += (round ? "(" + space(random) : "") + "{" + space(random);
  std::vector<std::string> left = kSettings;
  std::shuffle(left.begin(), left.end(), random);
  left.resize(below(random, left.size() + 1));
  const std::string separator = one_of(random, {",", ",", ";"});
  for (std::size_t i = 0; i < left.size(); ++i) {
    out +=
        key_text(random, left[i]) + space(random) + "=" + space(random) + value_text(random, left[i]) + space(random);
    if (i + 1 < left.size() || below(random, 2)) out += separator + space(random);
  }
  return out + "}" + (round ? space(random) + ")" : "");
}

std::string preset_text(Random& random, std::size_t entries) {
  std::string out = space(random) + "local fx = require" + space(random) + "\"afterglow\"" + space(random, true) +
                    "\nreturn fx.stack" + space(random) + "{";
  for (std::size_t i = 0; i < entries; ++i)
    out += space(random) + entry_text(random) + space(random) + one_of(random, {",", ";"});
  return out + space(random) + "}" + space(random);
}

PresetEdit random_edit(Random& random, std::size_t entries) {
  const std::size_t which = 1 + below(random, entries);
  PresetEdit edit{which == 1 ? "glow" : "glow#" + std::to_string(which), one_of(random, kSettings)};
  if (below(random, 8) == 0) return edit;
  const auto fraction = [&] { return std::uniform_real_distribution<double>(0, 4)(random); };
  SettingValue value;
  if (edit.setting == "amount")
    value = {SettingType::number, {below(random, 2) ? fraction() - 2 : static_cast<float>(fraction())}, ""};
  if (edit.setting == "steps") value = {SettingType::integer, {static_cast<double>(below(random, 256))}, ""};
  if (edit.setting == "soft") value = {SettingType::boolean, {static_cast<double>(below(random, 2))}, ""};
  if (edit.setting == "mode") value = {SettingType::enumeration, {}, below(random, 2) ? "plain" : "fancy"};
  if (edit.setting == "tint") value = {SettingType::color, {fraction(), below(random, 2) ? 1.0 : 0.0, 1}, ""};
  if (edit.setting == "offset") value = {SettingType::vec2, {fraction(), -fraction(), 0}, ""};
  edit.value = value;
  return edit;
}

/// Every comment of the text, in order.
std::vector<std::string> comments(const std::string& text) {
  const LuaText lua(text);
  std::vector<std::string> out;
  std::size_t at = 0;
  for (std::size_t i = 0; i <= lua.size(); ++i) {
    const std::size_t end = i < lua.size() ? lua[i].begin : text.size();
    std::string gap = text.substr(at, end - at);
    std::erase_if(gap, [](char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; });
    if (!gap.empty()) out.push_back(gap);
    if (i < lua.size()) at = lua[i].end();
  }
  return out;
}

std::string fused(const std::vector<std::string>& parts) {
  std::string out;
  for (const auto& part : parts) out += part;
  return out;
}

/// Bytes of `before` that `after` does not have in the same order: what is left out of their longest common part.
std::size_t lost_bytes(const std::string& before, const std::string& after) {
  std::vector<std::size_t> row(after.size() + 1), last;
  for (const char c : before) {
    last = row;
    for (std::size_t j = 1; j <= after.size(); ++j)
      row[j] = after[j - 1] == c ? last[j - 1] + 1 : std::max(last[j], row[j - 1]);
  }
  return before.size() - row.back();
}

/// What the changes may take away: the values themselves; of keys that are removed all that belongs to them.
std::size_t allowed_loss(const std::vector<WrittenSetting>& written) {
  std::size_t bytes = 0;
  for (const auto& one : written) bytes += one.before.size() + (one.after.empty() ? one.name.size() + 40 : 0);
  return bytes;
}

class RandomWriteBack : public ::testing::Test {
 protected:
  RandomWriteBack() {
    scene.effect("glow", R"(at = "post_process",
  settings = { amount = fx.float { default = 0.5 }, steps = fx.int { default = 4 }, soft = fx.bool { default = true },
    mode = fx.enum { "plain", "fancy", default = "plain" }, tint = fx.color { default = { 1, 1, 1 } },
    offset = fx.vec2 { default = { 0, 0 } } },
  build = function(g, s, source) return source end)");
  }
  Scene scene;
};

TEST_F(RandomWriteBack, RoundTrips) {
  Random random(20261121);
  std::size_t written = 0;
  PresetWriter writer(scene.folder() / "preset.lua", scene.options);
  for (int round = 0; round < 300; ++round) {
    const std::size_t entries = 1 + below(random, 3);
    const std::string text = preset_text(random, entries);
    std::vector<PresetEdit> edits;
    for (std::size_t i = 0, n = 1 + below(random, 4); i < n; ++i) edits.push_back(random_edit(random, entries));
    SCOPED_TRACE(testing::Message() << "round " << round << ", " << edits[0].name() << "\n" << text);
    scene.preset(text);
    const auto plan = writer.plan(edits);
    ASSERT_TRUE(plan) << plan.error().text();
    for (const auto& refused : plan->refused) ADD_FAILURE() << refused.reason.text();
    ASSERT_TRUE(writer.save(*plan));
    SCOPED_TRACE(plan->text);

    // Read back by another road than the check that the writer makes: the settings of the loaded preset.
    scene.preset(plan->text);
    const auto preset = scene.load();
    ASSERT_TRUE(preset) << preset.error().text();
    std::map<std::string, PresetEdit> last;
    for (const auto& edit : edits) last[edit.name()] = edit;
    for (const auto& entry : preset->entries())
      for (const auto& [name, value] : entry.settings) {
        const auto edit = last.find(entry.name + "." + name);
        if (edit == last.end() || !edit->second.value) continue;
        EXPECT_EQ(value.choice, edit->second.value->choice);
        for (std::size_t i = 0; i < 3; ++i)
          EXPECT_EQ(static_cast<float>(value.number[i]), static_cast<float>(edit->second.value->number[i]))
              << entry.name << "." << name;
      }
    const auto is_list = [](const auto& edit) { return edit.setting == "tint" || edit.setting == "offset"; };
    if (std::none_of(edits.begin(), edits.end(), is_list)) {
      EXPECT_EQ(fused(comments(plan->text)), fused(comments(text)));
    }
    EXPECT_LE(lost_bytes(text, plan->text), allowed_loss(plan->written));
    const auto again = rewrite_preset(writer.file(), plan->text, edits, scene.options);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->text, plan->text);
    if (plan->text != text) {
      ++written;
      ASSERT_TRUE(writer.undo());
      EXPECT_EQ(*read_file(writer.file()), text);
    }
  }
  EXPECT_GT(written, 250u);
}

TEST(WriteBackOfShippedPresets, EverySettingThatTheyWrite) {
  const fs::path folder = AFTERGLOW_PROJECT_FOLDER "/presets";
  std::size_t edits = 0;
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".lua" && entry.path().parent_path().filename() != "effects")
      files.push_back(entry.path());
  ASSERT_GT(files.size(), 10u);
  for (const auto& file : files) {
    const std::string text = *read_file(file);
    Diagnostics silent;
    ShaderLibrary shaders(search_path_for(file, {}));
    const auto preset = Preset::load(file, {}, shaders, silent);
    ASSERT_TRUE(preset) << preset.error().text();
    std::vector<PresetEdit> wanted;
    for (const auto& entry : preset->entries())
      for (const auto& setting : preset->schema(entry.effect).settings) {
        const auto found = std::find_if(entry.settings.begin(), entry.settings.end(),
                                        [&](const auto& s) { return s.first == setting.name; });
        SettingValue value = found->second;
        double& first = value.number[0];
        if (setting.type == SettingType::boolean)
          first = 1 - first;
        else if (setting.type == SettingType::enumeration)
          value.choice = value.choice == setting.choices[0] ? setting.choices.back() : setting.choices[0];
        else if (setting.type == SettingType::integer)
          first += setting.min && first > *setting.min ? -1 : 1;
        else
          first = (first + setting.min.value_or(0)) / 2;
        if (!(value == found->second)) wanted.push_back({entry.name, setting.name, value});
      }
    const auto out = rewrite_preset(file, text, wanted, {});
    ASSERT_TRUE(out) << file << ": " << out.error().text();
    for (const auto& refused : out->refused) ADD_FAILURE() << refused.reason.text();
    EXPECT_EQ(out->written.size(), wanted.size()) << file;
    EXPECT_EQ(fused(comments(out->text)), fused(comments(text))) << file;
    edits += wanted.size();
  }
  EXPECT_GT(edits, 100u);
}

TEST_F(RandomWriteBack, HostileTextsEndInAnAnswer) {
  Random random(7);
  std::vector<std::string> texts{"",
                                 "return",
                                 "fx.glow {",
                                 "\"",
                                 "[[",
                                 "--[==[",
                                 "fx.glow { amount = \"\\",
                                 std::string(200'000, '{'),
                                 std::string(200'000, '('),
                                 std::string(1000, '[') + "=",
                                 std::string("\xEF\xBB\xBF"),
                                 std::string("\0\0", 2)};
  const std::string good = "local fx = require \"afterglow\"\nreturn fx.stack { fx.glow { amount = 1 } }";
  std::string chain = good + "\n--";
  for (int i = 0; i < 100'000; ++i) chain += "f{}";
  texts.push_back(chain);
  std::string deep = "local fx = require \"afterglow\"\nlocal x = ";
  for (int i = 0; i < 150; ++i) deep += "{ a = ";
  deep += "1";
  for (int i = 0; i < 150; ++i) deep += " }";
  texts.push_back(deep + "\nreturn fx.stack { fx.glow { amount = 1 } }");
  for (int i = 0; i < 300; ++i) {
    std::string text = preset_text(random, 2);
    for (int cut = 0; cut < 3; ++cut) text.erase(below(random, text.size() + 1), below(random, 9));
    texts.push_back(text);
  }
  for (const auto& text : texts) {
    for (const auto& edit :
         {PresetEdit{"glow", "amount", SettingValue{SettingType::number, {0.75}, ""}}, PresetEdit{"glow", "mode"}}) {
      const auto out = rewrite_preset(scene.folder() / "preset.lua", text, {edit}, scene.options);
      EXPECT_TRUE(!out || out->before == text);
    }
    // Pure text, valid or not: the tokens lie in order within it.
    const LuaText lua(text);
    std::size_t at = 0;
    for (std::size_t i = 0; i < lua.size(); ++i) {
      ASSERT_GE(lua[i].begin, at);
      at = lua[i].end();
      if (lua.is(i, "{")) lua.items(i == 0 || i % 1000 == 0 ? i : lua.size() - 1);
    }
    ASSERT_LE(at, text.size());
  }
}

}  // namespace
}  // namespace afterglow::test

// SPDX-License-Identifier: MIT
// What effects declare: settings, promises, the light that they are made for. Help, completion, checks of presets and
// the command line, sliders and documents come from it.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/result.h"

namespace afterglow {

enum class SettingType { integer, number, boolean, enumeration, color, vec2, vec3, file, text };

/// How many numbers a value is; 0: it is none.
constexpr std::size_t number_count(SettingType type) {
  switch (type) {
    case SettingType::integer:
    case SettingType::number:
      return 1;
    case SettingType::vec2:
      return 2;
    case SettingType::color:
    case SettingType::vec3:
      return 3;
    default:
      return 0;
  }
}

/// A value of a setting; colours are scene-linear.
struct SettingValue {
  SettingType type = SettingType::number;
  std::array<double, 3>
      number{};  ///< integer and number in [0]; boolean as 0/1 in [0]; vec2 in [0..1]; colour, vec3 in [0..2]
  /// enumeration: the choice. file: its name, as `find_asset` takes it, or an absolute path when [0] of `number` is 1
  /// (the command line's, which may name any file); empty: none. text: itself.
  std::string choice;
  friend bool operator==(const SettingValue&, const SettingValue&) = default;
  std::string text() const;  ///< as one would write it in Lua
};

/// What an effect declares about one setting; help, completion, `effects` and documents come from it.
struct SettingSchema {
  std::string name, doc;
  SettingType type = SettingType::number;
  SettingValue default_value;
  std::optional<double> min, max;
  std::vector<std::string> choices;  ///< enumeration; file: the extensions it may have, without the point
  std::string unit;
};

/// A promise of an effect about its result, with its parameters.
struct Invariant {
  std::string name;
  std::map<std::string, double> numbers;        ///< NaN: left open
  std::map<std::string, std::string> settings;  ///< parameters that name a setting
};
struct InvariantSchema {
  Invariant stated;                   ///< without what is computed
  std::vector<std::string> computed;  ///< numbers that depend on settings and size
  bool conditional = false;           ///< holds for some settings or sizes alone
};

/// A promise that effects can make.
struct InvariantKind {
  std::string name;
  std::string main;                        ///< what a bare value stands for: `mean = 1e-3` is { within = 1e-3 }
  std::map<std::string, double> numbers;   ///< its parameters and their defaults; NaN: must be given
  std::vector<std::string> setting_names;  ///< parameters that name a setting of the effect
  std::string doc;                         ///< what is promised
};
/// All of them, in the order of the documents.
const std::vector<InvariantKind>& invariant_kinds();

/// "mean (within 0.001; for some settings)".
std::string invariant_text(const InvariantSchema& hold);

/// What the numbers of a colour mean: light of a scene, which has no upper end, or light of a display, 0…1, both
/// linear; or the values of some other space: other primaries, a logarithm.
enum class LightSpace { any, scene, display, other };
/// "scene-linear", "display-linear", "other", "any".
const char* space_name(LightSpace space);

/// What light an effect is made for, and what it makes of it.
struct SpaceUse {
  LightSpace needs = LightSpace::any;  ///< any: whatever comes
  LightSpace makes = LightSpace::any;  ///< any: what came
  bool view = false;                   ///< what it makes stands for codes of a display's view, by the sRGB curve
};

/// Auxiliary inputs that an effect names in `needs` or `optional`.
struct InputSchema {
  std::vector<std::string> names;
  bool by_settings = false;  ///< a function of the settings says which
};

struct EffectSchema {
  std::string name, doc, at;
  int order = 0;
  bool straight = false;                    ///< its pixel shaders see straight colour: `alpha = "straight"`
  bool detail = false;                      ///< what it draws depends on single pixels: `detail = true`
  SpaceUse space;                           ///< where it is the same for all settings
  bool space_by_settings = false;           ///< it depends on settings
  std::vector<SettingSchema> settings;      ///< in order of declaration
  std::vector<InvariantSchema> invariants;  ///< what it promises
  InputSchema needs, optional;              ///< without the first it is left out, the second it uses where they are
  std::filesystem::path file;
  std::vector<std::filesystem::path> shadowed;  ///< files of the same name further down the search path
};

/// `--set glow.intensity=0.4`: name of the entry (or its effect), setting, text of the value.
struct Override {
  std::string entry, setting, value;
};
/// Errors: usage.
Result<Override> parse_override(const std::string& text);

namespace script {

/// The range of a setting: "0…1", "≥ 1", "≤ 8"; empty: it has none.
std::string range_text(const SettingSchema& schema);

/// What a setting allows, for messages and tables: "0…1", "integer ≥ 1", "additive, scattering", "true, false".
std::string allowed_text(const SettingSchema& schema);

/// Errors (usage): a value that the setting does not allow. `full_name` is what the message calls it: "glow.knee".
Result<void> check_value(const std::string& full_name, const SettingSchema& schema, const SettingValue& value);

/// "#rrggbb" for a colour that can be written so: what it is read as is the same colour in 32-bit floats.
std::optional<std::string> hex_color(const SettingValue& color);
/// The same for a colour that its numbers would need many digits for, which nobody wrote: {0.051269457, 0.2158605, 1}.
std::optional<std::string> shorter_color(const SettingValue& color);

/// "integer", "number", "boolean", "choice", "colour", "vec2", "vec3", "file".
const char* type_name(SettingType type);

/// What a key of an entry besides settings may be: "enabled", "order", "at", "opacity", "blend", "mask". `mask` is a
/// number here, the same everywhere.
SettingSchema entry_key_schema(const std::string& name);
/// "mask.luma.from" → "mask.luma" and "from"; the first is empty for all that belongs to no part of a mask.
std::pair<std::string, std::string> split_mask_setting(const std::string& name);
/// "radial" of "mask.radial.radius" when none of the settings `names` belongs to that part; else empty.
std::string missing_mask(const std::string& setting, const std::vector<std::string>& names);

/// The value of `ENTRY.SETTING=VALUE`. Errors (usage): what the setting does not allow; `where` stands before the name.
Result<SettingValue> parse_setting(const Override& given, const SettingSchema& schema, std::string_view where);

}  // namespace script
}  // namespace afterglow

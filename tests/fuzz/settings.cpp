// SPDX-License-Identifier: MIT
// `--set ENTRY.SETTING=VALUE` against every setting of every effect: what is taken is allowed, finite, and reads back
// from its own text.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "edit/literal.h"
#include "edit/write_back_check.h"
#include "fuzz.h"
#include "script/overrides.h"
#include "script/value.h"

using namespace afterglow;

namespace {

const std::vector<SettingSchema>& schemas() {
  static const std::vector<SettingSchema> all = [] {
    std::vector<SettingSchema> out;
    Diagnostics silent;
    const auto effects = list_effects(search_path_for("", {}), silent);
    FUZZ_CLAIM(effects.ok() && !effects->empty(), "no effects were found");
    for (const auto& effect : *effects) out.insert(out.end(), effect.settings.begin(), effect.settings.end());
    for (const char* name : {"enabled", "order", "at"}) out.push_back(script::entry_key_schema(name));
    return out;
  }();
  return all;
}

void check_value(const SettingValue& value, const SettingSchema& schema) {
  FUZZ_CLAIM(value.type == schema.type, schema.name);
  for (const double number : value.number) FUZZ_CLAIM(std::isfinite(number), schema.name);
  if (schema.type == SettingType::integer || schema.type == SettingType::number) {
    FUZZ_CLAIM(!schema.min || value.number[0] >= *schema.min, value.text());
    FUZZ_CLAIM(!schema.max || value.number[0] <= *schema.max, value.text());
  }
  if (schema.type == SettingType::integer) FUZZ_CLAIM(value.number[0] == std::floor(value.number[0]), value.text());
  if (schema.type == SettingType::enumeration)
    FUZZ_CLAIM(std::ranges::count(schema.choices, value.choice) == 1, value.choice);
}

void check_text(const SettingValue& value, const SettingSchema& schema) {
  if (schema.type == SettingType::file) return;  // of the command line: absolute
  const auto again = script::parse_setting({"entry", schema.name, value.text()}, schema, "");
  FUZZ_CLAIM(again.ok(), again.ok() ? "" : again.error().text());
  FUZZ_CLAIM(script::is_same(*again, value), fmt::format("{} became {}", value.text(), again->text()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const SettingSchema& schema = schemas()[(data[0] + 256u * data[1]) % schemas().size()];
  const std::string text(fuzz::text_of(data + 2, size - 2));
  if (const auto parsed = parse_override(text); !parsed) fuzz::check_error(parsed.error(), {ErrorKind::usage});
  (void)script::parse_value(text).shown();
  const auto value = script::parse_setting({"entry", schema.name, text}, schema, "");
  if (!value) {
    fuzz::check_error(value.error(), {ErrorKind::usage});
    return 0;
  }
  check_value(*value, schema);
  check_text(*value, schema);
  FUZZ_CLAIM(!script::literal_text(*value).empty(), schema.name);
  return 0;
}

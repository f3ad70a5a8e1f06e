// SPDX-License-Identifier: MIT
// Settings written back into text: any text as tokens, constructors and calls; and, where it is a preset that loads,
// whole rewrites, one `ENTRY.SETTING=VALUE` or `ENTRY.SETTING` a line behind "=== edits".
#include "edit/write_back.h"

#include <fmt/format.h>

#include "core/key_finder.h"
#include "core/text.h"
#include "edit/literal.h"
#include "edit/table_edit.h"
#include "fuzz.h"

using namespace afterglow;

namespace {

/// What is said of any text must be about that text.
void check_text(const std::string& source) {
  const LuaText text(source);
  std::size_t at = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    FUZZ_CLAIM(text[i].begin >= at && text[i].end() <= source.size() && !text[i].text.empty(), source);
    at = text[i].end();
    if (const std::size_t other = text.partner(i); other != LuaText::kNone)
      FUZZ_CLAIM(other < text.size() && text.partner(other) == i, source);
  }
  int constructors = 0;
  for (std::size_t i = 0; i < text.size() && constructors < 16; ++i) {
    if (!text.is(i, "{") || text.partner(i) == LuaText::kNone) continue;
    ++constructors;
    const std::string longer = script::replaced(source, script::insert_item(text, i, "added_key", "1.5"));
    FUZZ_CLAIM(longer.size() > source.size(), source);
    for (const auto& item : text.items(i)) {
      FUZZ_CLAIM(item.first <= item.value && item.value <= item.end && item.end <= text.partner(i), source);
      if (const auto removed = script::remove_item(text, i, item))
        FUZZ_CLAIM(script::replaced(source, *removed).size() < source.size(), source);
      (void)script::is_literal(text, item.value, item.end);
    }
  }
  for (const auto& call : text.calls()) {
    FUZZ_CLAIM(call.open < text.size() && call.first_line <= call.line, source);
    FUZZ_CLAIM(line_of_key(source, call.line, call.callee, {}) >= 1, source);
  }
}

void check_rewrite(const Rewrite& rewrite, const std::filesystem::path& file, const PresetOptions& options) {
  PresetOptions with_text = options;
  with_text.text = rewrite.text;
  ShaderLibrary shaders(search_path_for(file, {}));
  Diagnostics silent;
  const auto again = Preset::load(file, with_text, shaders, silent);
  FUZZ_CLAIM(again.ok(), rewrite.text + (again.ok() ? "" : "\n" + again.error().text()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto files = fuzz::split_files(fuzz::text_of(data, size));
  const std::string source(files[0].text);
  check_text(source);
  if (files.size() < 2) return 0;

  const auto file = fuzz::scratch() / "preset.lua";
  PresetOptions options;
  options.limits = {8u << 20, 200'000, 60};
  options.text = source;
  ShaderLibrary shaders(search_path_for(file, {}));
  Diagnostics silent;
  const auto preset = Preset::load(file, options, shaders, silent);
  if (!preset) return 0;
  std::vector<PresetEdit> edits;
  for (const auto& line : split(files[1].text, '\n')) {
    if (edits.size() > 8) break;
    const auto given = parse_override(line);
    auto made = given ? parse_edits(*preset, {*given}) : parse_resets(*preset, {line});
    if (made)
      edits.insert(edits.end(), made->begin(), made->end());
    else
      fuzz::check_error(made.error(), {ErrorKind::usage});
  }
  const auto rewrite = rewrite_preset(file, source, edits, options);
  if (!rewrite) {
    fuzz::check_error(rewrite.error(), {ErrorKind::script, ErrorKind::usage});
    return 0;
  }
  if (rewrite->text != source) check_rewrite(*rewrite, file, options);
  return 0;
}

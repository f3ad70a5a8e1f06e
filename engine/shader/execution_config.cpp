// SPDX-License-Identifier: MIT
#include "shader/execution_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "core/text.h"

namespace afterglow {
namespace {

constexpr std::string_view kRows = "rows";

/// A word and what it makes of a config.
struct Word {
  const char* text;
  void (*apply)(ExecutionConfig&);
};
constexpr Word kWords[] = {
    {"unfused", [](ExecutionConfig& c) { c.fusion = Fusion::none; }},
    {"fused-filters", [](ExecutionConfig& c) { c.fusion = Fusion::filters; }},
    {"fused", [](ExecutionConfig& c) { c.fusion = Fusion::all; }},
    {"fp32", [](ExecutionConfig& c) { c.storage = Storage::fp32; }},
    {"fp16", [](ExecutionConfig& c) { c.storage = Storage::fp16; }},
    {"hardware-filter", [](ExecutionConfig& c) { c.hardware_filter = true; }},
    {"storage-reads", [](ExecutionConfig& c) { c.storage_reads = true; }},
    {"compute", [](ExecutionConfig& c) { c.compute = true; }},
    {"dispatched", [](ExecutionConfig& c) { c.dispatched = true; }},
    {"four-channels", [](ExecutionConfig& c) { c.four_channels = true; }},
    {"unshared", [](ExecutionConfig& c) { c.share_memory = false; }},
    {"plain16f", [](ExecutionConfig& c) { c = kPlain16f; }},
    {"plain32f", [](ExecutionConfig& c) { c = kPlain32f; }},
};

/// "rows8" → 8; 0 when the word says no such thing.
int rows_of(const std::string& word) {
  if (!word.starts_with(kRows)) return 0;
  int rows = 0;
  const char* end = word.data() + word.size();
  const auto [stop, problem] = std::from_chars(word.data() + kRows.size(), end, rows);
  return problem == std::errc() && stop == end && rows >= 1 && rows <= kMaxRows ? rows : 0;
}

Error unknown_word(const std::string& word) {
  const std::vector<std::string> names = execution_words();
  return {ErrorKind::usage,         fmt::format("'{}' says nothing about execution", word), {}, 0, join(names),
          nearest_name(word, names)};
}

}  // namespace

std::string execution_name(const ExecutionConfig& config) {
  std::string name = config.fusion == Fusion::all       ? "fused"
                     : config.fusion == Fusion::filters ? "fused-filters"
                                                        : "unfused";
  name += config.storage == Storage::fp16 ? " fp16" : " fp32";
  if (config.hardware_filter) name += " hardware-filter";
  if (config.storage_reads) name += " storage-reads";
  if (config.compute) name += " compute";
  if (config.dispatched) name += " dispatched";
  if (config.four_channels) name += " four-channels";
  if (!config.share_memory) name += " unshared";
  if (config.rows > 1) name += fmt::format(" {}{}", kRows, config.rows);
  return name;
}

std::vector<std::string> execution_words() {
  std::vector<std::string> names;
  for (const auto& known : kWords) names.emplace_back(known.text);
  names.push_back(fmt::format("{}1 to {}{}", kRows, kRows, kMaxRows));
  return names;
}

Result<ExecutionConfig> parse_execution(const std::string& text, const ExecutionConfig& from) {
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), '+', ' ');
  ExecutionConfig config = from;
  for (const auto& word : split(spaced, ' ')) {
    if (word.empty()) continue;
    if (const int rows = rows_of(word)) {
      config.rows = rows;
      continue;
    }
    const auto known = std::ranges::find(kWords, word, &Word::text);
    if (known == std::end(kWords)) return unknown_word(word);
    known->apply(config);
  }
  return config;
}

}  // namespace afterglow

#include "exec/choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/text.h"

namespace afterglow {
namespace {

constexpr std::string_view kRows = "rows";

/// A word and what it makes of a choice.
struct Word {
  const char* text;
  void (*apply)(Choice&);
};
constexpr Word kWords[] = {
    {"apart", [](Choice& c) { c.joining = Joining::none; }},
    {"heads", [](Choice& c) { c.joining = Joining::heads; }},
    {"joined", [](Choice& c) { c.joining = Joining::all; }},
    {"fp32", [](Choice& c) { c.storage = Storage::fp32; }},
    {"fp16", [](Choice& c) { c.storage = Storage::fp16; }},
    {"hardware-filter", [](Choice& c) { c.hardware_filter = true; }},
    {"storage-reads", [](Choice& c) { c.storage_reads = true; }},
    {"unshared", [](Choice& c) { c.share_memory = false; }},
    {"plain16f", [](Choice& c) { c = kPlain16f; }},
    {"plain32f", [](Choice& c) { c = kPlain32f; }},
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
  std::vector<std::string> names;
  for (const auto& known : kWords) names.emplace_back(known.text);
  names.push_back(fmt::format("{}1 to {}{}", kRows, kRows, kMaxRows));
  return {ErrorKind::usage,         fmt::format("'{}' says nothing about execution", word), {}, 0, join(names),
          nearest_name(word, names)};
}

}  // namespace

std::string choice_name(const Choice& choice) {
  std::string name = choice.joining == Joining::all ? "joined" : choice.joining == Joining::heads ? "heads" : "apart";
  name += choice.storage == Storage::fp16 ? " fp16" : " fp32";
  if (choice.hardware_filter) name += " hardware-filter";
  if (choice.storage_reads) name += " storage-reads";
  if (!choice.share_memory) name += " unshared";
  if (choice.rows > 1) name += fmt::format(" {}{}", kRows, choice.rows);
  return name;
}

Result<Choice> parse_choice(const std::string& text) {
  std::string spaced = text;
  std::replace(spaced.begin(), spaced.end(), '+', ' ');
  Choice choice;
  for (const auto& word : split(spaced, ' ')) {
    if (word.empty()) continue;
    if (const int rows = rows_of(word)) {
      choice.rows = rows;
      continue;
    }
    const auto known = std::ranges::find(kWords, word, &Word::text);
    if (known == std::end(kWords)) return unknown_word(word);
    known->apply(choice);
  }
  return choice;
}

ProgramOptions program_options(const Choice& choice) {
  ProgramOptions options;
  options.joining = choice.joining;
  options.storage = choice.storage;
  options.hardware_filter = choice.hardware_filter;
  options.storage_reads = choice.storage_reads;
  options.share_memory = choice.share_memory;
  options.rows = choice.rows;
  return options;
}

}  // namespace afterglow

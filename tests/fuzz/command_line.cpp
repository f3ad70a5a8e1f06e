// SPDX-License-Identifier: MIT
// The arguments of every command, one a line: parsed, and the values of options read; nothing is run.
#include "apps/command_line.h"

#include <fmt/format.h>

#include <vector>

#include "apps/options.h"
#include "core/text.h"
#include "fuzz.h"

using namespace afterglow;

namespace {

template <class T>
void check(const Result<T>& read) {
  if (!read) fuzz::check_error(read.error(), {ErrorKind::usage});
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> words{"afterglow"};
  for (auto& word : split(std::string(fuzz::text_of(data, size)), '\n')) {
    word.resize(std::min(word.find('\0'), word.size()));  // what a program can be given
    words.push_back(std::move(word));
  }
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  const int code = check_command_line(static_cast<int>(arguments.size()), arguments.data());
  FUZZ_CLAIM(code == 0 || code == static_cast<int>(ErrorKind::usage), fmt::format("exit code {}", code));
  for (const auto& word : words) {
    check(parse_size(word));
    if (const auto region = parse_region(word)) FUZZ_CLAIM(region->width >= 1 && region->x >= 0, word);
    check(parse_region(word));
    if (const auto memory = parse_memory(word)) FUZZ_CLAIM(*memory >= 1 && !memory_text(*memory).empty(), word);
    check(parse_memory(word));
    check(parse_position(word));
    check(parse_override(word));
  }
  return 0;
}

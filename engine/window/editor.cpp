// SPDX-License-Identifier: MIT
#include "window/editor.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "core/process.h"

namespace afterglow {
namespace {

constexpr const char* kVariable = "AFTERGLOW_EDITOR";

Error no_editor(const std::string& what) {
  return Error{ErrorKind::usage, what, kVariable, 0, "code -g {file}:{line}, gvim +{line} {file}, gedit, …"};
}

Result<std::vector<std::string>> words_of(const std::string& command) {
  std::vector<std::string> words;
  char quote = 0;
  bool in_word = false;
  for (const char c : command) {
    if (quote ? c == quote : c == '"' || c == '\'') {
      quote = quote ? 0 : c;
      if (!in_word) words.emplace_back();
      in_word = true;
    } else if (!quote && (c == ' ' || c == '\t')) {
      in_word = false;
    } else {
      if (!in_word) words.emplace_back();
      in_word = true;
      words.back() += c;
    }
  }
  if (quote) return no_editor(fmt::format("a quote does not end: {}", command));
  if (words.empty() || words.front().empty()) return no_editor("no editor is named");
  return words;
}

/// True when `name` was there.
bool put(std::string& word, const std::string& name, const std::string& value) {
  bool found = false;
  for (std::size_t at = 0; (at = word.find(name, at)) != std::string::npos; at += value.size()) {
    word.replace(at, name.size(), value);
    found = true;
  }
  return found;
}

}  // namespace

Result<std::vector<std::string>> editor_call(const std::string& command, const std::filesystem::path& file, int line) {
  AFTERGLOW_TRY(std::vector<std::string> words, words_of(command));
  const std::string number = std::to_string(std::max(line, 1));
  bool placed = false;
  for (std::string& word : words) {
    // The file last: its name may have braces.
    placed = put(word, "{line}", number) || placed;
    placed = put(word, "{file}", file.string()) || placed;
  }
  if (!placed) words.insert(words.end(), {"+" + number, file.string()});
  return words;
}

Result<void> open_in_editor(const std::filesystem::path& file, int line) {
  const char* command = std::getenv(kVariable);
  if (!command || !*command) return no_editor("no editor is named");
  AFTERGLOW_TRY(std::vector<std::string> words, editor_call(command, file, line));
  // Those that were started before and have ended.
  static std::vector<pid_t> started;
  std::erase_if(started, [](pid_t child) { return waitpid(child, nullptr, WNOHANG) != 0; });
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  hear_signals(attributes, POSIX_SPAWN_SETSID);  // it lives on without us
  pid_t child = 0;
  const int problem = posix_spawnp(&child, argv[0], nullptr, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  if (problem != 0)
    return Error{ErrorKind::io, fmt::format("'{}' cannot be started: {}", words[0], std::strerror(problem)), kVariable};
  started.push_back(child);
  return {};
}

}  // namespace afterglow

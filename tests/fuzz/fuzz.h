// SPDX-License-Identifier: MIT
// What the harnesses share: a folder to put hostile files into, inputs that are several files, and claims that must
// hold whatever comes in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

/// Called with one input, by libFuzzer or by replay.cpp; 0.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace afterglow::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// This process's own folder, removed at its end; in memory where TMPDIR says so.
const std::filesystem::path& scratch();

/// Writes a file of that name into the scratch folder.
std::filesystem::path write(const std::string& name, std::string_view bytes);

/// Several files in one input: lines "=== NAME" begin the next one. The first has no name.
struct NamedText {
  std::string name;
  std::string_view text;
};
std::vector<NamedText> split_files(std::string_view input);

/// Ends the process, which makes the input a finding.
[[noreturn]] void broken(const char* claim, const std::string& detail);

/// An error must be something that users can read: of the kinds that they can mend, on one line.
void check_error(const Error& error, std::initializer_list<ErrorKind> kinds);

}  // namespace afterglow::fuzz

/// What must hold for every input.
#define FUZZ_CLAIM(condition, detail)                              \
  do {                                                             \
    if (!(condition)) afterglow::fuzz::broken(#condition, detail); \
  } while (false)

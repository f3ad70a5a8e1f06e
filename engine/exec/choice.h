// How a stack is executed, as one value: what the calibration chooses, the bench varies and a report names. Every
// choice makes the same picture, within the error that its storage and its fetches allow.
#pragma once

#include <string>
#include <vector>

#include "exec/program.h"

namespace afterglow {

struct Choice {
  Joining joining = Joining::all;
  Storage storage = Storage::fp32;
  bool hardware_filter = false;  ///< see ProgramOptions, also for the rest
  bool storage_reads = false;
  bool share_memory = true;
  int rows = 1;  ///< 1 … kMaxRows
  friend bool operator==(const Choice&, const Choice&) = default;
};

/// The baseline of all comparisons: one RGBA16F fragment pass for each pass of math.md §4, read through a linear
/// sampler (a B-spline is then four fetches).
inline constexpr Choice kPlain16f{.joining = Joining::heads, .storage = Storage::fp16, .hardware_filter = true};
/// The same in full floats.
inline constexpr Choice kPlain32f{.joining = Joining::heads, .storage = Storage::fp32, .hardware_filter = true};

/// "joined fp32 storage-reads rows8": the words of all that is not default, after joining and storage.
std::string choice_name(const Choice& choice);

/// Reads what `choice_name` writes, or "plain16f", "plain32f". Words may be separated by spaces or '+', in any order;
/// what is not said is as in Choice{}. Errors: usage.
Result<Choice> parse_choice(const std::string& text);

/// The choice as options of a program; the rest stays as it is by default.
ProgramOptions program_options(const Choice& choice);

}  // namespace afterglow

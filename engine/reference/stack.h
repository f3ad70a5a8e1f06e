// SPDX-License-Identifier: MIT
// A whole stack in double precision: effects by name, one after the other, as a preset resolves them.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "reference/double_image.h"

namespace afterglow::reference {

/// A setting's value, whatever its type: numbers (flags as 0/1, colours scene-linear), or a choice by name.
struct Value {
  std::array<double, 3> number{};
  std::string choice;
};

/// Where an entry counts: a mask by name, a number, or two of them combined.
struct Mask {
  enum class Kind { named, number, add, subtract, multiply };
  Kind kind = Kind::number;
  double number = 0;
  std::string name;
  std::map<std::string, Value> settings;
  std::shared_ptr<const Mask> a, b;
};

/// An effect that runs, with all its settings; a "group", or a "mix" by its setting `amount`.
struct Entry {
  std::string effect;
  std::map<std::string, Value> settings;
  double opacity = 1;
  std::string blend = "normal";
  std::shared_ptr<const Mask> mask = {};  ///< null: everywhere
  int members = 0;                        ///< of a group or mix: so many entries behind it belong to it
  int middle = 0;                         ///< of a mix: so many of them are its first look
};

/// Auxiliary inputs (null: the picture has none), and when the picture is seen.
struct Inputs {
  const DoubleImage* depth = nullptr;
  const DoubleImage* normal = nullptr;
  const DoubleImage* motion = nullptr;
  double frame = 1, time = 0;                             ///< number in its sequence; seconds
  std::map<std::string, const DoubleImage*> layers = {};  ///< by the names that effects ask by, without "layer:"
};

/// Is there an oracle of the effect, for some of its settings at least?
bool has_oracle(const std::string& effect);

/// The first effect or mask that no oracle knows with its settings; empty when all are known.
std::string effect_without_oracle(std::span<const Entry> entries);

/// The result of the stack, alpha that of the source. `entries` are those that run, in order; every effect is known,
/// has all the settings that its schema names, and the inputs that it needs.
DoubleImage evaluate(const DoubleImage& source, const Inputs& inputs, std::span<const Entry> entries);

}  // namespace afterglow::reference

// SPDX-License-Identifier: MIT
// Settings of a stack's entry as the oracles want them.
#pragma once

#include <initializer_list>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "reference/stack.h"

namespace afterglow::reference {

/// Settings as the oracles want them. A name that is not there is a mistake of this room: std::out_of_range.
class Settings {
 public:
  explicit Settings(const Entry& entry) : values_(entry.settings) {}
  double number(const char* name) const { return values_.at(name).number[0]; }
  int integer(const char* name) const { return static_cast<int>(number(name)); }
  bool flag(const char* name) const { return number(name) != 0; }
  Rgb color(const char* name) const {
    const auto& v = values_.at(name).number;
    return {v[0], v[1], v[2]};
  }
  /// Of a vec2: (x, y).
  std::pair<double, double> pair(const char* name) const {
    const auto& v = values_.at(name).number;
    return {v[0], v[1]};
  }
  bool is(const char* name, const char* choice) const { return values_.at(name).choice == choice; }
  const std::string& text(const char* name) const { return values_.at(name).choice; }
  /// The value whose name was chosen.
  template <class T>
  T choice(const char* name, std::initializer_list<std::pair<const char*, T>> all) const {
    for (const auto& [text, value] : all)
      if (is(name, text)) return value;
    throw std::out_of_range(name);
  }

 private:
  const std::map<std::string, Value>& values_;
};

struct Oracle {
  const char* effect;
  DoubleImage (*run)(const DoubleImage& source, const Inputs& inputs, const Settings& settings);
  bool (*knows)(const Settings& settings) = nullptr;  ///< null: all that the effect takes
};

/// Grading, lens, film, blurs and edges: stack_effects.cpp.
std::span<const Oracle> more_oracles();
/// Light in lenses, film and air, and screens: stack_optics.cpp.
std::span<const Oracle> optic_oracles();

}  // namespace afterglow::reference

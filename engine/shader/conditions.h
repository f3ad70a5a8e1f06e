// SPDX-License-Identifier: MIT
// The branches of a file that its preprocessor lines leave out, as far as the file itself says: `#if 0`, `#ifdef` of
// its own macros. Internal to the room.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "shader/token.h"

namespace afterglow {

/// Reads the preprocessor lines of a file in order. A condition is known when it is made of whole numbers and of macros
/// without arguments of the file alone; what its includes and the compiler define is not known here. A group of
/// branches is decided when its conditions are known up to the first that holds: then its own lines and the other
/// branches are left out. All branches of other groups stay.
class Conditions {
 public:
  explicit Conditions(const std::string& file) : file_(file) {}

  /// A line, '#' first. Returns whether it stays; its tokens may be changed then.
  /// Errors (script): a second #else.
  Result<bool> line(std::vector<Token>& tokens);

  /// Whether what follows, up to the next line of the group that is open, is left out.
  bool leaves_out() const { return !groups_.empty() && groups_.back().state != State::holds && groups_.back().decided; }

  /// At the end of the file. Errors (script): a decided group that is never closed; others are the caller's.
  Result<void> end() const;

 private:
  enum class State { none_yet, holds, over };  ///< no branch held; this one does; one did
  struct Group {
    int line = 0;
    bool decided = false;
    State state = State::none_yet;
    bool has_else = false;
  };
  struct Macro {
    bool certain = false;  ///< not by a branch that may be left out
    bool defined = false;
    bool plain = false;  ///< without arguments
    std::vector<Token> body;
  };
  using Number = std::optional<std::int64_t>;  ///< nothing: not known

  void define(std::span<const Token> tokens);
  Number holds(std::span<const Token> line) const;
  Number is_defined(std::string_view name) const;
  struct Expansion {
    std::vector<std::string_view> active;  ///< macros that are being expanded
    std::vector<Token> out;
    std::size_t steps = 0;  ///< so far: macros of nothing take time, too
  };
  bool expand(std::span<const Token> tokens, Expansion& into) const;

  const std::string& file_;
  std::vector<Group> groups_;
  std::map<std::string_view, Macro> macros_;
  bool includes_ = false;
};

}  // namespace afterglow

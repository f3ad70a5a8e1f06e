// SPDX-License-Identifier: MIT
// Result<T>: a value or one Error. The only error style of the engine; exceptions exist inside the Lua
// boundary and at library edges alone and are converted there. Thread-safe as any value type.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace afterglow {

/// What went wrong, by who can mend it. The value is the exit code of the command line.
enum class ErrorKind { other = 1, usage = 2, script = 3, io = 4, device = 5, interrupted = 130 };

/// One failure. Printed as `FILE:LINE: error: MESSAGE; allowed: ALLOWED; did you mean 'NEAREST'?`, then one
/// indented line for each entry of `trail`.
struct Error {
  ErrorKind kind = ErrorKind::other;
  std::string message;                  ///< what happened; no full stop, no newline
  std::string file = {};                ///< offending file, or empty
  int line = 0;                         ///< 1-based; 0: no line is known
  std::string allowed = {};             ///< allowed range or values, or empty
  std::string nearest = {};             ///< nearest valid name, or empty
  std::vector<std::string> trail = {};  ///< further lines: who called, compiler log, …

  /// The one line (and trail lines) that users see; without a trailing newline.
  std::string text() const;
};

/// Either a T or an Error.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  explicit operator bool() const { return state_.index() == 0; }
  bool ok() const { return state_.index() == 0; }
  T& value() & { return std::get<0>(state_); }
  const T& value() const& { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const Error& error() const& { return std::get<1>(state_); }
  Error&& error() && { return std::get<1>(std::move(state_)); }

 private:
  std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}
  explicit operator bool() const { return !error_; }
  bool ok() const { return !error_; }
  const Error& error() const& { return *error_; }
  Error&& error() && { return std::move(*error_); }

 private:
  std::optional<Error> error_;
};

#define AFTERGLOW_CONCAT_(a, b) a##b
#define AFTERGLOW_CONCAT(a, b) AFTERGLOW_CONCAT_(a, b)

/// `AFTERGLOW_TRY(auto x, f());` declares x from a successful Result or returns its error.
#define AFTERGLOW_TRY(declaration, expression)                                                            \
  auto AFTERGLOW_CONCAT(try_, __LINE__) = (expression);                                                   \
  if (!AFTERGLOW_CONCAT(try_, __LINE__).ok()) return std::move(AFTERGLOW_CONCAT(try_, __LINE__)).error(); \
  declaration = std::move(AFTERGLOW_CONCAT(try_, __LINE__)).value()

/// `AFTERGLOW_CHECK(f());` returns the error of a Result<void>, or goes on.
#define AFTERGLOW_CHECK(expression)                                                                     \
  if (auto AFTERGLOW_CONCAT(check_, __LINE__) = (expression); !AFTERGLOW_CONCAT(check_, __LINE__).ok()) \
  return std::move(AFTERGLOW_CONCAT(check_, __LINE__)).error()

}  // namespace afterglow

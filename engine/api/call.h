// SPDX-License-Identifier: MIT
// What every function of the C interface does: arguments in, no exception out, one error object.
#pragma once

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "api/afterglow.h"
#include "core/diagnostics.h"
#include "core/locale.h"
#include "core/result.h"

struct afterglow_error {
  afterglow::Error error;
  std::string text;
};

struct afterglow_text {
  std::string text;
};

namespace afterglow::api {

/// For the caller. When there is no memory for it, an error that says so and need not be freed.
afterglow_error* new_error(Error error) noexcept;
afterglow_error* no_memory() noexcept;

Error usage(std::string message);

/// Runs `work`, which returns a Result<void>; what it throws becomes an error. Numbers in texts are plain meanwhile.
template <class Work>
afterglow_error* call(Work work) noexcept {
  const PlainLocale plain;
  try {
    Result<void> done = work();
    return done ? nullptr : new_error(std::move(done).error());
  } catch (const std::bad_alloc&) {
    return no_memory();
  } catch (const std::exception& thrown) {
    try {
      return new_error({ErrorKind::other, thrown.what()});
    } catch (...) {
      return no_memory();
    }
  } catch (...) {
    return no_memory();
  }
}

inline afterglow_string view(const std::string& text) { return {text.c_str(), text.size()}; }
inline bool is_given(afterglow_string text) { return text.data != nullptr; }
inline std::string text_of(afterglow_string text) {
  return text.data ? std::string(text.data, text.size) : std::string();
}

/// A path of the caller's, absolute: a host may change its working directory later. Empty: none is given. Errors
/// (usage): a NUL in it, where the system would end it.
inline Result<std::filesystem::path> path_of(afterglow_string text) {
  std::filesystem::path given = text_of(text);
  if (given.native().find('\0') != std::string::npos)
    return usage("embedded NUL in the name of a file: " + given.native());
  std::error_code unknown;
  std::filesystem::path absolute = given.empty() ? given : std::filesystem::absolute(given, unknown);
  return unknown ? given : absolute;
}

/// Hands a text over to the caller.
Result<void> give(std::string text, afterglow_text** out, const char* function);

/// What the caller gave, over defaults: callers that were compiled with an older header have fewer members. Errors
/// (usage): null; no size; members of a newer header that this library does not know are not zero.
template <class T>
Result<T> take(const T* given, T defaults, const char* name) {
  if (!given) return usage(std::string(name) + " is NULL");
  const std::size_t size = given->struct_size;
  if (size < sizeof(std::size_t)) return usage(std::string(name) + ".struct_size is not set");
  const auto* bytes = reinterpret_cast<const unsigned char*>(given);
  for (std::size_t i = sizeof(T); i < size; ++i)
    if (bytes[i] != 0) return usage(std::string(name) + " asks for what this version of the library does not know");
  std::memcpy(static_cast<void*>(&defaults), given, std::min(size, sizeof(T)));
  defaults.struct_size = sizeof(T);
  return defaults;
}

/// The sink of a caller's callback; empty without one.
Diagnostics::Sink sink_of(afterglow_message_callback message, void* user);

}  // namespace afterglow::api

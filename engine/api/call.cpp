// SPDX-License-Identifier: MIT
#include "api/call.h"

#include "api/words.h"
#include "core/printable.h"
#include "core/utf8.h"

namespace afterglow::api {
namespace {

/// Const in all but type: afterglow_error_free knows it.
afterglow_error* the_error_without_memory() noexcept {
  static afterglow_error error{{ErrorKind::other, "no memory"}, "error: no memory"};
  return &error;
}

}  // namespace

afterglow_error* no_memory() noexcept { return the_error_without_memory(); }

afterglow_error* new_error(Error error) noexcept {
  try {
    error = for_hosts(std::move(error));
    std::string text = utf8_text(error.text());
    for (std::string* part : {&error.message, &error.file, &error.allowed, &error.nearest})
      *part = utf8_text(std::move(*part));
    error.message = printable(std::move(error.message));
    return new afterglow_error{std::move(error), std::move(text)};
  } catch (...) {
    return no_memory();
  }
}

Error usage(std::string message) { return {ErrorKind::usage, std::move(message)}; }

Result<void> give(std::string text, afterglow_text** out, const char* function) {
  if (!out) return usage(std::string(function) + ": out is NULL");
  *out = new afterglow_text{utf8_text(std::move(text))};
  return {};
}

Diagnostics::Sink sink_of(afterglow_message_callback message, void* user) {
  if (!message) return {};
  return [message, user](Severity severity, const std::string& text) {
    const std::string told = utf8_text(for_hosts(text));
    const HostLocale as_usual;
    message(user, severity == Severity::warning ? AFTERGLOW_WARNING : AFTERGLOW_NOTE, view(told));
  };
}

}  // namespace afterglow::api

using namespace afterglow;

static_assert(AFTERGLOW_VERSION_MAJOR == AFTERGLOW_PROJECT_MAJOR &&
                  AFTERGLOW_VERSION_MINOR == AFTERGLOW_PROJECT_MINOR &&
                  AFTERGLOW_VERSION_PATCH == AFTERGLOW_PROJECT_PATCH,
              "afterglow.h and CMakeLists.txt say different versions");

uint32_t afterglow_version(void) { return AFTERGLOW_VERSION; }

afterglow_error_kind afterglow_error_get_kind(const afterglow_error* error) {
  if (!error) return AFTERGLOW_ERROR_NONE;
  switch (error->error.kind) {
    case ErrorKind::usage:
      return AFTERGLOW_ERROR_USAGE;
    case ErrorKind::script:
      return AFTERGLOW_ERROR_SCRIPT;
    case ErrorKind::io:
      return AFTERGLOW_ERROR_IO;
    case ErrorKind::device:
      return AFTERGLOW_ERROR_DEVICE;
    case ErrorKind::other:
    case ErrorKind::interrupted:
      break;
  }
  return AFTERGLOW_ERROR_OTHER;
}

static afterglow_string member(const afterglow_error* error, const std::string Error::*which) {
  return error ? api::view(error->error.*which) : afterglow_string{"", 0};
}

afterglow_string afterglow_error_get_message(const afterglow_error* error) { return member(error, &Error::message); }
afterglow_string afterglow_error_get_file(const afterglow_error* error) { return member(error, &Error::file); }
afterglow_string afterglow_error_get_allowed(const afterglow_error* error) { return member(error, &Error::allowed); }
afterglow_string afterglow_error_get_nearest(const afterglow_error* error) { return member(error, &Error::nearest); }
int afterglow_error_get_line(const afterglow_error* error) { return error ? error->error.line : 0; }
afterglow_string afterglow_error_get_text(const afterglow_error* error) {
  return error ? api::view(error->text) : afterglow_string{"", 0};
}
void afterglow_error_free(afterglow_error* error) {
  if (error != api::no_memory()) delete error;
}

afterglow_string afterglow_text_get(const afterglow_text* text) {
  return text ? api::view(text->text) : afterglow_string{"", 0};
}
void afterglow_text_free(afterglow_text* text) { delete text; }

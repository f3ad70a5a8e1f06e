// SPDX-License-Identifier: MIT
#include "core/exception.h"

#include <algorithm>
#include <new>
#include <system_error>

#include "core/text.h"

namespace afterglow {
namespace {

bool is_lack_of_memory(const std::exception& exception) {
  return dynamic_cast<const std::bad_alloc*>(&exception) != nullptr;
}

/// std::thread and std::async throw it.
bool is_lack_of_threads(const std::exception& exception) {
  const auto* error = dynamic_cast<const std::system_error*>(&exception);
  return error != nullptr && error->code() == std::errc::resource_unavailable_try_again;
}

}  // namespace

std::string exception_text(const std::exception& exception) {
  if (is_lack_of_memory(exception)) return "out of memory";
  if (is_lack_of_threads(exception)) return kNoMoreThreads;
  std::string text = exception.what();
  std::ranges::replace(text, '\n', ' ');
  text = trim(text);
  while (!text.empty() && text.back() == '.') text.pop_back();
  return text;
}

Error exception_error(const std::exception& exception) {
  const std::string text = exception_text(exception);
  if (is_lack_of_memory(exception) || is_lack_of_threads(exception)) return {ErrorKind::io, text};
  return {ErrorKind::other, "internal error: " + text};
}

}  // namespace afterglow

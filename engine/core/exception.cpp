// SPDX-License-Identifier: MIT
#include "core/exception.h"

#include <algorithm>
#include <new>

#include "core/text.h"

namespace afterglow {
namespace {

bool is_lack_of_memory(const std::exception& exception) {
  return dynamic_cast<const std::bad_alloc*>(&exception) != nullptr;
}

}  // namespace

std::string exception_text(const std::exception& exception) {
  if (is_lack_of_memory(exception)) return "out of memory";
  std::string text = exception.what();
  std::ranges::replace(text, '\n', ' ');
  text = trim(text);
  while (!text.empty() && text.back() == '.') text.pop_back();
  return text;
}

Error exception_error(const std::exception& exception) {
  const std::string text = exception_text(exception);
  if (is_lack_of_memory(exception)) return {ErrorKind::io, text};
  return {ErrorKind::other, "internal error: " + text};
}

}  // namespace afterglow

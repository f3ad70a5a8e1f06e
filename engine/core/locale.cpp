// SPDX-License-Identifier: MIT
#include "core/locale.h"

#include <locale.h>

#include <clocale>
#include <utility>

namespace afterglow {
namespace {

/// Null when there is no memory for it: then the thread's own stays.
locale_t plain() {
  static const locale_t made = newlocale(LC_ALL_MASK, "C", nullptr);
  return made;
}

thread_local locale_t g_of_host = nullptr;  // null: no PlainLocale lives on this thread

}  // namespace

PlainLocale::PlainLocale() noexcept : before_(uselocale(plain())) {
  if (!g_of_host) g_of_host = static_cast<locale_t>(before_);
}

PlainLocale::~PlainLocale() {
  uselocale(static_cast<locale_t>(before_));
  if (before_ == g_of_host) g_of_host = nullptr;
}

HostLocale::HostLocale() noexcept : before_(uselocale(g_of_host)) {}
HostLocale::~HostLocale() { uselocale(static_cast<locale_t>(before_)); }

}  // namespace afterglow

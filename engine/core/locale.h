// SPDX-License-Identifier: MIT
// Numbers in texts have a decimal point, whatever a host's setlocale() says: Lua, OpenColorIO and others ask the
// locale.
#pragma once

namespace afterglow {

/// The "C" locale for this thread, while it lives.
class PlainLocale {
 public:
  PlainLocale() noexcept;
  ~PlainLocale();
  PlainLocale(const PlainLocale&) = delete;
  PlainLocale& operator=(const PlainLocale&) = delete;

 private:
  void* before_;
};

/// What the thread had before its outermost PlainLocale, while it lives: for functions of the host.
class HostLocale {
 public:
  HostLocale() noexcept;
  ~HostLocale();
  HostLocale(const HostLocale&) = delete;
  HostLocale& operator=(const HostLocale&) = delete;

 private:
  void* before_;
};

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "image/oiio_module.h"

#include "core/module.h"

namespace afterglow {
namespace {

Result<const OiioModule*> load() {
  auto entry = load_module("afterglow_oiio.so", "afterglow_oiio_module");
  if (!entry) return Error{ErrorKind::io, "cannot be read or written: " + entry.error().message};
  return reinterpret_cast<const OiioModule* (*)()>(*entry)();
}

}  // namespace

Result<const OiioModule*> oiio_module() {
  static const Result<const OiioModule*> module = load();
  return module;
}

}  // namespace afterglow

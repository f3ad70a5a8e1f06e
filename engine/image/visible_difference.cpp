// SPDX-License-Identifier: MIT
#include "image/metrics.h"
#include "image/oiio_module.h"

namespace afterglow {

Result<double> visible_difference(const Image& a, const Image& b) {
  AFTERGLOW_TRY(const OiioModule* module, oiio_module());
  return module->visible_difference(a, b);
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "reference/color_blit.h"

namespace afterglow::reference {

DoubleImage color_blit(const DoubleImage& source, double intensity) {
  const double i = glm::clamp(intensity, 0.0, 2.0);
  if (i <= 0) return source;
  return map_color(source, [&](const Rgb& c) { return Rgb(0, i * c.g, 0); });
}

}  // namespace afterglow::reference

// SPDX-License-Identifier: MIT
// The module's one symbol.
#include "core/module_shapes.h"
#include "image/oiio_compare.h"
#include "image/oiio_file.h"
#include "image/oiio_module.h"
#include "image/oiio_write.h"
#include "image/webp_movie.h"

extern "C" __attribute__((visibility("default"))) const afterglow::OiioModule* afterglow_oiio_module() {
  static constexpr afterglow::OiioModule module{&afterglow::open_with_oiio, &afterglow::write_with_oiio,
                                                &afterglow::open_webp_movie, &afterglow::visible_difference_with_oiio};
  return &module;
}

AFTERGLOW_MODULE_SHAPES

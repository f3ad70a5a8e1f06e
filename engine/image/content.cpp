// SPDX-License-Identifier: MIT
#include "image/picture.h"

namespace afterglow {

void note_content(Picture& picture) {
  const auto hash = [](const Image& image) { return hash_bytes(image.pixels.data(), image.bytes()); };
  picture.content["source"] = hash(picture.color);
  for (const auto& [name, image] : picture.auxiliary) picture.content[name] = hash(image);
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include <utility>

#include "core/half.h"
#include "core/large_pages.h"
#include "core/parallel.h"
#include "image/picture.h"

namespace afterglow {

void open_color(Picture& picture, std::vector<float> memory) {
  if (picture.halves.empty()) return;
  const UnsetVector<std::uint16_t> halves = std::move(picture.halves);
  picture.halves.clear();
  resize_for_picture(memory, halves.size());
  const Image& color = picture.color;
  const std::size_t row = static_cast<std::size_t>(color.width) * 4;
  parallel_rows(color.height, static_cast<long long>(halves.size()), [&](int begin, int end) {
    const std::size_t first = row * static_cast<std::size_t>(begin);
    floats_from_halves(halves.data() + first, row * static_cast<std::size_t>(end) - first, memory.data() + first);
  });
  picture.color.pixels = std::move(memory);
}

void note_content(Picture& picture) {
  const auto hash = [](const Image& image) { return hash_bytes(image.pixels.data(), image.bytes()); };
  picture.content["source"] = picture.halves.empty()
                                  ? hash(picture.color)
                                  : hash_bytes(picture.halves.data(), picture.halves.size() * sizeof(std::uint16_t));
  for (const auto& [name, image] : picture.auxiliary) picture.content[name] = hash(image);
}

}  // namespace afterglow

// SPDX-License-Identifier: MIT
#include "image/heif_size.h"

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "image/iso_boxes.h"

namespace afterglow {
namespace {

constexpr std::uint64_t kMostTable = 4u << 20;  ///< bytes of a table of items
constexpr std::size_t kMostCanvas = 20;         ///< bytes that tell the size of an overlay; a grid has fewer

/// Numbers one after another, 0 beyond the end.
class Numbers {
 public:
  explicit Numbers(std::span<const unsigned char> bytes) : left_(bytes) {}
  std::uint64_t next(std::size_t bytes) {
    if (bytes > left_.size()) {
      left_ = {};
      return 0;
    }
    const std::uint64_t value = ordered(left_.data(), bytes, true);
    left_ = left_.subspan(bytes);
    return value;
  }
  bool at_end() const { return left_.empty(); }

 private:
  std::span<const unsigned char> left_;
};

class HeifItems {
 public:
  HeifItems(std::ifstream& in, const IsoBox& meta) : in_(in) {
    constexpr std::uint64_t kVersion = 4;
    walk(meta.begin + kVersion, meta.end, [&](const IsoBox& box) { take(box); });
  }

  std::optional<Size> largest() {
    for (const Item& item : items_)
      if (const auto size = canvas(item)) add(*size);
    return largest_;
  }

 private:
  struct Extent {
    std::uint64_t at = 0, length = 0;
  };
  struct Item {
    std::uint64_t id = 0;
    bool in_data = false;  ///< in the box `idat`, not anywhere in the file
    std::vector<Extent> extents;
  };

  template <typename Function>
  void walk(std::uint64_t at, std::uint64_t end, const Function& function) {
    while (const auto box = iso_box_at(in_, at, end)) {
      function(*box);
      at = box->end;
    }
  }

  std::vector<unsigned char> content(const IsoBox& box) {
    return bytes_at(in_, box.begin, std::min(box.end - box.begin, kMostTable));
  }

  void take(const IsoBox& box) {
    if (box.type == "iprp" || box.type == "ipco") {
      walk(box.begin, box.end, [&](const IsoBox& inner) { take(inner); });
    } else if (box.type == "ispe") {
      const auto bytes = content(box);
      Numbers numbers(bytes);
      numbers.next(4);
      const std::uint64_t width = numbers.next(4);
      add(claimed_sides(width, numbers.next(4)));
    } else if (box.type == "iinf") {
      const std::uint64_t count_bytes = version(box) == 0 ? 2 : 4;
      walk(box.begin + 4 + count_bytes, box.end, [&](const IsoBox& entry) { take_type(entry); });
    } else if (box.type == "iloc") {
      take_places(content(box));
    } else if (box.type == "idat") {
      data_ = box;
    }
  }

  std::uint64_t version(const IsoBox& box) {
    const auto first = bytes_at(in_, box.begin, 1);
    return first.empty() ? 0 : first[0];
  }

  void take_type(const IsoBox& entry) {
    const auto bytes = content(entry);
    Numbers numbers(bytes);
    const std::uint64_t version = numbers.next(1);
    numbers.next(3);
    const std::uint64_t id = numbers.next(version == 2 ? 2 : 4);
    numbers.next(2);
    types_[id] = static_cast<std::uint32_t>(numbers.next(4));
  }

  void take_places(const std::vector<unsigned char>& bytes) {
    Numbers numbers(bytes);
    const std::uint64_t version = numbers.next(1);
    numbers.next(3);
    const std::uint64_t sizes = numbers.next(2);
    const auto field = [&](int place) { return static_cast<std::size_t>(sizes >> (4 * place) & 15); };
    const std::size_t offset = field(3), length = field(2), base = field(1), index = version > 0 ? field(0) : 0;
    if (std::max({offset, length, base, index}) > 8) return;
    const std::size_t wide = version < 2 ? 2 : 4;
    numbers.next(wide);
    while (!numbers.at_end()) {
      Item item;
      item.id = numbers.next(wide);
      item.in_data = version > 0 && (numbers.next(2) & 15) == 1;
      numbers.next(2);
      const std::uint64_t start = numbers.next(base);
      for (std::uint64_t left = numbers.next(2); left > 0 && !numbers.at_end(); --left) {
        numbers.next(index);
        const std::uint64_t at = start + numbers.next(offset);
        item.extents.push_back({at, numbers.next(length)});
      }
      items_.push_back(std::move(item));
    }
  }

  /// Of an item that is put together from others.
  std::optional<Size> canvas(const Item& item) {
    constexpr std::uint32_t kGrid = 0x67726964, kOverlay = 0x696f766c;
    const auto type = types_.find(item.id);
    if (type == types_.end() || (type->second != kGrid && type->second != kOverlay)) return {};
    const auto bytes = first_bytes(item);
    Numbers numbers(bytes);
    numbers.next(1);
    const std::size_t wide = (numbers.next(1) & 1) != 0 ? 4 : 2;
    numbers.next(type->second == kGrid ? 2 : 8);  // rows and columns, or the colour behind the items
    const std::uint64_t width = numbers.next(wide);
    return claimed_sides(width, numbers.next(wide));
  }

  /// Zeros beyond its end, as libheif has it.
  std::vector<unsigned char> first_bytes(const Item& item) {
    std::vector<unsigned char> bytes;
    for (const Extent& extent : item.extents) {
      std::uint64_t at = extent.at, room = kMostCanvas - bytes.size();
      if (item.in_data) {
        if (!data_ || at > data_->end - data_->begin) break;
        at += data_->begin;
        room = std::min(room, data_->end - at);
      }
      if (extent.length > 0) room = std::min(room, extent.length);  // 0: up to the end
      const auto piece = bytes_at(in_, at, room);
      bytes.insert(bytes.end(), piece.begin(), piece.end());
      if (bytes.size() == kMostCanvas) break;
    }
    bytes.resize(kMostCanvas);
    return bytes;
  }

  void add(Size size) {
    if (size.width < 1 || size.height < 1) return;  // cut off, or damaged: the reader says why
    if (!largest_ || size.area() > largest_->area()) largest_ = size;
  }

  std::ifstream& in_;
  std::map<std::uint64_t, std::uint32_t> types_;
  std::vector<Item> items_;
  std::optional<IsoBox> data_;
  std::optional<Size> largest_;
};

}  // namespace

std::optional<ClaimedSize> heif_size(std::ifstream& in, std::uint64_t size) {
  std::uint64_t at = 0;
  while (const auto box = iso_box_at(in, at, size)) {
    if (box->type == "meta") {
      const auto largest = HeifItems(in, *box).largest();
      return largest ? std::optional(ClaimedSize{*largest, 8}) : std::nullopt;
    }
    at = box->end;
  }
  return {};
}

}  // namespace afterglow

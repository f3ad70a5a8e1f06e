#include "core/printable.h"

namespace afterglow {

std::string printable(std::string text, bool lines) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if ((c < 0x20 && !(lines && c == '\n')) || c == 0x7F) text[i] = ' ';
    const bool c1 = c == 0xC2 && i + 1 < text.size() && (static_cast<unsigned char>(text[i + 1]) & 0xE0) == 0x80;
    if (c1) text.replace(i, 2, 1, ' ');
  }
  return text;
}

}  // namespace afterglow

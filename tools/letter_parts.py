#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes engine/core/letter_parts.inc: letters that Unicode takes apart into a letter and a mark.

    tools/letter_parts.py > engine/core/letter_parts.inc
"""

import unicodedata

LAST = 0xFB50  # presentation forms begin there
HANGUL = range(0xAC00, 0xD7A4)
CJK_COMPATIBILITY = range(0xF900, 0xFB00)
PER_LINE = 5

parts = []
for code in range(0x80, LAST):
    if code in HANGUL or code in CJK_COMPATIBILITY:
        continue
    apart = unicodedata.decomposition(chr(code)).split()
    if not apart or apart[0].startswith("<"):  # none, or one that changes what is meant
        continue
    base, mark = [int(part, 16) for part in apart + ["0"]][:2]
    parts.append(f"{{0x{code:04x}, 0x{base:04x}, 0x{mark:04x}}}")

version = unicodedata.unidata_version.split(".")[0]
print(f"""// SPDX-License-Identifier: MIT
// Letters that Unicode {version} takes for a letter and a mark behind it (canonical decomposition), below U+FB50 without Hangul,
// which goes by a formula, and without CJK compatibility. By tools/letter_parts.py; a mark of 0: another letter alone.
namespace afterglow {{
struct LetterParts {{
  char16_t letter, base, mark;
}};
// clang-format off
constexpr LetterParts kLetterParts[] = {{""")
for first in range(0, len(parts), PER_LINE):
    print("    " + ", ".join(parts[first : first + PER_LINE]) + ",")
print("""};
// clang-format on
}  // namespace afterglow""")

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Gives every source file of this checkout that lacks it the line with its licence: tools/license_tags.py, in the project's folder.

What counts as a source file, and where the line stands, is asked for by the test House.SourcesNameTheirLicence.
"""
import re
import subprocess
from pathlib import Path

TAG = "SPDX-License-Identifier: MIT"
COMMENT = {
    "//": (".cpp", ".h", ".hpp", ".c", ".glsl", ".frag", ".vert", ".js", ".inc"),
    "--": (".lua",),
    "#": (".py", ".pyi", ".sh", ".cmake"),
}
SHELL = ("dev", ".ci/run")
# Findings of fuzzers stay byte for byte; what `afterglow new` writes belongs to its user.
NOT_OURS = ("tests/fuzz/found/", "tests/fuzz/corpus/", "templates/")


def mark_of(name: str) -> str | None:
    if name.startswith(NOT_OURS):
        return None
    if name in SHELL or name.endswith("CMakeLists.txt"):
        return "#"
    if name.endswith(".in"):
        return "//" if name.endswith(".cpp.in") else "#"
    return next((mark for mark, endings in COMMENT.items() if Path(name).suffix in endings), None)


def main() -> None:
    listed = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"]
    for name in subprocess.run(listed, capture_output=True, check=True).stdout.decode().split("\0"):
        mark = mark_of(name) if name else None
        if mark is None or not Path(name).is_file():
            continue
        text = Path(name).read_text(encoding="utf-8")
        if TAG in "\n".join(text.split("\n")[:3]):
            continue
        # A first line that programs read stays the first.
        first = re.match(r"#!.*\n|---@meta.*\n", text)
        at = first.end() if first else 0
        Path(name).write_text(f"{text[:at]}{mark} {TAG}\n{text[at:]}", encoding="utf-8")
        print(name)


if __name__ == "__main__":
    main()

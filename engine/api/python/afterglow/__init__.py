# SPDX-License-Identifier: MIT
"""Afterglow finishes rendered pictures: glow, tone mapping, colour, outlines.

    import afterglow
    stack = afterglow.Stack("look.lua")
    graded = stack.run(pixels)        # (height, width, 3 or 4): float32 and float16 scene-linear, uint8 sRGB codes
"""


class Error(Exception):
    """What went wrong. str() is the text that users see; file and line say where, as far as that is known."""

    def __init__(self, text, message=None, file=None, line=None, allowed=None, nearest=None):
        super().__init__(text)
        self.message = message if message is not None else text
        self.file = file
        self.line = line
        self.allowed = allowed
        self.nearest = nearest


class UsageError(Error, ValueError):
    """A call that cannot be: an unknown setting, a value out of range, pictures that do not fit."""


class ScriptError(Error):
    """A preset, an effect or a shader."""


class FileError(Error, OSError):
    """A file, or more device memory than allowed."""


class DeviceError(Error, RuntimeError):
    """Vulkan."""


from ._afterglow import Device, Stack, __version__  # noqa: E402  (the module looks the classes above up)

__all__ = ["Device", "DeviceError", "Error", "FileError", "ScriptError", "Stack", "UsageError", "__version__"]

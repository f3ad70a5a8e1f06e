# SPDX-License-Identifier: MIT
"""What tests of the Python module share: a device, a folder with an effect, pictures."""
import numpy as np
import pytest

import afterglow

GAIN = """
local fx = require "afterglow"
return fx.effect {
  name = "gain", doc = "Multiplies.", at = "post_process", order = 10,
  settings = { amount = fx.float { default = 1, min = 0, max = 1e6, doc = "Factor." },
               tint = fx.color { default = {1, 1, 1}, doc = "Colour." },
               off = fx.bool { default = false, doc = "Does nothing." } },
  active = function(s) return not s.off, "off is set" end,
  build = function(g, s, source)
    return g:pass { shader = "gain/gain", source = source, amount = s.amount, tint = s.tint }
  end,
}
"""
SHADER = """
uniform float amount;
uniform vec3 tint;
vec4 apply(vec4 color) { return vec4(color.rgb * amount * tint, color.a); }
"""


def look(entries):
    return 'local fx = require "afterglow"\nreturn fx.stack { %s }\n' % entries


@pytest.fixture(scope="session")
def device():
    device = afterglow.Device(validate=True)
    yield device
    assert device.describe()["validation_errors"] == 0


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "effects").mkdir()
    (tmp_path / "shaders/gain").mkdir(parents=True)
    (tmp_path / "effects/gain.lua").write_text(GAIN)
    (tmp_path / "shaders/gain/gain.glsl").write_text(SHADER)
    (tmp_path / "look.lua").write_text(look("fx.gain { amount = 2 }"))
    return tmp_path


@pytest.fixture
def stack(folder, device):
    return afterglow.Stack(folder / "look.lua", device=device)


def picture(height=9, width=16, channels=4, dtype=np.float32):
    values = (np.arange(height * width * channels, dtype=np.float32) % 23) / 16
    return values.reshape(height, width, channels).astype(dtype)

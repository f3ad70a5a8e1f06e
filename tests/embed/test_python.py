# SPDX-License-Identifier: MIT
"""The Python module: arrays in and out, settings, errors, reload, threads."""
import logging
import pathlib
import threading
import time

import numpy as np
import pytest
from conftest import look, picture

import afterglow


def test_floats(stack):
    source = picture()
    before = source.copy()
    result = stack.run(source)
    assert result.dtype == np.float32 and result.shape == source.shape
    np.testing.assert_array_equal(result[..., :3], before[..., :3] * 2)
    np.testing.assert_array_equal(result[..., 3], before[..., 3])
    np.testing.assert_array_equal(source, before)


def test_in_place_and_into_a_given_array(stack):
    source = picture()
    wanted = stack.run(source)
    out = np.zeros((9, 20, 4), np.float32)[:, 2:18]  # a part of another array
    assert stack.run(source, out=out) is out
    np.testing.assert_array_equal(out, wanted)
    assert stack.run(source, out=source) is source
    np.testing.assert_array_equal(source, wanted)


def test_views_need_no_copy_of_the_caller(stack):
    source = picture()
    wanted = stack.run(source)
    np.testing.assert_array_equal(stack.run(source[::-1]), wanted[::-1])
    np.testing.assert_array_equal(stack.run(source[:, ::-1]), wanted[:, ::-1])
    np.testing.assert_array_equal(stack.run(source[2:7, 3:11]), wanted[2:7, 3:11])
    np.testing.assert_array_equal(stack.run(np.asfortranarray(source)), wanted)
    np.testing.assert_array_equal(stack.run(source[..., :3]), wanted[..., :3])
    np.testing.assert_array_equal(stack.run(source.astype(np.float64)), wanted)


def test_views_of_one_sample_at_many_places(folder, device, stack):
    def same(view):
        np.testing.assert_array_equal(stack.run(view), stack.run(view.copy()))

    row = picture(height=1, width=512)
    same(np.broadcast_to(row, (512, 512, 4)))
    same(np.broadcast_to(row, (512, 512, 4))[::-1])
    same(np.broadcast_to(picture(height=64, width=1), (64, 64, 4)))
    same(np.broadcast_to(np.float32(0.25), (64, 64, 3)))
    numbers = np.arange(64, dtype=np.float32) / 64
    overlapping = np.lib.stride_tricks.as_strided
    same(overlapping(numbers, (8, 4, 3), (12, 12, 4)))  # a row is a pixel further than the last
    same(overlapping(numbers[60:], (8, 4, 1), (-4, 4, 4)).repeat(3, axis=2))
    same(overlapping(numbers[24:], (3, 4, 3), (-12, 12, 4)))
    (folder / "look.lua").write_text(look("fx.depth_fog {}"))
    fog = afterglow.Stack(folder / "look.lua", device=device)
    source, depth = picture(64, 64), np.linspace(1, 500, 64, dtype=np.float32)[None, :]
    flat = np.broadcast_to(depth, (64, 64))
    np.testing.assert_array_equal(fog.run(source, depth=flat), fog.run(source, depth=flat.copy()))


def test_results_that_cannot_be_written_in_place(stack):
    memory = np.zeros((9, 16, 4), np.float32)
    strides = memory.strides
    for out in (
        np.lib.stride_tricks.as_strided(memory, memory.shape, (0, *strides[1:])),
        np.lib.stride_tricks.as_strided(memory, memory.shape, (16, *strides[1:])),
        np.lib.stride_tricks.as_strided(memory, memory.shape, (strides[0], 0, strides[2])),
        memory[:, ::-1],
    ):
        with pytest.raises(ValueError, match="no two pixels in one place"):
            stack.run(picture(), out=out)
    assert not memory.any()


def test_results_over_another_part_of_the_source(folder, device):
    # Halves cannot hold every alpha: it is read from the source once more when the result is written.
    stack = afterglow.Stack(folder / "look.lua", device=device, precision="fp16")
    wanted = stack.run(picture(32, 16))
    memory = np.zeros((40, 16, 4), np.float32)
    memory[:32] = picture(32, 16)
    np.testing.assert_array_equal(stack.run(memory[:32], out=memory[3:35]), wanted)
    memory[:32] = picture(32, 16)
    np.testing.assert_array_equal(stack.run(memory[:32], out=memory[:32][::-1]), wanted)


def test_halves_and_codes(stack):
    half = picture(dtype=np.float16)
    result = stack.run(half)
    assert result.dtype == np.float16
    np.testing.assert_array_equal(result[..., :3], half[..., :3] * 2)
    assert stack.run(half, dtype=np.float32).dtype == np.float32
    codes = np.full((4, 4, 3), 255, np.uint8)
    np.testing.assert_array_equal(stack.run(codes), codes)
    np.testing.assert_array_equal(stack.run(codes, dtype="float32"), np.full((4, 4, 3), 2, np.float32))


def test_a_region(stack):
    source = picture()
    out = np.full_like(source, -1)
    stack.run(source, out=out, region=(3, 2, 5, 4))
    wanted = np.full_like(source, -1)
    wanted[2:6, 3:8] = stack.run(source)[2:6, 3:8]
    np.testing.assert_array_equal(out, wanted)


def test_settings(stack):
    assert stack.get("gain.amount") == 2
    stack.set("gain.amount", 3)
    assert stack.get("gain.amount") == 3
    stack.set("gain.tint", (1, 0.5, np.float64(0.25)))
    assert stack.get("gain.tint") == [1, 0.5, 0.25]
    one = np.ones((1, 1, 3), np.float32)
    np.testing.assert_array_equal(stack.run(one)[0, 0], (3, 1.5, 0.75))
    stack.set("gain.off", True)
    np.testing.assert_array_equal(stack.run(one), one)
    stack.set("gain.off", np.bool_(False))
    np.testing.assert_array_equal(stack.run(one)[0, 0], (3, 1.5, 0.75))
    stack.unset("gain.off")
    stack.set("gain.tint", "#ffffff")
    stack.set("gain.amount", np.float32(5))
    np.testing.assert_array_equal(stack.run(one), 5 * one)
    stack.set("gain.opacity", 0.5)
    assert [stack.get("gain." + name) for name in ("opacity", "blend", "mask", "enabled")] == [0.5, "normal", 1, True]
    with pytest.raises(afterglow.UsageError, match="empty"):
        stack.unset("")
    assert stack.get("gain.opacity") == 0.5
    stack.unset()
    np.testing.assert_array_equal(stack.run(one), 2 * one)
    [entry] = stack.settings
    assert entry["name"] == "gain"
    amount = next(s for s in entry["settings"] if s["name"] == "amount")
    assert amount["default"] == 1 and amount["max"] == 1e6 and amount["doc"] == "Factor."
    assert stack.explain()["entries"][0]["state"] == "runs"
    assert stack.explain()["inputs"] == [] and stack.explain()["pre_roll"] == 0
    assert stack.report()["kernels"] == ["gain.gain"]


@pytest.mark.parametrize("follow", [False, True])
def test_several_settings_at_once(folder, device, follow):
    stack = afterglow.Stack(folder / "look.lua", device=device, follow=follow)
    stack.set({"gain.amount": np.float32(3), "gain.tint": (0.5, 1, 1), "gain.off": False})
    assert stack.get("gain.amount") == 3 and stack.get("gain.tint") == [0.5, 1, 1]
    for wrong in ("gain.amonut", "gain.off"):
        with pytest.raises(afterglow.UsageError, match=wrong):
            stack.set({"gain.amount": 9, wrong: 5, "gain.tint": "#ffffff"})
        assert stack.get("gain.amount") == 3 and stack.get("gain.tint") == [0.5, 1, 1]
    with pytest.raises(TypeError, match="values: dict"):
        stack.set("gain.amount")
    with pytest.raises(TypeError, match="gain.tint must be .* not NoneType"):
        stack.set({"gain.amount": 9, "gain.tint": None})
    assert stack.get("gain.amount") == 3
    stack.set({})


def test_arguments(folder, device):
    (folder / "look.lua").write_text(
        'local fx = require "afterglow"\n'
        "local args = fx.args { strength = fx.float { default = 2, min = 0, max = 9, doc = '.' },\n"
        "  on = fx.bool { default = false, doc = '.' }, tint = fx.color { default = { 1, 1, 1 }, doc = '.' },\n"
        "  way = fx.enum { 'post_process', 'after_post_process', default = 'post_process', doc = '.' } }\n"
        "return fx.stack { fx.gain { amount = args.strength, off = args.on, tint = args.tint, at = args.way } }\n"
    )
    args = {"strength": np.float32(3), "on": np.bool_(True), "tint": (1, 0.5, 0), "way": "after_post_process"}
    stack = afterglow.Stack(folder / "look.lua", device=device, args=args)
    values = [stack.get("gain." + name) for name in ("amount", "off", "tint", "at")]
    assert values == [3, True, [1, 0.5, 0], "after_post_process"]
    assert {one["name"]: one["given"] for one in stack.arguments} == dict.fromkeys(args, True)
    stack.set_argument("strength", 4)
    assert stack.get("gain.amount") == 4
    stack.set_argument("strength", None)
    assert stack.get("gain.amount") == 2
    with pytest.raises(afterglow.UsageError) as caught:
        stack.set_argument("strenght", 1)
    assert caught.value.nearest == "strength"
    with pytest.raises(TypeError, match="strength must be"):
        afterglow.Stack(folder / "look.lua", device=device, args={"strength": {}})


def test_errors_name_file_and_line(folder, device, stack):
    with pytest.raises(afterglow.UsageError) as caught:
        stack.set("gain.amonut", 1)
    assert caught.value.nearest == "amount"
    assert isinstance(caught.value, ValueError)
    with pytest.raises(afterglow.UsageError):
        stack.get("gain.amonut")
    (folder / "look.lua").write_text('local fx = require "afterglow"\nreturn fx.stack {\n  fx.gain { amount = "x" },\n}\n')
    with pytest.raises(afterglow.ScriptError) as caught:
        afterglow.Stack(folder / "look.lua", device=device)
    assert caught.value.file == str(folder / "look.lua")
    assert caught.value.line == 3
    assert str(caught.value).startswith(f"{folder / 'look.lua'}:3: error: ")
    assert caught.value.message in str(caught.value)
    with pytest.raises(afterglow.DeviceError):
        afterglow.Device("no such device")
    with pytest.raises(afterglow.Error):
        afterglow.Stack("no_such_preset", device=device)


def test_wrong_arguments(stack):
    with pytest.raises(ValueError, match="shape"):
        stack.run(np.zeros((4, 4), np.float32))
    with pytest.raises(afterglow.UsageError, match="2 channels"):
        stack.run(np.zeros((4, 4, 2), np.float32))
    with pytest.raises(TypeError, match="dethp"):
        stack.run(picture(), dethp=None)
    with pytest.raises(ValueError, match="read-only"):
        out = picture()
        out.flags.writeable = False
        stack.run(picture(), out=out)
    for call, told in (
        (lambda: afterglow.Stack("neon_night", device="auto"), "device must be an afterglow.Device, not str"),
        (lambda: afterglow.Stack("neon_night", max_error="small"), "max_error must be a number, not str"),
        (lambda: afterglow.Stack("neon_night", follow="no"), "follow must be a bool, not str"),
        (lambda: afterglow.Stack("neon_night", max_memory=-1), "max_memory must be a whole number from 0 on, not int"),
        (lambda: afterglow.Stack("neon_night", text=3), "text must be a str, not int"),
        (lambda: stack.run(picture(), frame=[1]), "frame must be a number, not list"),
        (lambda: stack.run(picture(), position=1), r"position must be three numbers \(x, y, z\), not int"),
        (lambda: stack.run(picture(), region=(1, 2)), "region must be .*, not tuple"),
        (lambda: stack.set("gain.amount", {}), "gain.amount must be a bool, a number, a str or some numbers, not dict"),
        (lambda: stack.set("gain.amount", None), "not NoneType"),
    ):
        with pytest.raises(TypeError, match=told):
            call()
    with pytest.raises(afterglow.UsageError, match="fps is 0"):
        stack.run(picture(), fps=0)
    with pytest.raises(ValueError, match="allowed: auto, fp32, fp16"):
        afterglow.Stack("neon_night", precision="double")


def test_numbers_that_may_be_codes_are_no_light(stack, device):
    for dtype in (np.uint16, np.int8, np.int64, bool, complex, "S4", "datetime64[s]"):
        with pytest.raises(afterglow.UsageError, match="source is an array of .*allowed: floats"):
            stack.run(np.ones((2, 2, 3), np.uint8).astype(dtype))
    # What is no colour may be whole.
    outline = afterglow.Stack("ink_outline", device=device)
    depth = np.full((16, 16), 5, np.uint16)
    depth[4:12, 4:12] = 1
    source = np.full((16, 16, 3), 0.5, np.float32)
    np.testing.assert_array_equal(outline.run(source, depth=depth), outline.run(source, depth=depth.astype(np.float32)))
    with pytest.raises(afterglow.UsageError, match="depth is an array of complex64; allowed: numbers"):
        outline.run(source, depth=depth.astype(np.complex64))


def test_masks_are_not_lost_silently(stack, device):
    masked = np.ma.masked_less(picture(), 0.5)
    for call, name in (
        (lambda: stack.run(masked), "source"),
        (lambda: stack.run(picture(), depth=masked[..., 0]), "depth"),
        (lambda: stack.run(picture(), out=masked), "out"),
    ):
        with pytest.raises(TypeError, match=r"%s is a masked array; give its values: %s.filled\(0\)" % (name, name)):
            call()
    np.testing.assert_array_equal(stack.run(masked.data), stack.run(picture()))


def test_pictures_that_do_not_fit_are_usage_errors(stack):
    for shape in ((4, 4), (4, 4, 5), (3, 4, 40), (4,), (2, 3, 4, 4)):
        with pytest.raises(afterglow.UsageError, match="shape is"):
            stack.run(np.zeros(shape, np.float32))
    with pytest.raises(afterglow.UsageError, match="no array"):
        stack.run(None)

    class Broken:
        def __array__(self, *args, **options):
            raise OSError("the tape is torn")

    with pytest.raises(OSError, match="the tape is torn"):
        stack.run(Broken())


def test_values_of_numpy_and_whole_numbers(folder, device, stack):
    one = np.ones((1, 1, 3), np.float32)
    for value in (5, 5.0, np.float32(5), np.int64(5), np.array(5), np.array(5.0, np.float16)):
        stack.set("gain.amount", value)
        np.testing.assert_array_equal(stack.run(one), 5 * one)
    for value in (True, np.bool_(True), np.array(True)):
        stack.set("gain.off", value)
        np.testing.assert_array_equal(stack.run(one), one)
    look_of_text = """
local fx = require "afterglow"
local args = fx.args { shot = fx.text { default = "none", doc = "Shot." } }
return fx.stack { name = args.shot, fx.gain {} }
"""
    (folder / "shots.lua").write_text(look_of_text)
    for value, text in ((5, "5"), (np.int32(5), "5"), (0.5, "0.5"), (10**12, "1000000000000")):
        shots = afterglow.Stack(folder / "shots.lua", device=device, args={"shot": value})
        assert shots.arguments[0]["value"] == text


def test_time_is_that_of_the_frame(folder, device):
    (folder / "timed.lua").write_text(look("fx.gain { amount = function(t) return t.time end }"))
    timed = afterglow.Stack(folder / "timed.lua", device=device)
    one = np.ones((1, 1, 3), np.float32)
    np.testing.assert_array_equal(timed.run(one, frame=48), 2 * one)
    np.testing.assert_array_equal(timed.run(one, frame=48, fps=16), 3 * one)
    np.testing.assert_array_equal(timed.run(one, frame=48, time=7), 7 * one)


def test_reload(folder, stack):
    one = np.ones((1, 1, 3), np.float32)
    (folder / "look.lua").write_text(look("fx.gain { amount = 7 }"))
    np.testing.assert_array_equal(stack.run(one), 2 * one)
    stack.reload()
    np.testing.assert_array_equal(stack.run(one), 7 * one)
    stack.reload(look("fx.gain { amount = 9 }"))
    np.testing.assert_array_equal(stack.run(one), 9 * one)
    with pytest.raises(afterglow.ScriptError):
        stack.reload(look("fx.gian {}"))
    np.testing.assert_array_equal(stack.run(one), 9 * one)


def test_follow(folder, device):
    woken = threading.Event()
    stack = afterglow.Stack(folder / "look.lua", device=device, follow=True, wake=woken.set)
    one = np.ones((1, 1, 3), np.float32)
    np.testing.assert_array_equal(stack.run(one), 2 * one)
    (folder / "look.lua").write_text(look("fx.gain { amount = 7 }"))
    changed = False
    while not changed:
        assert woken.wait(120)
        woken.clear()
        changed = stack.update()
    np.testing.assert_array_equal(stack.run(one), 7 * one)


def test_set_while_an_edit_is_broken(folder, device):
    file = folder / "look.lua"
    stack = afterglow.Stack(file, device=device, follow=True)
    one = np.ones((1, 1, 3), np.float32)
    for broken in ("return fx.(", None):
        stack.set("gain.amount", 3)
        np.testing.assert_array_equal(stack.run(one), 3 * one)
        file.write_text(broken) if broken else file.unlink()
        stack.set("gain.amount", 5)
        stack.set("gain.amount", 6)
        np.testing.assert_array_equal(stack.run(one), 3 * one)
        told = None
        while told is None:
            try:
                stack.update()
            except (afterglow.ScriptError, afterglow.FileError) as error:
                told = error
            time.sleep(0.01)
        stack.update()  # told once
        file.write_text(look("fx.gain { amount = 7 }"))
        while (stack.run(one) != 6).any():
            stack.update()
            time.sleep(0.01)
        with pytest.raises(afterglow.UsageError, match="gain.amount"):
            stack.set("gain.amount", "much")


def test_depth(device):
    text = 'local fx = require "afterglow" return fx.stack { fx.outline { source = "mixed", combine = "max" } }'
    stack = afterglow.Stack("lines.lua", text=text, device=device)
    source = np.full((16, 16, 3), 0.5, np.float32)
    depth = np.full((16, 16), 5, np.float32)
    depth[4:12, 4:12] = 1
    normal = np.zeros((16, 16, 3), np.float16)
    normal[..., 2] = 1
    with_lines = stack.run(source, depth=depth, normal=normal)
    assert with_lines.min() < 0.3 < source.min()
    # What a look lacks is skipped and told.
    without = stack.run(source)
    assert without.min() > 0.3
    assert any("depth" in s["reason"] or "normal" in s["reason"] for s in stack.report()["skipped"])


def test_threads_share_a_stack(stack):
    one = np.ones((64, 64, 3), np.float32)
    failures = []

    def work():
        for _ in range(5):
            if not np.array_equal(stack.run(one), 2 * one):
                failures.append("wrong pixels")

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures


def test_messages(folder, device, caplog):
    source = np.full((1, 1, 3), np.nan, np.float32)
    told = []
    stack = afterglow.Stack(folder / "look.lua", device=device, message=lambda level, text: told.append((level, text)))
    assert not stack.run(source).any()
    assert len(told) == 1 and told[0][0] == "warning" and "3 samples" in told[0][1]
    with caplog.at_level(logging.WARNING, "afterglow"):
        afterglow.Stack(folder / "look.lua", device=device).run(source)
    assert "3 samples" in caplog.text


def test_the_stub_names_what_there_is():
    stub = (pathlib.Path(afterglow.__file__).parent / "__init__.pyi").read_text()
    for cls in (afterglow.Stack, afterglow.Device):
        for name in vars(cls):
            if not name.startswith("_"):
                assert f"def {name}(" in stub, name
    assert (pathlib.Path(afterglow.__file__).parent / "py.typed").exists()


def test_messages_know_the_module_alone(device, stack):
    with pytest.raises(afterglow.UsageError, match="^[^:]*: the shape is .*; sides go from 1 to 16384"):
        stack.run(np.broadcast_to(np.float32(1), (100000, 100000, 3)))  # 112 GiB, if it were copied
    for wrong in (lambda: afterglow.Stack(device=device), lambda: stack.unset(""), lambda: stack.run(picture(), fps=0)):
        with pytest.raises(afterglow.UsageError) as raised:
            wrong()
        assert "afterglow_" not in str(raised.value)

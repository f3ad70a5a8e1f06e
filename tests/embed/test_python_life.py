# SPDX-License-Identifier: MIT
"""The Python module: how long objects live, functions that it calls, processes, names and texts of any bytes."""
import gc
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time
import weakref

import numpy as np
import pytest
from conftest import look, picture

import afterglow


told = []


class Viewer:
    """Owns its stack, which calls it: a cycle that the collector alone can end."""

    def __init__(self, preset, **options):
        self.stack = afterglow.Stack(preset, message=self.on_message, **options)

    def on_message(self, level, text):
        told.append(text)

    def on_wake(self):
        pass


class Follower(Viewer):
    def __init__(self, preset, device):
        super().__init__(preset, device=device, follow=True, wake=self.on_wake)


class Owner(Viewer):
    """The device calls it, and nobody but the stack has the device."""

    def __init__(self, preset, device):
        super().__init__(preset, device=afterglow.Device(message=self.on_message))


def threads():
    return len(os.listdir("/proc/self/task"))


@pytest.mark.parametrize("kind", [Follower, Owner])
def test_stacks_that_call_their_owner_are_collected(folder, device, kind):
    kind(folder / "look.lua", device).stack.run(picture())  # what the driver starts, and keeps
    gc.collect()
    before = threads()
    owners = []
    for _ in range(4):
        viewer = kind(folder / "look.lua", device)
        viewer.stack.run(picture())
        gc.collect()  # nothing of what is used
        viewer.stack.run(np.full((2, 2, 3), np.nan, np.float32))
        assert "mended" in told.pop()
        owners.append(weakref.ref(viewer))
        del viewer
    gc.collect()
    assert [owner() for owner in owners] == [None] * 4
    deadline = time.monotonic() + 60
    while threads() > before and time.monotonic() < deadline:
        time.sleep(0.01)
    assert threads() <= before


ENDED = """
import sys, threading, time
import numpy as np
import afterglow
stack = afterglow.Stack(sys.argv[1])
ran = threading.Event()
def work():
    while True:
        stack.run(np.ones((64, 64, 3), np.float32))
        ran.set()
for _ in range(3):
    threading.Thread(target=work, daemon=True).start()
ran.wait()
"""


def test_python_ends_while_a_daemon_thread_is_at_work(folder):
    for _ in range(4):
        subprocess.run([sys.executable, "-c", ENDED, folder / "look.lua"], check=True, timeout=240)


def test_the_collector_may_run_at_any_time(folder, device):
    class Path:
        def __fspath__(self):
            gc.collect()  # the stack is half made
            return str(folder / "look.lua")

    class Derived(afterglow.Stack):
        pass

    bare = afterglow.Stack.__new__(afterglow.Stack)
    gc.collect()
    del bare
    for cls in (afterglow.Stack, Derived):
        stack = cls(Path(), device=device, message=lambda level, text: gc.collect())
        stack.run(np.full((1, 1, 3), np.nan, np.float32))
        if cls is Derived:
            stack.itself = stack
        gone = weakref.ref(stack)
        del stack
        gc.collect()
        assert gone() is None


def test_a_stack_may_go_on_its_own_thread(folder, device):
    held, gone = [], threading.Event()
    held.append(afterglow.Stack(folder / "look.lua", device=device, follow=True, wake=held.clear))
    weakref.finalize(held[0], gone.set)
    (folder / "look.lua").write_text(look("fx.gain { amount = 7 }"))
    assert gone.wait(60)


def test_what_was_never_made_is_refused(device):
    stack, other = afterglow.Stack.__new__(afterglow.Stack), afterglow.Device.__new__(afterglow.Device)
    for call in (
        lambda: stack.run(np.zeros((1, 1, 3), np.float32)),
        lambda: stack.settings,
        lambda: stack.set("gain.amount", 1),
        lambda: stack.close(),
        lambda: stack.__exit__(),
        lambda: other.describe(),
        lambda: other.close(),
        lambda: afterglow.Stack("neon_night", device=other),
    ):
        for _ in range(2):  # asking does not make it
            with pytest.raises(TypeError, match=r"(Stack|Device).__init__\(\) (has not been|must be) called"):
                call()


def test_closing(folder, device):
    told = []
    with afterglow.Stack(folder / "look.lua", device=device, follow=True, message=lambda *what: told.append(what)) as stack:
        stack.run(picture())
    stack.close()
    for use in (
        lambda: stack.run(picture()),
        lambda: stack.settings,
        lambda: stack.get("gain.amount"),
        lambda: stack.set("gain.amount", 1),
        stack.update,
        stack.reset_history,
    ):
        with pytest.raises(ValueError, match="the stack is closed"):
            use()
    with afterglow.Device() as own:
        stack = afterglow.Stack(folder / "look.lua", device=own)
    own.close()
    np.testing.assert_array_equal(stack.run(picture())[..., 0], picture()[..., 0] * 2)
    with pytest.raises(ValueError, match="the device is closed"):
        own.describe()
    with pytest.raises(ValueError, match="the device is closed"):
        afterglow.Stack(folder / "look.lua", device=own)


def test_a_message_function_must_not_use_its_own_stack(folder, device):
    raised = []

    def message(level, text):
        for use in (stack.report, stack.close, lambda: stack.set("gain.amount", 3), lambda: other.settings):
            try:
                use()
            except RuntimeError as error:
                raised.append(str(error))

    other = afterglow.Stack(folder / "look.lua", device=device)
    stack = afterglow.Stack(folder / "look.lua", device=device, message=message)
    signal.alarm(120)  # it stood for ever, and Ctrl-C did not end it
    stack.run(np.full((1, 1, 3), np.nan, np.float32))
    signal.alarm(0)
    assert len(raised) == 3 and all("in its own message or wake function" in text for text in raised)
    assert stack.report()["kernels"]


def test_ctrl_c_in_a_message_function_reaches_the_program(folder, device, monkeypatch):
    def message(level, text):
        raise KeyboardInterrupt

    monkeypatch.setattr(sys, "unraisablehook", lambda what: None)
    stack = afterglow.Stack(folder / "look.lua", device=device, message=message)
    with pytest.raises(KeyboardInterrupt):
        stack.run(np.full((1, 1, 3), np.nan, np.float32))
        for _ in range(1000):  # it comes at the next instruction that looks for signals
            pass


@pytest.mark.parametrize("said", [r"caf\xe9", r"\xed\xa0\x80", r"\xf0\x9f"])
def test_texts_that_are_no_utf8(device, said):
    told = []
    text = "print('%s') error('%s')" % (said, said)
    with pytest.raises(afterglow.ScriptError) as caught:
        afterglow.Stack(text=text, device=device, message=lambda level, text: told.append(text))
    assert "\ufffd" in str(caught.value) and "\ufffd" in caught.value.message
    assert len(told) == 1 and "\ufffd" in told[0]


def test_names_of_files_are_any_bytes(folder, device):
    odd = os.fsencode(folder) + b"/caf\xe9.lua"
    with open(odd, "w") as file:
        file.write(look("fx.gain { amount = 3 }"))
    [listed] = [name for name in os.listdir(folder) if name.startswith("caf")]
    for path in (odd, folder / listed, str(folder / listed)):
        stack = afterglow.Stack(path, device=device)
        assert stack.get("gain.amount") == 3
        assert stack.report()["preset"].endswith("caf\ufffd.lua")
    with pytest.raises(afterglow.ScriptError) as caught:
        afterglow.Stack(b"/nowhere/caf\xe9", device=device)
    assert "caf\ufffd" in str(caught.value)


def test_names_of_files_have_no_nul_in_them(folder, device):
    cut = str(folder / "look.lua") + "\0x"
    for call in (
        lambda: afterglow.Stack(cut, device=device),
        lambda: afterglow.Stack(folder / "look.lua", device=device, paths=[cut]),
        lambda: afterglow.Device(cache=cut),
    ):
        with pytest.raises(ValueError, match="embedded NUL in the name of a file"):
            call()


def test_paths_are_one_or_some(folder, device, tmp_path_factory):
    elsewhere = tmp_path_factory.mktemp("elsewhere") / "look.lua"
    elsewhere.write_text(look("fx.gain { amount = 5 }"))
    for paths in (folder, str(folder), bytes(folder), [folder], (str(folder), b"/nowhere")):
        assert afterglow.Stack(elsewhere, device=device, paths=paths).get("gain.amount") == 5
    with pytest.raises(TypeError):
        afterglow.Stack(elsewhere, device=device, paths=3)


def test_caches(folder):
    afterglow.Stack(folder / "look.lua", device=afterglow.Device(cache=folder / "cache")).run(picture())
    assert list((folder / "cache/shaders").iterdir())
    told = []
    device = afterglow.Device(cache=folder / "look.lua", message=lambda level, text: told.append((level, text)))
    for _ in range(2):
        afterglow.Stack(folder / "look.lua", device=device).run(picture())
    [text] = [text for level, text in told if level == "warning"]
    assert str(folder / "look.lua") in text and "the cache folder cannot be written to" in text
    with pytest.raises(TypeError):
        afterglow.Device(cache=3)


def test_settings_need_no_numpy(folder):
    code = (
        "import sys; sys.modules['numpy'] = None\n"
        "import afterglow\n"
        "stack = afterglow.Stack(sys.argv[1])\n"
        "stack.set('gain.amount', 3); stack.set('gain.off', True); stack.set('gain.tint', (1, 0, 1))\n"
        "assert [stack.get('gain.' + name) for name in ('amount', 'off', 'tint')] == [3, True, [1, 0, 1]]\n"
    )
    subprocess.run([sys.executable, "-c", code, folder / "look.lua"], check=True)


FORKED = """
import os, signal, sys, threading
import numpy as np
import afterglow

device = afterglow.Device()
stack = afterglow.Stack(sys.argv[1], device=device, follow=sys.argv[2] == "follow", wake=lambda: None)
one = np.ones((64, 64, 3), np.float32)
stack.run(one)
busy = threading.Thread(target=lambda: [stack.run(one) for _ in range(300)])
if sys.argv[2] == "busy":
    busy.start()
children = []
for _ in range(8):
    child = os.fork()
    if child == 0:
        break
    children.append(child)
else:
    if busy.ident:
        busy.join()
    codes = [os.waitstatus_to_exitcode(os.waitpid(one, 0)[1]) for one in children]
    assert codes == [0] * 8, codes
    assert stack.run(one)[0, 0, 0] == 2
    sys.exit(0)
signal.alarm(60)  # SIGALRM ends a child that hangs
for use in (lambda: stack.run(one), lambda: stack.settings, lambda: stack.set("gain.amount", 1), device.describe,
            lambda: afterglow.Stack(sys.argv[1], device=device)):
    try:
        use()
        os._exit(1)
    except afterglow.DeviceError as error:
        assert "opened before fork" in str(error)
if sys.argv[2] == "close":
    stack.close()
if sys.argv[2] == "anew":
    stack = afterglow.Stack(sys.argv[1])
    assert stack.run(one)[0, 0, 0] == 2
    os._exit(0)  # as multiprocessing does: at exit() Mesa waits for threads that it had in the parent
"""


@pytest.mark.parametrize("way", ["exit", "close", "follow", "busy", "anew"])
def test_after_fork_a_child_is_told_and_ends(folder, way):
    subprocess.run([sys.executable, "-c", FORKED, folder / "look.lua", way], check=True, timeout=240)


def test_the_stub_names_what_is_given():
    stub = (pathlib.Path(afterglow.__file__).parent / "__init__.pyi").read_text()
    for word in ("def __enter__", "def __exit__", "def close"):
        assert stub.count(word) == 2

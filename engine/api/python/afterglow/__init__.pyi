# SPDX-License-Identifier: MIT
from os import PathLike
from typing import Any, Callable, Iterable, Literal, Mapping, Optional, Sequence, Tuple, Union, overload

import numpy as np
from numpy.typing import DTypeLike, NDArray

__version__: str

_Path = Union[str, bytes, PathLike[str], PathLike[bytes]]
_Message = Callable[[Literal["info", "warning"], str], None]
_Value = Union[bool, float, str, Sequence[float], np.generic, NDArray[Any]]

class Error(Exception):
    message: str
    file: Optional[str]
    line: Optional[int]
    allowed: Optional[str]
    nearest: Optional[str]

class UsageError(Error, ValueError): ...
class ScriptError(Error): ...
class FileError(Error, OSError): ...
class DeviceError(Error, RuntimeError): ...

class Device:
    """A Vulkan device, and the kernels that its stacks share. `device`: "auto", an index, or a part of a name or uuid.
    `cache`: a folder where compiled shaders are kept; None: nowhere. Messages go to `message`, or to the logger
    "afterglow". `message` may be called on any thread, and must not use a stack of this device: that raises
    RuntimeError. After fork() the device and its stacks are the parent's: a child that uses them gets a DeviceError, and
    opens a device of its own."""

    def __init__(
        self,
        device: str = "auto",
        *,
        validate: bool = False,
        cache: Optional[_Path] = None,
        message: Optional[_Message] = None,
    ) -> None: ...
    def describe(self) -> dict[str, Any]: ...
    def close(self) -> None:
        """Lets go of the device, as the end of a `with` block does; stacks that were made on it go on. What uses it
        later raises ValueError."""

    def __enter__(self) -> Device: ...
    def __exit__(self, *exception: object) -> None: ...

class Stack:
    """A preset made runnable on a device. Several threads may use one: their calls wait for each other. Two stacks run
    at the same time. `message` and `wake` may be called on any thread, and must not use the stack themselves: that
    raises RuntimeError. They may be methods of what owns the stack."""

    def __init__(
        self,
        preset: Optional[_Path] = None,
        *,
        text: str = "",
        device: Optional[Device] = None,
        args: Optional[Mapping[str, _Value]] = None,
        paths: Union[_Path, Iterable[_Path]] = (),
        installation: Optional[_Path] = None,
        calibration: Optional[_Path] = None,
        precision: Literal["auto", "fp32", "fp16"] = "auto",
        max_error: float = 0,
        max_memory: int = 0,
        reference: bool = False,
        time_kernels: bool = False,
        follow: bool = False,
        message: Optional[_Message] = None,
        wake: Optional[Callable[[], None]] = None,
    ) -> None: ...
    def run(
        self,
        source: NDArray[Any],
        *,
        depth: Optional[NDArray[Any]] = None,
        normal: Optional[NDArray[Any]] = None,
        motion: Optional[NDArray[Any]] = None,
        out: Optional[NDArray[Any]] = None,
        dtype: Optional[DTypeLike] = None,
        frame: float = 1,
        time: Optional[float] = None,
        fps: float = 24,
        step: float = 1,
        restart: bool = False,
        position: Optional[Tuple[float, float, float]] = None,
        region: Optional[Tuple[int, int, int, int]] = None,
        dither: bool = False,
    ) -> NDArray[Any]:
        """Runs the stack on a picture of (height, width, 3 or 4). float32 and float16 are scene-linear with associated
        alpha, uint8 are sRGB codes with straight alpha. Other floats become float32, other numbers are refused as
        colours: they may be codes of any kind. The result is a new array like the source, of `dtype` where that is
        given, or `out`, which may be the source itself. With `region` the rest of a new array is undefined. `time` in seconds is frame / fps where it is not given, as `afterglow run` counts."""

    @overload
    def set(self, name: str, value: _Value) -> None:
        """Sets ENTRY.SETTING, as in "glow.intensity". Text is read as on the command line."""

    @overload
    def set(self, values: dict[str, _Value]) -> None:
        """Sets several at once, all or none."""

    def unset(self, name: Optional[str] = None) -> None: ...
    def set_argument(self, name: str, value: Optional[_Value]) -> None:
        """Gives an argument of the preset (fx.args) a value, as `args` does; None: its default."""

    def get(self, name: str) -> Any: ...
    @property
    def arguments(self) -> list[dict[str, Any]]: ...
    @property
    def settings(self) -> list[dict[str, Any]]: ...
    def explain(self) -> dict[str, Any]: ...
    def report(self) -> dict[str, Any]: ...
    def reload(self, text: Optional[str] = None) -> None: ...
    def update(self) -> bool: ...
    def reset_history(self) -> None: ...
    def close(self) -> None:
        """Frees the stack and its memory and ends its threads, as the end of a `with` block does. What uses it later
        raises ValueError."""

    def __enter__(self) -> Stack: ...
    def __exit__(self, *exception: object) -> None: ...

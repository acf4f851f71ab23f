"""Start a node quickly: import rclpy before the node is built.

The launcher starts before the install tree exists: as a fork of the fork server (grader.trial.fork_server) or, if there
is no fork server, as a separate script. The launcher reads one line of JSON (`script`, `ros_arguments`, `params_file`,
`python_path`, `env`, `install`) and then the install tree, a tar stream, from standard input. After reading the install
tree, the launcher runs the installed script as __main__, as the interpreter in the script's first line would.

`ros_arguments` are the ROS arguments of the node, for example those that select simulated time. rclpy gets these
arguments when it is initialized. The arguments never appear in the sys.argv of a Python script, because a program that
reads its own arguments must find none, as with `ros2 run PACKAGE EXECUTABLE`. A script that is not Python gets them on
its command line.
"""

from __future__ import annotations

import atexit
import ctypes
import functools
import importlib
import json
import os
import signal
import sys
import tarfile
import time
import types
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

_AHEAD = (
    "importlib.metadata",
    "rclpy.action",
    "rclpy.executors",
    "rclpy.callback_groups",
    "rclpy.qos",
    "service_msgs.msg",
    "std_msgs.msg",
    "turtlesim.srv",
    "type_description_interfaces.msg",
)
POSTPONED = ("numpy", "yaml")
"""Modules that most nodes never use, although rclpy and the message packages import them. They account for half of the
CPU time that importing rclpy takes.
"""
_NOT_NEEDED = "rosidl_generator_py.generate_py_impl"
"""A module that creates Python code from interfaces and imports a parser. Messages can be used without this module."""
_SIMULATED = "use_sim_time:=true"
DELIVERY_S = 0.5
"""The maximum time for which a publisher is kept until its messages have been acknowledged (s)."""
PAUSES = 0x7A3C5EC10C4B0A5E
"""A number that shows that the memory is still that of the launcher, and not that of a program which replaced it."""
FOREVER = 2**62
_PR_SET_PDEATHSIG, _PR_SET_TIMERSLACK, _PR_GET_TIMERSLACK = 1, 29, 30
"""First arguments of prctl(2), with their values from linux/prctl.h."""
_TYPES_AHEAD = (("geometry_msgs.msg", "Twist"), ("rosgraph_msgs.msg", "Clock"), ("turtlesim.msg", "Pose"))


class Postponed(types.ModuleType):
    """A placeholder for a module that is imported when one of its names is used for the first time."""

    def load(self) -> types.ModuleType:
        """Import the module now. Return the module."""
        if sys.modules.get(self.__name__) is self:
            del sys.modules[self.__name__]
        module = importlib.import_module(self.__name__)
        self.__dict__.update(module.__dict__)
        return module

    def __getattr__(self, name: str) -> object:
        if name == "__file__":  # inspect looks for the file of every module
            raise AttributeError(name)
        return getattr(self.load(), name)


@contextmanager
def postponed(names: Iterable[str] = POSTPONED) -> Iterator[list[Postponed]]:
    """Inside the context, let imports of these modules return placeholders.

    A placeholder imports its module when it is used. Modules that are imported after the context get the real modules.
    Inside the context, the part of ROS 2 that generates the code of messages is not imported at all.
    """
    modules = [Postponed(name) for name in names if name not in sys.modules]
    sys.modules.update({module.__name__: module for module in modules})
    sys.modules.setdefault(_NOT_NEEDED, None)  # type: ignore[arg-type]  # None makes an import fail
    try:
        yield modules
    finally:
        if sys.modules.get(_NOT_NEEDED) is None:
            sys.modules.pop(_NOT_NEEDED, None)
        for module in modules:
            if sys.modules.get(module.__name__) is module:
                del sys.modules[module.__name__]


def import_ahead() -> list[Postponed]:
    """Import the modules that almost every node needs. Return placeholders for modules that few nodes need."""
    with postponed() as modules:
        for name in _AHEAD:
            importlib.import_module(name)
        for name, message in _TYPES_AHEAD:
            type(getattr(importlib.import_module(name), message)).__import_type_support__()
    return modules


def _initialize_with(ours: list[str]) -> None:
    """Make every ROS context use the ROS arguments `ours` in addition to its own arguments."""
    from rclpy.context import Context

    original = Context.init

    @functools.wraps(original)
    def init(self: Context, args: list[str] | None = None, **options: object) -> None:
        given = sys.argv if args is None else args
        original(self, [*given, *ours] if isinstance(given, list | tuple) else given, **options)

    Context.init = init


def deliver_before_destroying() -> None:
    """Keep each publisher until its messages have been acknowledged, or until DELIVERY_S has passed.

    A subscription drops a message that arrives after the notice that the publisher is gone. Without the wait, it would
    depend on the load of the machine whether the last message of a node arrives before this notice. During the wait,
    the node is busy instead of sleeping, so that simulated time does not advance. After a crash, there is no wait.
    """
    from rclpy.duration import Duration
    from rclpy.publisher import Publisher

    original, monotonic, prctl = Publisher.destroy, time.monotonic, ctypes.CDLL(None).prctl

    @functools.wraps(original)
    def destroy(self: Publisher) -> None:
        # After a crash, a wait could be interrupted by Ctrl-C, which would replace the traceback.
        crashed = sys.exc_info()[0] not in (None, SystemExit)
        until = monotonic() + (0.0 if crashed else DELIVERY_S)
        # By default, Linux lets even a wait without duration sleep for 50 microseconds.
        slack_ns = prctl(_PR_GET_TIMERSLACK, 0, 0, 0, 0)
        prctl(_PR_SET_TIMERSLACK, 1, 0, 0, 0)
        with suppress(Exception):
            while not self.wait_for_all_acked(Duration()) and (now := monotonic()) < until:
                while monotonic() < now + DELIVERY_S / 500:
                    pass
        prctl(_PR_SET_TIMERSLACK, slack_ns, 0, 0, 0)
        original(self)

    Publisher.destroy = destroy


def publish_pauses(pause: ctypes.Array[ctypes.c_int64]) -> None:
    """Keep two numbers in `pause`: PAUSES, and how long the node has nothing to do unless it receives something (ns).

    That is the time until the next timer is due, as of the start of the current wait, and FOREVER without timers. If
    this is not known, for example because no executor is waiting, or several, it is 0.
    """
    from rclpy.impl.implementation_singleton import rclpy_implementation

    waiting = 0

    class WaitSet(rclpy_implementation.WaitSet):
        def __init__(self, *sizes: object) -> None:
            super().__init__(*sizes)
            self._timers: list[Any] = []

        def add_timer(self, timer: Any) -> object:  # noqa: ANN401 - a timer of rclpy's C++ part
            self._timers.append(timer)
            return super().add_timer(timer)

        def wait(self, timeout_ns: int) -> None:
            nonlocal waiting
            waiting += 1
            try:
                left_ns = [timer.time_until_next_call() for timer in self._timers]
                least_ns = min((ns for ns in left_ns if ns is not None), default=FOREVER)  # None: cancelled
                pause[1] = least_ns if waiting == 1 else 0
                super().wait(timeout_ns)
            finally:
                waiting -= 1
                pause[1] = 0

    pause[0] = PAUSES
    rclpy_implementation.WaitSet = WaitSet


def _exit_without_waiting() -> None:
    """Skip the cleanup of the libraries at the end of the process if ROS has been shut down.

    During a normal exit, Fast DDS would sleep for 0.1 s, although nothing is left to clean up. The exit code is kept,
    and Python itself cleans up as usual.
    """
    import rclpy

    if not rclpy.ok():
        libc = ctypes.CDLL(None)
        libc.fflush(None)
        libc.on_exit(libc._exit, None)  # the last function that is registered is called first


def _without_us(kind: type[BaseException], error: BaseException, trace: types.TracebackType | None) -> None:
    """Print the traceback of the program without the stack frames of the launcher."""
    for each in _chain(error):
        each.__traceback__ = _frames_of_others(_after_run(each.__traceback__))
    sys.__excepthook__(kind, error, _frames_of_others(_after_run(trace)))


def _chain(error: BaseException | None) -> Iterator[BaseException]:
    """Yield the error and all of its causes."""
    observed: set[int] = set()
    waiting = [error]
    while waiting:
        each = waiting.pop()
        if each is not None and id(each) not in observed:
            observed.add(id(each))
            waiting += [each.__cause__, each.__context__]
            yield each


def _after_run(trace: types.TracebackType | None) -> types.TracebackType | None:
    """Return the part of the traceback that begins with `run`, or the whole traceback if `run` is not in it."""
    part = trace
    while part is not None and part.tb_frame.f_code is not run.__code__:
        part = part.tb_next
    return part or trace


def _frames_of_others(trace: types.TracebackType | None) -> types.TracebackType | None:
    while trace is not None and trace.tb_frame.f_code.co_filename == __file__:
        trace = trace.tb_next
    if trace is not None:
        trace.tb_next = _frames_of_others(trace.tb_next)
    return trace


def main() -> None:
    """Import rclpy, wait for the start command, and then run the node in this process.

    Without a cell, a node must not outlive a conductor that was killed: the node could drive the turtle of another
    trial.
    """
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
    sys.path.pop(0)
    run(import_ahead())


def run(waiting: list[Postponed]) -> None:
    """Wait for the start command, and then run the node in this process. `waiting` comes from `import_ahead`."""
    pause = (ctypes.c_int64 * 2)()
    os.write(1, b"\x00ready %d\n" % ctypes.addressof(pause))
    order = json.loads(sys.stdin.buffer.readline())
    with tarfile.open(fileobj=sys.stdin.buffer, mode="r|") as tree:
        # A malicious member can do no harm in a cell, and the Python of Debian 12 does not have extraction filters yet.
        tree.extraction_filter = lambda member, _path: member
        tree.extractall(order["install"])
    if order.get("params_file"):
        file = Path(order["install"]).parent / "params.yaml"
        file.write_text(order["params_file"], encoding="utf-8")
        order["ros_arguments"] += ["--ros-args", "--params-file", str(file)]
    # A node that reads from the keyboard reaches the end of the file.
    with Path(os.devnull).open("rb") as nothing:
        os.dup2(nothing.fileno(), 0)
    os.environ.update(order["env"])
    script = Path(order["script"])
    sys.path[:0] = [str(script.parent), *order["python_path"]]
    for path in order["python_path"]:
        sys.path_importer_cache.pop(path, None)
    importlib.invalidate_caches()
    sys.argv = [str(script)]
    # In the background (`grader grade ... &`), Ctrl-C is ignored, and every child process inherits that.
    signal.pthread_sigmask(signal.SIG_SETMASK, ())
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    # The node gets its own process group, so that Ctrl-C reaches it and its children as in a terminal.
    if os.getpgid(0) != os.getpid():
        os.setpgid(0, 0)
    source = script.read_bytes()
    if not (source.startswith(b"#!") and b"python" in source.split(b"\n", 1)[0]):
        # The node is not a Python script, so the arguments can only be passed on the command line.
        os.execv(script, [*sys.argv, *order["ros_arguments"]])
    deliver_before_destroying()
    if order["ros_arguments"]:
        _initialize_with(order["ros_arguments"])
    if _SIMULATED in order["ros_arguments"]:
        publish_pauses(pause)
    else:
        # In wall time, an import in the middle of a callback would delay the node.
        for each in waiting:
            each.load()
    sys.excepthook = _without_us
    atexit.register(_exit_without_waiting)
    module = types.ModuleType("__main__")
    module.__file__ = str(script)
    sys.modules["__main__"] = module
    exec(compile(source, str(script), "exec"), module.__dict__)


if __name__ == "__main__":
    main()

"""Run a program for `ros2 run`.

The program uses the same terminal as `ros2 run`. If `ros2 run` exits first, the program gets SIGTERM.
"""

from __future__ import annotations

import ctypes
import os
import signal
import subprocess
from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import FrameType

_SAYS = "[ros2run]:"
_PR_SET_PDEATHSIG = 1
_PASSED_ON = (signal.SIGTERM, signal.SIGHUP)


def run_child(command: Sequence[str]) -> int:
    """Run a program until the program exits.

    Return the exit code, which is negative if a signal terminated the program.

    The terminal sends Ctrl-C to the program directly. This function forwards SIGTERM and SIGHUP.

    Raises:
        Ros2Error: the program cannot be started.
    """
    library = ctypes.CDLL(None)
    ours = os.getpid()

    def prepare() -> None:
        for number in (signal.SIGINT, *_PASSED_ON):
            signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        library.prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
        if os.getppid() != ours:
            os._exit(1)

    # Block the signals until the program has started and can receive them.
    before = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, *_PASSED_ON))
    try:
        process = subprocess.Popen(command, preexec_fn=prepare)
    except (OSError, subprocess.SubprocessError) as error:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
        message = (
            f"{command[0]} could not be started: {getattr(error, 'strerror', error)}. Is the interpreter "
            "in the first line of the file installed?"
        )
        raise Ros2Error(message) from error

    def pass_on(number: int, _: FrameType | None) -> None:
        process.send_signal(number)

    if signal.SIGINT in signal.sigpending():  # Ctrl-C may have been pressed before the program was started
        process.send_signal(signal.SIGINT)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for number in _PASSED_ON:
        signal.signal(number, pass_on)
    signal.pthread_sigmask(signal.SIG_SETMASK, before)
    code = process.wait()
    if code < 0:
        print(_SAYS, signal.strsignal(-code), flush=True)
    elif code:
        print(_SAYS, f"Process exited with failure {code}", flush=True)
    return code

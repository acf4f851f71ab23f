"""Why a set-up stopped, in one sentence with what to do: by an error of ours, or by what an installer printed.

Like machine.py, this runs under any Python 3 before anything is installed: syntax of Python 3.6.
"""

import errno
import os
import re
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Callable, List, Optional

from grader.common.refusal import refusal, sentence

MACHINE_BROKEN = 3
NEEDED_MB = 700
"""What .venv takes for a learner, with room for the rest."""
AGAIN = "the same command goes on from here, and what was downloaded is kept"
NO_NETWORK = (
    "This machine does not reach the packages of Python ({}). Is it online? A proxy is read from HTTPS_PROXY, a mirror "
    "from pip's own configuration; " + AGAIN + "."
)
_FULL_MB = 50
"""With less than that, whatever failed could not have succeeded."""
_NUMBER = re.compile(r"\[Errno (\d+)\]|\(os error (\d+)\)")
_OFFLINE = re.compile(
    "(?:Temporary failure in )?name resolution|Name or service not known|No address associated with hostname|"
    "Network is unreachable|No route to host|failed to lookup address",
    re.IGNORECASE,
)
_WRITE = frozenset({errno.EACCES, errno.EPERM, errno.EROFS})


def guarded(main: Callable[[], int]) -> int:
    """Run a program of the set-up; what the system refuses, and Ctrl-C, is a sentence. Returns the exit code."""
    try:
        code = main()
        sys.stdout.flush()
    except KeyboardInterrupt:
        print("\nStopped. The same command goes on from here: what was downloaded is kept.", file=sys.stderr)
        return 130
    except BrokenPipeError:
        _silence()  # Whoever read us has gone.
        return 1
    except Exception as error:
        if os.environ.get("GRADER_DEBUG"):
            raise
        fault = f"A fault of the set-up itself: {type(error).__name__}: {error}. GRADER_DEBUG=1 before it shows where."
        print(of_error(error) or fault, file=sys.stderr)
        _silence()
        return MACHINE_BROKEN
    return code


def _silence() -> None:
    """Keep the interpreter from failing once more at its end, when it empties its buffers."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


def of_error(error: BaseException) -> Optional[str]:
    """The sentence for an error that the system has raised in the set-up; None for any other error."""
    if isinstance(error, OSError) and isinstance(error.filename, (str, bytes)):
        return _of_number(error.errno or 0, Path(os.fsdecode(error.filename)))
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        return _of_number(error.errno, None)
    return refusal(error)


def of_output(said: str, folder: Path) -> Optional[str]:
    """The sentence for what stopped an installer, which printed `said` and fills `folder`; None if it is not known."""
    found = _NUMBER.search(said)
    number = int(found.group(1) or found.group(2)) if found else 0
    if number in (errno.ENOSPC, errno.EDQUOT) or _fullest([folder]):
        return _of_number(errno.ENOSPC, _fullest([folder, Path(tempfile.gettempdir()), cache()]) or folder)
    if number in _WRITE or number in (errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.EAGAIN):
        return _of_number(number, folder)
    return None


def offline(said: str) -> Optional[str]:
    """What shows that there is no network in what an installer printed; None where nothing does."""
    found = _OFFLINE.search(said)
    return found.group() if found else None


def cache() -> Path:
    """Where uv keeps what it has downloaded."""
    named = os.environ.get("UV_CACHE_DIR") or "{}/uv".format(os.environ.get("XDG_CACHE_HOME") or "~/.cache")
    return Path(named).expanduser()


def _of_number(number: int, where: Optional[Path]) -> str:
    if number in (errno.ENOSPC, errno.EDQUOT):
        room = f"free some space there ({NEEDED_MB} MB for a learner); {AGAIN}"
        return sentence(number, str(where or ""), room)
    if number in _WRITE:
        told = f"{where} cannot be written to ({os.strerror(number)})"
        return (
            f"{told}: copy the folder of the course to where you may write, such as your home, and type the same there."
        )
    return sentence(number, str(where or ""))


def _fullest(folders: List[Path]) -> Optional[Path]:
    """The first of the folders on whose disk there is next to no room."""
    for folder in folders:
        there = next((above for above in [folder, *folder.parents] if above.exists()), None)
        if there and shutil.disk_usage(str(there)).free < _FULL_MB * 2**20:
            return folder
    return None

"""Messages that explain why a set-up stopped and what to do, from an error or an installer's output.

Like machine.py, this module runs under any Python from 3.6 on, before anything is installed, so it uses only the syntax
of Python 3.6.
"""

import errno
import os
import re
import shlex
import shutil
import signal
import sys
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import Callable, List, NoReturn, Optional

from grader.common.system_errors import refusal, sentence
from grader.common.terminal_text import say

ROOT = Path(__file__).resolve().parents[2]
MACHINE_BROKEN = 3
NEEDED_MB = 700
"""The disk space for a learner's .venv (MB), including a reserve."""
AGAIN = "the same command continues from here, and the downloads are kept"
NO_NETWORK = (
    "This machine cannot reach the Python packages ({}). Is it online? HTTPS_PROXY sets a proxy, and pip's "
    "configuration sets a mirror; " + AGAIN + "."
)
_FULL_MB = 50
"""If less disk space than this is free (MB), the disk is considered the reason for any failure."""
_NUMBER = re.compile(r"\[Errno (\d+)\]|\(os error (\d+)\)")
_OFFLINE = re.compile(
    "(?:Temporary failure in )?name resolution|Name or service not known|No address associated with hostname|"
    "Network is unreachable|No route to host|Connection refused|failed to lookup address",
    re.IGNORECASE,
)
_NO_LINK = re.compile(r"\[Errno (?:1|30|38|95)\] [^\n]*'lib' -> '")
"""Matches the error message of venv on a file system without symbolic links. In a folder that VirtualBox shares, the
message is that the file system is read-only."""
_CERTIFICATE = re.compile("certificate (?:(?:is )?not (?:yet valid|valid yet)|(?:has )?expired)")
_UNTRUSTED = re.compile(
    "certificate verify failed: (self[- ]signed certificate|unable to get local issuer certificate)"
)
"""Matches pip's error message for a certificate whose issuer is unknown. The messages of uv do not match, since pip may
succeed after uv has failed."""
_INDEXES = re.compile(r"^Looking in indexes: (.+)$", re.MULTILINE)
_WRITE = frozenset({errno.EACCES, errno.EPERM, errno.EROFS})


def run_and_exit(main: Callable[[], int]) -> NoReturn:
    """Run a program of the set-up like guarded(), and exit with its exit code."""
    code = guarded(main)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # while Python exits, Ctrl-C would only print a traceback
    sys.exit(code)


def guarded(main: Callable[[], int]) -> int:
    """Run a program of the set-up and return its exit code. Report exceptions and Ctrl-C in one message.

    With GRADER_DEBUG, exceptions are raised instead.
    """
    try:
        code = main()
        sys.stdout.flush()
    except KeyboardInterrupt:
        say("\nStopped. The same command continues from here; the downloads are kept.")
        return 130
    except BrokenPipeError:
        _silence()  # the reader of the output has exited
        return 1
    except Exception as error:
        if os.environ.get("GRADER_DEBUG"):
            raise
        fault = f"An error in the set-up itself: {type(error).__name__}: {error}. GRADER_DEBUG=1 prints the traceback."
        say(of_error(error) or fault)
        _silence()
        return MACHINE_BROKEN
    return code


def _silence() -> None:
    """Keep the interpreter from failing again when it exits and flushes its buffers."""
    with suppress(OSError):  # opening a file may be impossible
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


def of_error(error: BaseException) -> Optional[str]:
    """Return the message for a system error in the set-up, or None for other errors."""
    if isinstance(error, OSError) and isinstance(error.filename, (str, bytes)):
        return _of_number(error.errno or 0, Path(os.fsdecode(error.filename)))
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        return _of_number(error.errno, None)
    return refusal(error)


def of_output(said: str, folder: Path) -> Optional[str]:
    """Return the reason why an installer failed, or None.

    `said` is the installer's output, and `folder` is the folder that the installer writes to.
    """
    found = _NUMBER.search(said)
    number = int(found.group(1) or found.group(2)) if found else 0
    if number in (errno.ENOSPC, errno.EDQUOT) or _fullest([folder]):
        return _of_number(errno.ENOSPC, _fullest([folder, Path(tempfile.gettempdir()), cache()]) or folder)
    if _NO_LINK.search(said):
        return (
            f"The file system of {folder} does not support symbolic links, which Python needs there. This is common on "
            "USB sticks and in folders that a virtual machine shares. Copy the course's folder to another file system, "
            "such as your home, and type the same command there."
        )
    if number in _WRITE or number in (errno.EMFILE, errno.ENFILE, errno.ENOMEM, errno.EAGAIN):
        return _of_number(number, folder)
    if _CERTIFICATE.search(said):
        now = time.strftime("%Y-%m-%d %H:%M")
        return (
            f"A certificate of the package index is not valid at {now}, the time of this machine's clock. If this time "
            f"is wrong, set the clock; {AGAIN}."
        )
    untrusted = _UNTRUSTED.search(said)
    if untrusted:
        return (
            f"This machine does not trust the certificate of the package index ({untrusted.group(1)}). The networks of "
            "many schools and companies replace certificates with their own. Ask the network's administrators for the "
            "file of their certificate, and set PIP_CERT and SSL_CERT_FILE to its path, or add it to the system's "
            f"certificates; {AGAIN}."
        )
    return None


def offline(said: str) -> Optional[str]:
    """Return the part of an installer's output that shows that there is no network, or None."""
    found = _OFFLINE.search(said)
    return found.group() if found else None


def configured_indexes(said: str) -> str:
    """Return a sentence with the configured package indexes that pip printed, or an empty string."""
    found = _INDEXES.search(said)
    return f" pip is configured to use {found.group(1)} (`pip config list`)." if found else ""


def cache() -> Path:
    """Return uv's download cache folder."""
    named = os.environ.get("UV_CACHE_DIR") or "{}/uv".format(os.environ.get("XDG_CACHE_HOME") or "~/.cache")
    return Path(named).expanduser()


def _of_number(number: int, where: Optional[Path]) -> str:
    if number in (errno.ENOSPC, errno.EDQUOT):
        room = f"free some space there ({NEEDED_MB} MB for a learner); {AGAIN}"
        return sentence(number, str(where or ""), room)
    if number in _WRITE:
        reported = f"{where} cannot be written to ({os.strerror(number)})"
        if where and _is_roots_in_my_course(where):
            again = f"sudo chown -R {os.getuid()}:{os.getgid()} {shlex.quote(str(ROOT))}"
            return f"{reported}: it belongs to root, as after `sudo make`. Type {again} and try again, without sudo."
        return f"{reported}: copy the course's folder to a writable folder, such as your home, and try again there."
    return sentence(number, str(where or ""))


def nearest(path: Path) -> Path:
    """Return the path, or the nearest folder above it that exists and that this user can see."""
    # Path.exists raises PermissionError below a folder of another user.
    return next(above for above in [path, *path.parents] if os.path.exists(str(above)))  # noqa: PTH110


def _is_roots_in_my_course(where: Path) -> bool:
    """Return whether root created this file or folder in a course folder that belongs to this user."""
    there = nearest(where)
    return os.getuid() != 0 and there.stat().st_uid == 0 and ROOT.stat().st_uid == os.getuid() and ROOT in there.parents


def _fullest(folders: List[Path]) -> Optional[Path]:
    """Return the first of the folders whose disk is nearly full, or None."""
    for folder in folders:
        if shutil.disk_usage(str(nearest(folder))).free < _FULL_MB * 2**20:
            return folder
    return None

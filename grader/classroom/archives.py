"""An archive as a student handed it in, unpacked for a moment: unpack.py does it, here are its limits."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common.interpreter import interpreter
from grader.errors import DiskError

if TYPE_CHECKING:
    from collections.abc import Iterator

ENDINGS = (".zip", ".tar.gz", ".tgz", ".tar")
OTHER_ENDINGS = (".7z", ".rar", ".tar.xz", ".tar.bz2", ".tar.zst", ".gz", ".xz", ".bz2")
"""What students hand in as well, and what is not unpacked."""
MOST_PACKED = 100 * 1024 * 1024
_SCRIPT = Path(__file__).with_name("unpack.py")
_MIB = 1024 * 1024
_CPU_S = 20
_TIMEOUT_S = 120.0
_LIMITS = ("prlimit", f"--cpu={_CPU_S}", f"--as={1024 * _MIB}", f"--fsize={128 * _MIB}", "--core=0", "--")


class NotUnpackedError(Exception):
    """Why the archive cannot be unpacked: the student's doing, a part of a sentence that begins with its name."""


def stem(name: str) -> str | None:
    """The name of an archive without its ending; None for what is none."""
    ending = next((each for each in (*ENDINGS, *OTHER_ENDINGS) if name.lower().endswith(each)), None)
    return name[: -len(ending)] or None if ending else None


@contextmanager
def unpacked(archive: Path) -> Iterator[Path]:
    """A folder with what is in the archive, gone afterwards.

    Raises:
        NotUnpackedError: it cannot be unpacked, or would take more than a submission may.
        DiskError: the disk failed that it is unpacked on.
    """
    if not archive.name.lower().endswith(ENDINGS):
        message = "is no archive that is unpacked here: hand in a .zip or a .tar.gz"
        raise NotUnpackedError(message)
    if not os.access(archive, os.R_OK):
        message = "may not be read (its permissions forbid it)"
        raise NotUnpackedError(message)
    if archive.stat().st_size > MOST_PACKED:
        message = f"has more than {MOST_PACKED // _MIB} MiB"
        raise NotUnpackedError(message)
    with tempfile.TemporaryDirectory(prefix="grader-unpacked-") as folder:
        # Its own process: what is made to take for ever, or all memory, takes this one only.
        start = interpreter("-S", str(_SCRIPT), str(archive.absolute()), folder)
        try:
            done = subprocess.run(
                [*_LIMITS, *start.argv],
                env=start.env,
                stdin=subprocess.DEVNULL,
                capture_output=True,
                timeout=_TIMEOUT_S,
                check=False,
            )
        except subprocess.TimeoutExpired:
            done = None
        why = _why(done)
        if why is not None:
            raise NotUnpackedError(why)
        yield Path(folder)


def _why(done: subprocess.CompletedProcess[bytes] | None) -> str | None:
    if done is None or done.returncode < 0 or not done.stdout.endswith(b"\n"):
        return f"could not be unpacked within {_CPU_S} s and 1 GiB of memory"
    said: str | None = json.loads(done.stdout)["why"]
    if done.returncode != 0:
        message = f"A submission could not be unpacked: {said}. Make room in {tempfile.gettempdir()} and try again."
        raise DiskError(message)
    return said

"""Unpack a student's archive into a temporary folder.

The script unpack.py unpacks the archive, and this module limits the resources of the script.
"""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
from contextlib import contextmanager
from pathlib import Path
from typing import IO, TYPE_CHECKING

from grader.common.interpreter import interpreter
from grader.errors import DiskError
from grader.submission import tree

if TYPE_CHECKING:
    from collections.abc import Iterator

ENDINGS = (".zip", ".tar.gz", ".tgz", ".tar")
OTHER_ENDINGS = (".7z", ".rar", ".tar.xz", ".tar.bz2", ".tar.zst", ".gz", ".xz", ".bz2")
"""Archive formats that are not supported, although students hand them in."""
MOST_PACKED = 100 * 1024 * 1024
_SCRIPT = Path(__file__).with_name("unpack.py")
_MIB = 1024 * 1024
_CPU_S = 20
_TIMEOUT_S = 120.0
_LIMITS = ("prlimit", f"--cpu={_CPU_S}", f"--as={1024 * _MIB}", f"--fsize={128 * _MIB}", "--core=0", "--")


class NotUnpackedError(Exception):
    """The student's archive cannot be unpacked.

    The message completes a sentence that begins with the name of the archive.
    """


def stem(name: str) -> str | None:
    """Return the name of an archive without its extension, or None if the file is not an archive."""
    ending = next((each for each in (*ENDINGS, *OTHER_ENDINGS) if name.lower().endswith(each)), None)
    return name[: -len(ending)] or None if ending else None


@contextmanager
def unpacked(archive: Path) -> Iterator[Path]:
    """Yield a temporary folder with the content of the archive.

    The absolute path of the archive must not contain a link.

    Raises:
        NotUnpackedError: the archive cannot be unpacked, or is larger than a submission may be.
        DiskError: the disk for temporary files failed.
    """
    if not archive.name.lower().endswith(ENDINGS):
        message = "is not a supported archive: hand in a .zip or a .tar.gz"
        raise NotUnpackedError(message)
    with tempfile.TemporaryDirectory(prefix="grader-unpacked-") as named:
        folder = os.path.realpath(named)
        with _open(archive) as file:
            done = _run(file, folder)
        why = _why(done)
        if why is not None:
            raise NotUnpackedError(why)
        yield Path(folder)


def _open(archive: Path) -> IO[bytes]:
    try:
        file = tree.open_file(archive, at=archive)
    except OSError as error:
        raise NotUnpackedError(tree.reason(error, archive.name)) from error
    if os.fstat(file.fileno()).st_size <= MOST_PACKED:
        return file
    file.close()
    message = f"is larger than {MOST_PACKED // _MIB} MiB"
    raise NotUnpackedError(message)


def _run(archive: IO[bytes], folder: str) -> subprocess.CompletedProcess[bytes] | None:
    """Run the script in a separate process, which alone is stopped if an archive takes too much time or memory."""
    start = interpreter("-S", str(_SCRIPT), "/dev/stdin", folder)
    try:
        return subprocess.run(
            [*_LIMITS, *start.argv], env=start.env, stdin=archive, capture_output=True, timeout=_TIMEOUT_S, check=False
        )
    except subprocess.TimeoutExpired:
        return None


def _why(done: subprocess.CompletedProcess[bytes] | None) -> str | None:
    if done is None or done.returncode < 0 or not done.stdout.endswith(b"\n"):
        return f"could not be unpacked within {_CPU_S} s and 1 GiB of memory"
    answer: str | None = json.loads(done.stdout)["why"]
    if done.returncode != 0:
        message = (
            f"A submission could not be unpacked: {answer}. Free some space in {tempfile.gettempdir()} and try again."
        )
        raise DiskError(message)
    return answer

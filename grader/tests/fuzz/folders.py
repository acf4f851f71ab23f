"""Folders and archives with unusual names, file types and modes."""

from __future__ import annotations

import os
import zipfile
from io import BytesIO
from typing import TYPE_CHECKING

from grader.tests.checks.made import FILES

if TYPE_CHECKING:
    from pathlib import Path

    from grader.tests.fuzz.choices import Choices

NAMES = (
    *(b"package.xml", b"setup.py", b"setup.cfg", b"my_robot_controller", b"__init__.py", b"answers.toml", b"exercises"),
    *(b"build", b"install", b".git", b"COLCON_IGNORE", b"03-circle-publisher", b"04-package-files", b"resource"),
    *(b"Package.XML", b"m\xfcller", b"a\nb", b"\x1b[31m", b"-", b"~", b" ", b"nul\x7f", "é".encode(), b"\xed\xa0\x80"),
    *(b"n" * 255, b"a.zip", b"a.tar.gz", b"a.rar", b"roster.csv", b"draw_circle.py", b"src", b"test", b"__pycache__"),
)
MODES = (0o755, 0o644, 0, 0o111, 0o444, 0o7777)
MOST = 40
"""The number of entries in an invented folder."""


def fill(folder: Path, choices: Choices) -> None:
    """Fill the folder with files, folders, links and pipes, with any names and modes."""
    at = [os.fsencode(folder)]
    for _ in range(MOST):
        if not choices:
            break
        name = choices.one_of(NAMES) if choices.below(4) else choices.take(1 + choices.below(255))
        place = choices.one_of(at) + b"/" + name.replace(b"/", b"_").replace(b"\0", b"_")
        try:
            _make(place, choices, at)
        except OSError:
            continue  # the name exists already, is too long, or is "."


def _make(place: bytes, choices: Choices, folders: list[bytes]) -> None:
    kind = choices.below(8)
    if kind < 3:
        os.mkdir(place)  # noqa: PTH102 - pathlib knows no bytes
        folders.append(place)
    elif kind == 3:
        os.symlink(choices.one_of((b"..", b".", place, b"/etc", b"package.xml", b"no")), place)  # noqa: PTH211
    elif kind == 4:
        os.mkfifo(place)
    elif os.path.lexists(place):
        # ".." and links lead out of the folder, to /tmp and /etc, where the permissions depend on the machine.
        if os.path.basename(place) not in (b".", b"..") and not os.path.islink(place):  # noqa: PTH114, PTH119
            os.chmod(place, choices.one_of(MODES))  # noqa: PTH101
    else:
        known = FILES.get(os.path.basename(os.fsdecode(place)), "")  # noqa: PTH119
        with open(place, "xb") as file:  # noqa: PTH123
            file.write(known.encode() if choices.below(4) else choices.take(choices.below(512)))


def archive(choices: Choices) -> bytes:
    """Return a zip archive with unusual members and with some bytes changed."""
    packed = BytesIO()
    with zipfile.ZipFile(packed, "w") as file:
        for _ in range(choices.below(6)):
            info = zipfile.ZipInfo(choices.one_of(NAMES).decode("latin-1") + choices.one_of(("", "/", "/x", "/../y")))
            info.compress_type = choices.one_of((0, 8, 12, 14))
            info.external_attr = choices.below(65536) << 16
            file.writestr(info, choices.take(choices.below(200)))
    data = bytearray(packed.getvalue())
    while choices:
        data[choices.below(65536) % len(data)] = choices.below(256)
    return bytes(data)

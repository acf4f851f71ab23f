"""Run `colcon build` on a submission, usually in a cell, and read the result without executing it.

The source enters the cell as a tar stream, and the install tree leaves the cell as another tar stream. Because of these
streams, a build in a cell does not touch the disk of this machine, and the install tree can later be passed to the cell
of the trial.
"""

from __future__ import annotations

import io
import tarfile
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from grader.colcon.build import Build
from grader.common.interpreter import interpreter
from grader.common.temporary_folder import temporary_folder
from grader.errors import MachineError, TooLargeError
from grader.ros import installation
from grader.sandbox import bubblewrap, process
from grader.sandbox.control_group import control_group
from grader.sandbox.limits import Limits, limited
from grader.sandbox.system_calls import call_filter
from grader.sandbox.tar_stream import Member, read_tar
from grader.sandbox.user import cell_user
from grader.submission.reader import read

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from grader.submission.package import Submission

MIB = 1024 * 1024
_HERE = Path(__file__).absolute()
IN_CELL = _HERE.with_name("in_cell.py")
"""The script that runs colcon."""
IMPORTED = (
    _HERE.with_name("entry_points_cache.py"),
    _HERE.with_name("setup_commands.py"),
    _HERE.parents[1] / "common" / "quick_exit.py",
)
"""The files of the grader that the script imports."""
LIMITS = Limits(processes=200, cpu_s=60)
TIMEOUT_S = 60.0
MOST_LOG = 256 * 1024
MOST_TREE = 64 * MIB
MOST_FILES = 20_000
MOST_ENTRY_POINTS = 100 * 1024
"""The maximum size of entry_points.txt (bytes)."""

# Standard output contains only the install tree: colcon and its processes write to standard error. With
# --base-paths, colcon searches only src for packages. The executor is sequential because there is only one
# package and starting workers takes time. The install tree has no compiled modules, so that a node always runs
# the source that is judged.
_SCRIPT = r"""
echo cell-is-ready >&2
cd "$WS" && mkdir -p src || exit 90
"$@" build --base-paths src \
    --executor sequential --event-handlers console_direct+ console_stderr- >&2
code=$?
[ -d install ] && tar -c --format=gnu --exclude=__pycache__ -f - -C install .
exit $code
"""
# Before the first byte of the submission is read, the script and in_cell.py report whether the machine can build.
_CELL, _READY = b"cell-is-ready\n", b"cell-is-ready\ncolcon-is-ready\n"
_LIMITS_HIT = {
    "disk": (b"No space left on device", b"File too large", b"Disk quota exceeded"),
    "processes": (b"Resource temporarily unavailable", b"can't start new thread"),
    "memory": (b"MemoryError", b"Cannot allocate memory"),
}


@dataclass(frozen=True)
class Built:
    """A Build with its install tree (a tar stream)."""

    build: Build
    tree: bytes


def build(submission: Submission, ros: installation.Ros, *, in_cell: bool, tell: Callable[[str], None]) -> Built:
    """Build the submission's package with this ROS 2. `tell` is called with a short message about the build.

    Raises:
        MachineError: the sandbox or colcon itself does not work.
        UnreadableError: the result of the build cannot be read.
    """
    tell("Building with colcon")
    with _workspace(in_cell=in_cell) as (workspace, home):
        env = installation.environment(ros, home=home)
        env["WS"] = str(workspace)
        colcon = interpreter(str(IN_CELL), python=str(ros.python), env=env, searches=True)
        argv = ["sh", "-c", _SCRIPT, "sh", *colcon.argv]
        if in_cell:
            view = bubblewrap.ros_view(ros, IN_CELL, *IMPORTED)
            with call_filter() as filter_fd, control_group(LIMITS) as group, cell_user() as user:
                command = bubblewrap.lone_cell(argv, view, env=env, limits=LIMITS, user=user, filter_fd=filter_fd)
                done = _run(group.joined(command), env, submission, () if filter_fd is None else (filter_fd,))
                if group.out_of_memory():
                    done = replace(done, out_of="memory")
        else:
            done = _run(limited(argv, LIMITS), env, submission, ())
    return _read(done)


def _run(
    command: list[str], env: dict[str, str], submission: Submission, pass_fds: tuple[int, ...]
) -> process.Finished:
    return process.run(
        command,
        stdin=_pack(submission),
        env=env,
        timeout_s=TIMEOUT_S,
        most_stdout=MOST_TREE,
        most_stderr=MOST_LOG,
        pass_fds=pass_fds,
        watch=LIMITS,
    )


@contextmanager
def _workspace(*, in_cell: bool) -> Iterator[tuple[Path, Path]]:
    if in_cell:
        yield bubblewrap.WORKSPACE, bubblewrap.HOME
        return
    with temporary_folder() as folder:
        (folder / "home").mkdir()
        yield folder, folder / "home"


def _pack(submission: Submission) -> bytes:
    """Return the submission as a tar stream with one top-level folder. The same files always give the same bytes."""
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w|", format=tarfile.PAX_FORMAT) as tar:
        for path, content in submission.files.items():
            member = tarfile.TarInfo(f"{submission.package_dir.name}/{path}")
            member.size = len(content)
            member.mode = 0o755 if path in submission.executable else 0o644
            tar.addfile(member, io.BytesIO(content))
    return stream.getvalue()


def _read(done: process.Finished) -> Built:
    if not done.stderr.startswith(_READY):
        errors = done.stderr.removeprefix(_CELL).decode("utf-8", "replace").strip()
        if "No module named 'colcon_core'" in errors:
            message = "colcon is not installed in this Python: `make demo` in the course's folder installs it."
        else:
            why = errors.splitlines()[-1].rstrip(".") if errors else "no message"
            message = f"The build could not be started: {why}. Check this machine with `grader doctor`."
        raise MachineError(message)
    built, cut = read(_described, done)
    return Built(built, b"" if cut else done.stdout)


def _described(done: process.Finished) -> tuple[Build, bool]:
    """Return the result of the build, and whether its install tree must be discarded."""
    lines = done.stderr[len(_READY) :].decode("utf-8", "replace").splitlines(keepends=True)
    # colcon warns that the prefix of the wheels is not a colcon install tree. The warning is unrelated to the
    # submission.
    log = "".join(line for line in lines if "colcon_ros.prefix_path.ament" not in line)
    out_of = next((name for name, signs in _LIMITS_HIT.items() if any(sign in done.stderr for sign in signs)), None)
    cut = done.timed_out or done.too_much or done.out_of is not None
    files = {} if cut else read_tar(done.stdout, MOST_FILES)
    if len(files) == MOST_FILES:
        cut, files, out_of = True, {}, "files"
    package = next((path.parts[0] for path in files if len(path.parts) > 1), None)
    inside = {path.relative_to(package): member for path, member in files.items() if path.parts[0] == package}
    build = Build(
        exit_code=done.exit_code,
        log=log,
        package=package,
        timed_out=done.timed_out,
        out_of=done.out_of or ("disk" if done.too_much else out_of),
        installed=tuple(sorted(map(str, inside))),
        executables=tuple(sorted(p.name for p in inside if p.parts[:-1] == ("lib", package))),
        entry_points=_entry_points(inside, done.stdout),
        seconds=done.seconds,
    )
    return build, cut


def _entry_points(files: dict[PurePosixPath, Member], tree: bytes) -> dict[str, str]:
    """Return the installed console_scripts."""
    for path, member in files.items():
        if path.name != "entry_points.txt" or not path.parent.name.endswith(("egg-info", "dist-info")):
            continue
        if member.size > MOST_ENTRY_POINTS:
            message = f"entry_points.txt is too large to be read: more than {MOST_ENTRY_POINTS // 1024} KiB"
            raise TooLargeError(message)
        return read_entry_points(member.content(tree).decode("utf-8", "replace"))
    return {}


def read_entry_points(text: str) -> dict[str, str]:
    """Return the console_scripts in the text of an entry_points.txt.

    This function reads the text in a single pass. The regular expressions of configparser take quadratic time.
    """
    found: dict[str, str] = {}
    section = ""
    for line in map(str.strip, text.splitlines()):
        name, equals, value = line.partition("=")
        if line.startswith("[") and line.endswith("]"):
            section = line[1:-1].strip()
        elif section == "console_scripts" and equals and not line.startswith(("#", ";")):
            found[name.strip()] = value.strip()
    return found

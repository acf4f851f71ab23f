"""The underlay: our turtlesim package for a ROS 2 that has no turtlesim. The underlay is built once and then kept."""

from __future__ import annotations

import errno
import fcntl
import hashlib
import os
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common import package_managers, xdg
from grader.common.how_ended import how_ended
from grader.common.interpreter import interpreter
from grader.common.noexec import noexec_folder, noexec_sentence
from grader.common.readable_by_all import make_readable
from grader.errors import MachineError
from grader.ros import installation

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

SOURCES = Path(__file__).parents[1] / "turtlesim/package"
_TEMPORARY = ".building-"
_LOG_LINES = 15
_FULL = 1 << 20
"""If fewer bytes than this are free after a build has failed, the reason is assumed to be a full disk. CMake and
compilers do not always report a full disk."""


def _report_nothing(_: str) -> None:
    """Discard a progress message."""


def with_turtlesim(ros: installation.Ros, tell: Callable[[str], None] = _report_nothing) -> installation.Ros:
    """Return this ROS 2 with the turtlesim interfaces added. Build the interfaces first if necessary (see `ensure`).

    Raises:
        MachineError: the interfaces could not be built.
    """
    return replace(ros, underlay=ensure(ros, tell))


def ensure(ros: installation.Ros, tell: Callable[[str], None] = _report_nothing) -> Path | None:
    """Return the prefix of our turtlesim, or None if this ROS 2 has its own turtlesim.

    Build our turtlesim first if necessary.

    A build takes about ten seconds and passes messages about its progress to `tell`. If a build exists already, this
    function takes about a millisecond.

    Raises:
        MachineError: a build tool is missing, the build failed, or the cache cannot be written or is mounted noexec.
    """
    if installation.has_turtlesim(ros):
        return None
    _require_loadable(xdg.cache())
    search = installation.environment(ros, home=Path("/"))["PATH"]
    prefix = xdg.cache() / _name(ros, _compiler(search))
    if prefix.is_dir():
        return prefix
    kept = _built_by_another_compiler(ros) if _compiler(search) is None else None
    if kept is not None:
        return kept
    _require_tools(search)
    try:
        with _one_at_a_time(tell):
            if not prefix.is_dir():
                _build(ros, prefix, tell)
    except OSError as error:
        message = (
            f"The turtlesim interfaces could not be built in {xdg.cache()}: {error.strerror or error}. The folder must "
            "be writable and have 20 MB free; set XDG_CACHE_HOME to use another folder."
        )
        raise MachineError(message) from error
    return prefix


def _name(ros: installation.Ros, compiler: Path | None) -> str:
    """Return a name for the build.

    The name depends on the ROS 2, the Python, the sources and the C++ compiler. The compiler is not run.
    """
    return f"turtlesim-{_key_of_sources(ros)}-{_key_of_compiler(compiler)}"


def _key_of_sources(ros: installation.Ros) -> str:
    key = hashlib.sha256()
    abi = sysconfig.get_config_var("SOABI")
    for part in (ros.kind, ros.version, ros.prefix, ros.python, sys.version, abi):
        key.update(f"{part}\n".encode())
    for path in sorted(path for path in SOURCES.rglob("*") if path.is_file()):
        key.update(f"{path.relative_to(SOURCES)}\n".encode())
        key.update(path.read_bytes())
    return key.hexdigest()[:16]


def _key_of_compiler(compiler: Path | None) -> str:
    # Running the compiler to get its version would take too long. A new compiler has a different
    # modification time or size.
    if compiler is None:
        return "none"
    binary = compiler.resolve()
    stat = binary.stat()
    return hashlib.sha256(f"{binary}\n{stat.st_mtime_ns}\n{stat.st_size}".encode()).hexdigest()[:8]


def _compiler(search: str) -> Path | None:
    found = shutil.which("c++", path=search)
    return Path(found) if found else None


def _built_by_another_compiler(ros: installation.Ros) -> Path | None:
    """Return the newest finished build of these sources by any compiler, or None.

    Such a build can be used even if its compiler has been removed.
    """
    builds = xdg.cache().glob(f"turtlesim-{_key_of_sources(ros)}-*")
    return max(builds, key=lambda build: build.stat().st_mtime, default=None)


def _require_tools(search: str) -> None:
    python_headers = Path(sysconfig.get_path("include"), "Python.h")
    dev = f"python{sys.version_info.major}.{sys.version_info.minor}-dev"
    checks = [
        (shutil.which("c++", path=search), package_managers.Need("a C++ compiler", "g++")),
        (shutil.which("cc", path=search), package_managers.Need("a C compiler", "gcc")),
        (shutil.which("cmake", path=search), package_managers.Need("cmake", "cmake")),
        (
            shutil.which("ninja", path=search) or shutil.which("make", path=search),
            package_managers.Need("make", "make"),
        ),
        (python_headers.is_file(), package_managers.Need("Python's headers (Python.h)", dev)),
    ]
    missing = [need for found, need in checks if not found]
    if missing:
        manager = package_managers.find_manager(search)
        message = (
            f"The turtlesim interfaces must be built once, but this machine lacks {_listed(missing)}. "
            f"Install what is missing with {package_managers.command(manager, missing, root=os.geteuid() == 0)}"
        )
        raise MachineError(message)


def _require_loadable(cache: Path) -> None:
    mounted = noexec_folder(cache)
    if mounted:
        raise MachineError(noexec_sentence(mounted, "set XDG_CACHE_HOME to a folder on another file system"))


def _listed(needs: list[package_managers.Need]) -> str:
    *most, last = [need.what for need in needs]
    return f"{', '.join(most)} and {last}" if most else last


@contextmanager
def _one_at_a_time(tell: Callable[[str], None]) -> Iterator[None]:
    """Hold the lock that a process needs to build turtlesim. If another process holds the lock, wait for it first.

    The kernel releases the lock when the process that holds it exits.
    """
    xdg.cache().mkdir(parents=True, exist_ok=True)
    with (xdg.cache() / "turtlesim.lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            tell("Waiting for another process, which is building the turtlesim interfaces")
            fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def _build(ros: installation.Ros, prefix: Path, tell: Callable[[str], None]) -> None:
    # These folders are left over from builds that were killed, since only the process that holds the lock builds.
    for leftover in prefix.parent.glob(f"{_TEMPORARY}*"):
        shutil.rmtree(leftover, ignore_errors=True)
    tell("Building the turtlesim interfaces, once; this can take a minute")
    with tempfile.TemporaryDirectory(prefix=_TEMPORARY, dir=_place_to_build(prefix.parent)) as name:
        folder = Path(name)
        env = installation.environment(ros, home=folder)
        staged = Path(f"{folder}/staged{prefix}")
        no_trace = shlex.quote(f"{folder}=turtlesim")
        configure = [
            *("cmake", "-S", str(SOURCES), "-B", str(folder / "build")),
            *("-G", "Ninja" if shutil.which("ninja", path=env["PATH"]) else "Unix Makefiles"),
            # Without optimization, the build takes half as long, but each message takes a few microseconds longer.
            *("-DCMAKE_BUILD_TYPE=None", "-DBUILD_TESTING=OFF"),
            # If a source is dated in the future, because the clock was set back, ninja configures again and again.
            "-DCMAKE_SUPPRESS_REGENERATION=ON",
            f"-DPython3_EXECUTABLE={ros.python}",
            f"-DCMAKE_INSTALL_PREFIX={prefix}",
            # ament would find this folder with a Python program that contains the prefix between apostrophes.
            f"-DPYTHON_INSTALL_DIR={installation.PYTHON_LIB}",
            # Keep the path of the temporary folder out of the build. A shell parses the flags, and the path may contain
            # spaces. CMake would strip quotes around the whole value.
            *(f"-DCMAKE_{language}_FLAGS=-ffile-prefix-map={no_trace}" for language in ("C", "CXX")),
        ]
        _run(configure, env, tell)
        _run(["cmake", "--build", str(folder / "build"), "--parallel", str(os.cpu_count() or 1)], env, tell)
        # Install with DESTDIR, so that the installed files contain the final paths.
        _run(["cmake", "--install", str(folder / "build")], {**env, "DESTDIR": f"{folder}/staged"}, tell)
        # Compile the Python files here, since other users may not be allowed to write into the folder.
        compiling = interpreter(
            *("-m", "compileall", "-q", "-s", f"{folder}/staged", str(staged / "lib")), python=str(ros.python), env=env
        )
        _run(compiling.argv, compiling.env, tell)
        make_readable(staged)
        _move(staged, prefix)


def _place_to_build(cache: Path) -> Path:
    """Return a folder in which to build: `cache`, or the folder for temporary files if the path has unusual characters.

    CMake truncates the paths of the interfaces at the first character that is not ASCII, and not every build command
    quotes apostrophes.
    """
    return cache if re.fullmatch(r"[\w./ +-]+", str(cache), re.ASCII) else Path(tempfile.gettempdir())


def _move(staged: Path, prefix: Path) -> None:
    """Move the finished build to its place, completely or not at all."""
    try:
        staged.rename(prefix)
    except OSError as error:
        if error.errno != errno.EXDEV:
            raise
        beside = prefix.with_name(f"{_TEMPORARY}{prefix.name}")
        shutil.copytree(staged, beside, symlinks=True)
        beside.rename(prefix)


def _run(command: list[str], env: dict[str, str], tell: Callable[[str], None]) -> None:
    lines: list[str] = []
    reported = 0
    with subprocess.Popen(
        command,
        # CMake and make start Python themselves, so they run in a folder without any foreign modules.
        cwd=env["HOME"],
        env=env,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        encoding="utf-8",
        errors="replace",
    ) as process:
        assert process.stdout is not None
        for line in process.stdout:
            lines.append(line.rstrip())
            percent = _percent(line)
            if percent is not None and percent >= reported + 20:
                reported = percent
                tell(f"Building the turtlesim interfaces: {percent} %")
    if process.returncode != 0:
        if shutil.disk_usage(env["HOME"]).free < _FULL:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        end = "\n".join(line for line in lines[-_LOG_LINES:] if line)
        shown = f" The last lines of its output:\n{end}" if end else ""
        message = f"The turtlesim interfaces could not be built: `{command[0]}` {how_ended(process.returncode)}.{shown}"
        raise MachineError(message)


def _percent(line: str) -> int | None:
    """Return the progress of make (`[ 40%]`) or ninja (`[30/75]`) in percent, or None."""
    match = re.match(r"\[\s*(\d+)(%|/(\d+))\]", line)
    if match is None:
        return None
    done = int(match[1])
    return done if match[2] == "%" else 100 * done // max(int(match[3]), 1)

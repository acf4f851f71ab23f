"""An observed host: a namespace with its own /tmp, home, processes and network, examined before and after a command.

The effects of a submission stay in this host. In this host, an attack can also run without a sandbox: programs that
protect nothing replace bubblewrap and prlimit, usage.py measures nothing, and the command finds no sandbox.

This file also runs inside the host, as a script. Inside the host, the script offers what an attacker would like to
reach (services, secrets), runs the command, and reports what is left.
"""

from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parent.parent.parent
SECRET = "what-only-the-caller-knows"
USER = 65531
"""An ordinary user, for tests that root runs."""
HANG_S = 1500.0
SETTLE_S = 120.0
"""The time (s) in which all processes must have exited after a command that was defended. The kernel kills the fork
servers and their forks with the grader, but on a busy machine they may exit later."""
UNDEFENDED_S = 0.5
"""The time to wait after any other command before the processes that are left are listed (s)."""

OF_LTTNG = re.compile(r"shm/lttng-ust-wait-\d+(-\d+)?")
"""Files that every ROS 2 program leaves on a host, because rclpy loads LTTng. The fork servers load rclpy."""


@dataclass(frozen=True)
class Left:
    """The effects of one command. `exit_code` is None if the attack killed the observer inside the host, too."""

    exit_code: int | None
    stdout: str
    stderr: str
    files: frozenset[str]
    """New files and folders below /tmp, /home and /dev/shm, without the work folder and the files of LTTng."""
    processes: tuple[str, ...]
    sockets: tuple[str, ...]
    seconds: float


class Host:
    """A host with a scratch folder. The folder /tmp/work in the host is the folder `work` outside."""

    def __init__(self, scratch: Path, interfaces: Path | None, *, as_user: bool = False) -> None:
        self._scratch = scratch
        self._as_user = as_user and os.geteuid() == 0
        for name in ("tmp/work", "caller", "shm", "cache/grader", "shims", "other/student"):
            (scratch / name).mkdir(parents=True)
        self.work = scratch / "tmp/work"
        for path in _ours():
            if path.is_relative_to("/tmp"):
                # The work folder is mounted here, so the attack did not leave it behind.
                (scratch / path.relative_to("/")).mkdir(parents=True)
        (scratch / "caller/.secret").write_text(SECRET)
        (scratch / "other/student/submission.txt").write_text(SECRET)
        if interfaces is not None:
            shutil.copytree(interfaces, scratch / "cache/grader" / interfaces.name, symlinks=True)
        source = (ROOT / "grader/sandbox/usage.py").read_text("utf-8")
        (scratch / "shims/usage.py").write_text(source + "\n\ndef exceeded(*_, **__):\n    return None\n")
        # The interpreter belongs to the user who grades, as one that the user has installed.
        shutil.copy2(Path(sys.executable).resolve(), scratch / "interpreter")
        _program(scratch / "shims/bwrap", "exit 1")
        _program(scratch / "shims/prlimit", 'while [ "$1" != "--" ]; do shift; done; shift; exec "$@"')

    def run(self, command: list[str], *, defended: bool = True) -> Left:
        """Run a command until it ends."""
        if self._as_user:
            subprocess.run(["chown", "-R", f"{USER}:{USER}", str(self._scratch)], check=True)
        # This is not imported above, because the host has no ROS 2.
        from grader.tests.both_worlds import SOURCED_ENV

        before = self._files()
        begun = time.monotonic()
        script = [sys.executable, "-I", str(Path(__file__)), json.dumps(command), *(["defended"] if defended else [])]
        done = subprocess.run(
            [*self._become(), *self._outer(defended=defended), *script],
            capture_output=True,
            timeout=HANG_S,
            check=False,
            stdin=subprocess.DEVNULL,
            env={**SOURCED_ENV, "PATH": "/usr/local/bin:/usr/bin:/bin", "LANG": "C.UTF-8"},
        )
        try:
            reported = json.loads(done.stdout)
        except ValueError:
            said = done.stderr.decode("utf-8", "replace")
            reported = {"exit_code": None, "stdout": "", "stderr": said, "processes": [], "sockets": []}
        return Left(
            reported["exit_code"],
            reported["stdout"],
            reported["stderr"],
            frozenset(self._files() - before),
            tuple(reported["processes"]),
            tuple(reported["sockets"]),
            time.monotonic() - begun,
        )

    def _become(self) -> list[str]:
        user = ["setpriv", f"--reuid={USER}", f"--regid={USER}", "--clear-groups", "--inh-caps=-all", "--"]
        return user if self._as_user else []

    def _outer(self, *, defended: bool) -> list[str]:
        scratch = self._scratch
        real = {name: shutil.which(name, path="/usr/local/bin:/usr/bin:/bin") or name for name in ("bwrap", "prlimit")}
        ordinary = self._as_user or os.geteuid() != 0
        command = [real["bwrap"], "--die-with-parent", "--unshare-pid", "--unshare-net", "--unshare-ipc"]
        if ordinary:
            command += ["--unshare-user"]
        elif not defended:
            # As root, nothing runs without a sandbox, not even in this host.
            command += ["--unshare-user", "--uid", str(USER), "--gid", str(USER)]
        command += ["--dev-bind", "/", "/", "--remount-ro", "/", "--tmpfs", "/home", "--tmpfs", "/run"]
        for inside, outside in {
            "/tmp": "tmp",
            "/home/caller": "caller",
            "/home/cache": "cache",
            "/home/other": "other",
            "/dev/shm": "shm",
        }.items():
            command += ["--bind", str(scratch / outside), inside]
        for path in map(str, _ours()):
            command += ["--ro-bind", path, path]
        command += ["--bind", str(scratch / "interpreter"), str(Path(sys.executable).resolve())]
        if not defended:
            real["usage.py"] = str(ROOT / "grader/sandbox/usage.py")
            command += [word for name, at in real.items() for word in ("--ro-bind", str(scratch / "shims" / name), at)]
        if ordinary or not defended:
            command += ["--proc", "/proc"]
        for key, value in {
            "HOME": "/home/caller",
            "XDG_CACHE_HOME": "/home/cache",
            "XDG_STATE_HOME": "/home/cache",
            "GRADER_TOKEN": SECRET,
        }.items():
            command += ["--setenv", key, value]
        return [*command, "--chdir", "/tmp/work", "--"]

    def _files(self) -> set[str]:
        found = set()
        for top in ("tmp", "caller", "shm", "other"):
            for folder, folders, files in os.walk(self._scratch / top):
                if Path(folder) == self.work:
                    folders.clear()
                    continue
                found |= {str((Path(folder) / name).relative_to(self._scratch)) for name in [*folders, *files]}
        return {name for name in found if not OF_LTTNG.fullmatch(name)}


def readable_by_others(path: Path) -> bool:
    """Return whether an ordinary user can read the file."""
    command = ["setpriv", f"--reuid={USER}", f"--regid={USER}", "--clear-groups", "test", "-r", str(path)]
    return os.geteuid() != 0 or subprocess.run(command, check=False).returncode == 0


def _ours() -> list[Path]:
    """Return the folders of the grader and its interpreter."""
    found = [ROOT, Path(sys.prefix), Path(sys.base_prefix)]
    return [
        path
        for path in found
        if not path.is_relative_to("/usr") and not any(path.is_relative_to(o) and path != o for o in found)
    ]


def _program(path: Path, body: str) -> None:
    path.write_text(f"#!/bin/sh\n{body}\n")
    path.chmod(0o755)


# --- inside the host --------------------------------------------------------------------------------------------


def inside(command: list[str], *, defended: bool) -> None:
    """Offer services, run the command, and report what is left."""
    if os.geteuid() == 0:
        subprocess.run(["mount", "-t", "proc", "proc", "/proc"], check=True)
    with _services():
        child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        stdout, stderr = child.communicate()
        until = time.monotonic() + SETTLE_S
        while defended and any(_left()) and time.monotonic() < until:
            time.sleep(0.05)
        if not defended:
            time.sleep(UNDEFENDED_S)
        alive, listening = _left()
    reported = {"stdout": stdout.decode("utf-8", "replace"), "stderr": stderr.decode("utf-8", "replace")}
    print(json.dumps({**reported, "exit_code": child.returncode, "processes": alive, "sockets": listening}))
    sys.stdout.flush()
    with contextlib.suppress(OSError):
        os.kill(-1, signal.SIGKILL)


def _left() -> tuple[list[str], list[str]]:
    """Return the command lines of all other processes, and the listening sockets that are not those of the services."""
    alive = [line for pid, line in _processes() if pid not in (1, os.getpid())]
    return alive, sorted(_listening() - _sockets_of(os.getpid()))


@contextlib.contextmanager
def _services() -> Iterator[None]:
    """Start a simple name server, a web server and two named sockets, which send the secret to every client."""
    datagrams = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    datagrams.bind(("127.0.0.1", 5353))
    threading.Thread(target=_answer_datagrams, args=(datagrams,), daemon=True).start()
    listeners: list[tuple[int, str | tuple[str, int]]] = [
        (socket.AF_INET, ("127.0.0.1", 8080)),
        (socket.AF_UNIX, "\0host"),
        (socket.AF_UNIX, "/tmp/host.sock"),
    ]
    for family, address in listeners:
        server = socket.socket(family, socket.SOCK_STREAM)
        server.bind(address)
        server.listen()
        threading.Thread(target=_answer, args=(server,), daemon=True).start()
    yield
    Path("/tmp/host.sock").unlink()


def _answer(server: socket.socket) -> None:
    while True:
        connection, _ = server.accept()
        connection.sendall(SECRET.encode())
        connection.close()


def _answer_datagrams(server: socket.socket) -> None:
    while True:
        _, who = server.recvfrom(1024)
        server.sendto(SECRET.encode(), who)


def _processes() -> list[tuple[int, str]]:
    found = []
    for pid in (int(entry.name) for entry in Path("/proc").iterdir() if entry.name.isdigit()):
        with contextlib.suppress(OSError):
            line = Path(f"/proc/{pid}/cmdline").read_bytes().replace(b"\0", b" ").decode("utf-8", "replace").strip()
            if line:
                found.append((pid, line))
    return found


def _listening() -> set[str]:
    """Return the listening sockets, each as its protocol, address and inode."""
    found = set()
    for name, state in (("tcp", "0A"), ("udp", "07")):
        for line in Path(f"/proc/net/{name}").read_text().splitlines()[1:]:
            words = line.split()
            if words[3] == state:
                found.add(f"{name} {words[1]} {words[9]}")
    for line in Path("/proc/net/unix").read_text().splitlines()[1:]:
        words = line.split()
        if words[3] == "00010000":
            found.add(f"unix {words[7] if len(words) > 7 else ''} {words[6]}")
    return found


def _sockets_of(pid: int) -> set[str]:
    links = set()
    for link in Path(f"/proc/{pid}/fd").iterdir():
        with contextlib.suppress(OSError):
            links.add(str(link.readlink()))
    return {each for each in _listening() if f"socket:[{each.split()[-1]}]" in links}


if __name__ == "__main__":
    inside(json.loads(sys.argv[1]), defended="defended" in sys.argv)

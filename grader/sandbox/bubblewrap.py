"""Build the command lines that create a sandbox and run the simulator or student code in it.

bubblewrap creates two kinds of containers:

- a **room** contains the grader's own processes, such as the simulator of a trial. These processes run as an ordinary
  user, with separate pid and network namespaces, and only the loopback interface. The simulator reads the messages of a
  student's node with libraries that may have security holes;
- a **cell** contains a student's process. A cell has its own user, pid, ipc, uts, cgroup and mount namespaces. It has
  no network except the network of the room, and no files from the disk except the system's programs (/usr, a few files
  in /etc) and the files in `View`. It has a system call filter (system_calls.py), and limits on memory, processes,
  files, CPU and disk. usage.py watches totals that the kernel does not limit.

The functions that build command lines start no processes. The caller starts and stops each process, and connects its
standard streams to pipes.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common import package_managers
from grader.errors import MachineError
from grader.sandbox import entering
from grader.sandbox.limits import MIB, NODE_LIMITS, Limits, limited
from grader.sandbox.system_calls import call_filter
from grader.sandbox.user import cell_user

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from grader.ros.installation import Ros

WORKSPACE = Path("/ws")
"""The workspace inside a cell, on a separate tmpfs."""
HOME = Path("/tmp/home")
"""The HOME of processes inside a room or a cell. This folder is empty at first, and is deleted together with
the room or cell."""

ROOM_DISK = 256 * MIB
_TRY_S = 60
_ANYWAY = "On a machine without important data, --trust-submissions runs this code"


@dataclass(frozen=True)
class View:
    """The files and folders on the disk that are visible in a room or cell in addition to the system's programs.

    They have the same paths. Inside the room or cell, a folder in `hidden` contains only those of its files and folders
    that `read_only` lists.
    """

    read_only: tuple[Path, ...]
    hidden: tuple[Path, ...] = ()


def ros_view(ros: Ros, *more: Path) -> View:
    """Return a view that contains the interpreter, ROS 2 and the folders or files in `more`.

    The view hides the rest of the grader even if the grader is installed in one of these folders.
    """
    needed = [Path(sys.base_prefix), Path(sys.prefix), *ros.all_prefixes, *more]
    site = Path(sys.prefix) / f"lib/python{sys.version_info.major}.{sys.version_info.minor}/site-packages"
    hidden = tuple(site / name for name in ("grader", "course", "solutions") if (site / name).is_dir())
    return View(read_only=tuple(dict.fromkeys(needed)), hidden=hidden)


def program() -> str | None:
    """Return the path of bwrap, or None if it is not in one of the system's folders."""
    return shutil.which("bwrap", path="/usr/local/bin:/usr/bin:/bin")


def room(
    argv: Sequence[str],
    view: View,
    *,
    env: Mapping[str, str],
    user: int | None,
    cwd: Path | None = None,
    info_fd: int | None = None,
) -> list[str]:
    """Return the command that runs `argv` as an ordinary user in a separate network.

    A sandbox room is for the grader's own processes.

    `user` comes from user.cell_user(): the user id to switch to if the caller is root, or None. bubblewrap writes JSON
    with the pid of the room's first process to `info_fd`.
    """
    command = [_bwrap(), "--unshare-net", "--unshare-pid", "--unshare-ipc", "--unshare-uts", "--hostname", "grader"]
    command += ["--die-with-parent", "--size", str(ROOM_DISK), "--tmpfs", "/tmp", "--perms", "0777", "--dir", str(HOME)]
    command += [*_disk(view), *(["--proc", "/proc"] if user is None else ["--dir", "/proc"])]
    # rclpy loads LTTng, which keeps a file here. If LTTng cannot write this file, the threads of LTTng wait for any
    # child of the process, and may collect the exit code of a node that exits at this moment.
    command += ["--size", str(ROOM_DISK), "--perms", "1777", "--tmpfs", "/dev/shm"]
    command += [] if info_fd is None else ["--info-fd", str(info_fd)]
    command = [*_ordinary(command, user), *_environment(env), "--chdir", str(cwd or HOME), "--"]
    return [*command, *_stay_ordinary(user), *argv]


def cell(
    argv: Sequence[str],
    view: View,
    *,
    env: Mapping[str, str],
    limits: Limits = NODE_LIMITS,
    network: bool = False,
    cwd: Path = WORKSPACE,
    info_fd: int | None = None,
    filter_fd: int | None = None,
    first: bool = False,
) -> list[str]:
    """Return the command that runs `argv` in a cell.

    With `network`, the cell shares the network of the room in which the caller runs. With `first`, the program is the
    first process of the cell. Without `first`, the first process is a process of bubblewrap, which has the same
    standard streams and can be controlled by the other processes of the cell.

    `filter_fd` is the descriptor from system_calls.call_filter(), which the process must inherit. The limit on
    processes does not apply to root. Therefore, a caller that runs as root must put the cell into a room, in which the
    cell's user is an ordinary user. bubblewrap writes JSON with the pid of the cell's first process to `info_fd`.
    """
    command = [_bwrap(), "--unshare-user", "--disable-userns", "--unshare-pid", "--unshare-ipc", "--unshare-uts"]
    command += ["--unshare-cgroup-try", "--uid", "1000", "--gid", "1000", "--hostname", "robot"]
    command += ["--die-with-parent", "--new-session", *([] if network else ["--unshare-net"])]
    # /tmp comes first, because folders of the view may be inside it.
    command += ["--size", str(limits.disk), "--tmpfs", "/tmp", "--dir", str(HOME)]
    command += ["--size", str(limits.disk), "--tmpfs", str(WORKSPACE), *_disk(view), "--proc", "/proc"]
    # A shared mapping of /dev/zero is memory that no limit counts.
    command += ["--ro-bind", "/dev/null", "/dev/zero"]
    # --dev makes /dev and /dev/shm writable and large.
    command += ["--size", str(limits.disk), "--tmpfs", "/dev/shm", "--remount-ro", "/dev", "--remount-ro", "/"]
    command += [] if info_fd is None else ["--info-fd", str(info_fd)]
    command += [] if filter_fd is None else ["--seccomp", str(filter_fd)]
    command += ["--as-pid-1"] if first else []
    # Set the limits inside the cell, so that they count only processes of this cell.
    return [*command, *_environment(env), "--chdir", str(cwd), "--", *limited(argv, limits, in_cell=True)]


def lone_cell(
    argv: Sequence[str],
    view: View,
    *,
    env: Mapping[str, str],
    limits: Limits,
    user: int | None,
    filter_fd: int | None = None,
    first: bool = False,
) -> list[str]:
    """Return the command that runs `argv` in a cell with a separate network, inside a room without other processes.

    `user` has the same meaning as in `room`, and `first` as in `cell`. Student code can change the memory of the first
    process of its cell, so this process might not exit together with its parent. Therefore, the cell is in a room:
    student code cannot reach the first process of the room.

        with call_filter() as filter_fd, cell_user() as user:
            command = lone_cell(["colcon", "build"], view, env=env, limits=Limits(), user=user, filter_fd=filter_fd)
            subprocess.run(command, check=True, pass_fds=[filter_fd])
    """
    inner = cell(argv, view, env=env, limits=limits, filter_fd=filter_fd, first=first)
    return room(inner, view, env=env, user=user)


def usable() -> bool:
    """Return whether sandbox cells work on this machine. The test takes a few milliseconds."""
    return why_unavailable() is None


def require(*, trusted: bool = False, anyway: str = _ANYWAY) -> bool:
    """Return whether student code will run in a sandbox. Call this function before running code of untrusted students.

    With `trusted`, a missing sandbox is not an error. `anyway` is the beginning of the last sentence of the error
    message. This sentence says how to run the code without a sandbox.

    Raises:
        MachineError: no sandbox is available, and the code is not trusted.
    """
    why = why_unavailable()
    if why is None or trusted:
        return why is None
    message = (
        f"No sandbox is available, so the grader does not run other people's code: {why}. {anyway} with limits on "
        "time, memory, processes and file size only."
    )
    raise MachineError(message)


def why_unavailable() -> str | None:
    """Try to start a cell. Return None if sandbox cells work, and otherwise the reason.

    Raises:
        MachineError: the machine is too busy to find out. The caller must not take this for a missing sandbox.
    """
    if program() is None:
        return _not_installed()
    view = View(read_only=())
    env = {"PATH": "/usr/bin:/bin"}
    with call_filter() as filter_fd, cell_user() as user:
        tried = lone_cell(["true"], view, env=env, limits=Limits(), user=user, filter_fd=filter_fd)
        inherited = () if filter_fd is None else (filter_fd,)
        try:
            done = subprocess.run(
                tried,
                capture_output=True,
                text=True,
                timeout=_TRY_S,
                check=False,
                stdin=subprocess.DEVNULL,
                pass_fds=inherited,
            )
        except subprocess.TimeoutExpired:
            message = f"bubblewrap did not create a sandbox within {_TRY_S} s. Try again when the machine is less busy."
            raise MachineError(message) from None
    if done.returncode == 0:
        return entering.why_impossible()
    lines = done.stderr.strip().splitlines()[-1:] or ["no message"]
    return (
        f"bubblewrap cannot create a sandbox ({lines[0]}). On Ubuntu 24.04, AppArmor does not let ordinary users "
        "create namespaces; `sudo sysctl kernel.apparmor_restrict_unprivileged_userns=0` allows this until the next "
        "reboot. "
        'docs/security.md, "Without a sandbox", has a permanent solution and the options for containers'
    )


def _bwrap() -> str:
    path = program()
    if path is None:
        message = f"{_not_installed()}."
        raise MachineError(message)
    return path


def _not_installed() -> str:
    need = package_managers.Need("bubblewrap", "bubblewrap")
    manager = package_managers.find_manager(os.environ.get("PATH", ""))
    command = package_managers.command(manager, [need], root=os.geteuid() == 0)
    return f"bubblewrap is not installed. Install it with `{command}`"


def _ordinary(command: list[str], user: int | None) -> list[str]:
    # Root makes mounts and the network without a user namespace, and then becomes an ordinary user (_stay_ordinary).
    return [command[0], "--unshare-user", *command[1:]] if user is None else command


def _stay_ordinary(user: int | None) -> list[str]:
    if user is None:
        return []
    # bubblewrap's --proc would cover parts of /proc, and then a cell inside could not mount its own /proc.
    proc = ["sh", "-c", 'mount -t proc -o nosuid,nodev,noexec proc /proc && exec "$@"', "sh"]
    # Changing the user clears the signal of --die-with-parent, so request it again.
    become = [f"--reuid={user}", f"--regid={user}", "--clear-groups", "--inh-caps=-all", "--bounding-set=-all"]
    return [*proc, "setpriv", *become, "--no-new-privs", "--pdeathsig=KILL", "--"]


def _disk(view: View) -> list[str]:
    command = []
    for name in ("bin", "sbin", "lib", "lib32", "lib64"):
        folder = Path("/") / name
        if folder.is_symlink():
            command += ["--symlink", str(folder.readlink()), str(folder)]
        elif folder.is_dir():
            command += ["--ro-bind", str(folder), str(folder)]
    etc = [Path("/etc") / name for name in ("alternatives", "ld.so.cache", "ld.so.conf", "ld.so.conf.d", "localtime")]
    shown = [Path("/usr"), *(path for path in etc if path.exists())]
    shown += [path for path in view.read_only if not path.is_relative_to("/usr")]
    # bwrap creates missing parent folders readable only by their owner, so name them here.
    parents = dict.fromkeys(parent for path in shown for parent in reversed(path.parents[:-1]))
    command += [word for parent in parents for word in ("--dir", str(parent))]
    # Visible parts of a hidden folder are added after the folder has been emptied.
    within = {path: folder for path in shown for folder in view.hidden if path.is_relative_to(folder)}
    command += [word for path in shown if path not in within for word in _observed(path)]
    command += [word for folder in view.hidden for word in ("--tmpfs", str(folder))]
    for path, folder in within.items():
        inner = [parent for parent in reversed(path.parents) if parent.is_relative_to(folder) and parent != folder]
        command += [word for parent in inner for word in ("--dir", str(parent))]
        command += _observed(path)
    command += [word for folder in view.hidden for word in ("--remount-ro", str(folder))]
    return [*command, "--dev", "/dev"]


def _observed(path: Path) -> tuple[str, str, str]:
    return "--ro-bind", str(path), str(path)


def _environment(env: Mapping[str, str]) -> list[str]:
    command = ["--clearenv"]
    for key, value in env.items():
        command += ["--setenv", key, value]
    return command

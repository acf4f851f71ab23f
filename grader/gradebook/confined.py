"""Autograde's kernels: each runs in a cell (grader.sandbox) and is reached over sockets in a shared folder.

The cells of a notebook are student code. A sandbox cell has only its own loopback network, so the kernel is reached
over
ipc sockets instead of TCP. Interrupts are sent as messages, because a signal would reach bubblewrap and not the kernel.
"""

from __future__ import annotations

import math
import os
import signal
import subprocess
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jupyter_client.kernelspec import KernelSpec
from jupyter_client.manager import AsyncKernelManager
from nbclient.exceptions import CellTimeoutError, DeadKernelError
from nbgrader.preprocessors import Execute
from traitlets import Bool, Instance, Integer, Unicode

from grader.common.interpreter import interpreter
from grader.exercise.model import course_folder
from grader.notebook.mode import CONFINED
from grader.ros.installation import environment, find_ros
from grader.ros.underlay import with_turtlesim
from grader.sandbox import bubblewrap
from grader.sandbox.bubblewrap import HOME, Limits, View, lone_cell, ros_view
from grader.sandbox.system_calls import call_filter
from grader.sandbox.usage import Guard
from grader.submission import tree
from grader.submission.package import Submission, write_copy
from grader.submission.reader import read

if TYPE_CHECKING:
    from nbformat import NotebookNode

CHECK_S = 300
"""The time limit for an instructor's cell (s). It builds and runs a package, perhaps in wall time."""
MOST_OUTPUT = 4_000_000
"""Characters of all outputs together. A notebook that prints more is stopped."""


class ConfinedKernelManager(AsyncKernelManager):
    """Start a kernel in a cell. The kernel gets a copy of the folder `submission`."""

    submission = Unicode("")
    trusted = Bool(default_value=False)
    _folder = Instance(tempfile.TemporaryDirectory, allow_none=True)
    _guard: Guard | None = None

    @property
    def kernel_spec(self) -> KernelSpec:
        """The course's own kernel, whatever the notebook names."""
        argv = interpreter(
            *("-m", "grader.notebook.confined", "{submission}", "-f", "{connection_file}"), searches=True
        ).argv
        return KernelSpec(argv=argv, display_name="", language="python", interrupt_mode="message")

    async def _async_pre_start_kernel(self, **kw: Any) -> Any:  # noqa: ANN401 - as the base class
        self._folder = tempfile.TemporaryDirectory(prefix="kernel-")
        sockets = Path(self._folder.name) / "sockets"
        sockets.mkdir()
        # The user of the cell can write there. The folder around it keeps all other users out.
        sockets.chmod(0o777)
        self.transport = "ipc"
        self.connection_file = str(sockets / "kernel.json")
        self.ip = str(sockets / "socket")
        return await super()._async_pre_start_kernel(**kw)

    async def _async_launch_kernel(self, kernel_cmd: list[str], **kw: Any) -> None:  # noqa: ANN401 - as the base class
        confined = bubblewrap.require(trusted=self.trusted)
        assert self._folder is not None
        copy = Path(self._folder.name) / "submission"
        _copy(Path(self.submission), copy)
        Path(self.connection_file).chmod(0o644)
        argv = [word.replace("{submission}", str(copy)) for word in kernel_cmd]
        env, view = _environment(copy, Path(self.connection_file).parent)
        kw.pop("cwd", None)
        # Output of a student on these would control the instructor's terminal.
        kw |= {"env": env, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        limits = Limits()
        with call_filter() as filter_fd:
            if confined:
                argv = lone_cell(argv, view, env=env, limits=limits, filter_fd=filter_fd)
                kw["pass_fds"] = () if filter_fd is None else (filter_fd,)
            await super()._async_launch_kernel(argv, **kw)
        pid = self.provisioner.process.pid  # type: ignore[union-attr]
        self._guard = Guard(pid, limits, lambda _: _kill(pid))

    async def _async_cleanup_resources(self, restart: bool = False) -> None:
        if self._guard is not None:
            self._guard.close()
            self._guard = None
        await super()._async_cleanup_resources(restart)
        if self._folder is not None:
            with suppress(OSError):
                self._folder.cleanup()
            self._folder = None


class ConfinedExecute(Execute):  # type: ignore[misc, unused-ignore]
    """Run a submitted notebook in a cell, to its end even if the kernel dies. Cells that did not run get an error."""

    trust_submissions = Bool(
        default_value=False,
        help="Run submitted notebooks even without a sandbox, on a machine that you can lose.",
    ).tag(config=True)

    cell_s = Integer(20, help="Time limit for a student's own cell, in seconds.").tag(config=True)

    def __init__(self, *arguments: Any, **keywords: Any) -> None:  # noqa: ANN401 - as the base class
        keywords.setdefault("kernel_manager_class", ConfinedKernelManager)
        super().__init__(*arguments, **keywords)
        self._ended = ""
        self._printed = 0

    def preprocess(self, nb: NotebookNode, resources: Any = None, km: Any = None) -> tuple[NotebookNode, Any]:  # noqa: ANN401
        """Run all cells."""
        self._ended, self._printed = "", 0
        course, about = self.parent.parent.coursedir, resources["nbgrader"]
        folder = course.format_path(course.submitted_directory, about["student"], about["assignment"])
        self._submission = folder
        try:
            nb, resources = super().preprocess(nb, resources, km)
        except (DeadKernelError, RuntimeError) as error:
            # The kernel did not start or did not stop.
            self._ended = self._ended or str(error).partition("\n")[0]
            self.log.warning("The kernel ended: %s", self._ended)
            for cell in nb.cells:
                if cell.cell_type == "code" and not cell.get("outputs") and cell.get("execution_count") is None:
                    _mark(cell, self._ended)
        for cell in nb.cells:
            _honest(cell)
        return nb, resources

    def create_kernel_manager(self) -> Any:  # noqa: ANN401 - as the base class
        """Create the manager of this submission's kernel, whatever kernel the notebook's metadata name."""
        self.km = ConfinedKernelManager(submission=self._submission, trusted=self.trust_submissions, config=self.config)
        return self.km

    def preprocess_cell(self, cell: NotebookNode, resources: Any, index: int) -> tuple[NotebookNode, Any]:  # noqa: ANN401
        """Run one cell, if the kernel is still alive."""
        if self._ended:
            if cell.cell_type == "code":
                _mark(cell, self._ended)
            return cell, resources
        try:
            return super().preprocess_cell(cell, resources, index)  # type: ignore[no-any-return, unused-ignore]
        except (DeadKernelError, CellTimeoutError) as error:
            if isinstance(error, CellTimeoutError):
                self._end("A cell did not end in time, and did not stop when it was interrupted.")
            self._ended = self._ended or "The kernel died."
            if cell.cell_type == "code":
                _mark(cell, self._ended)
            return cell, resources

    def process_message(self, msg: dict[str, Any], cell: NotebookNode, cell_index: int) -> NotebookNode | None:
        """Handle a message of the kernel, unless all of them together are too long."""
        if msg["msg_type"] in {"stream", "display_data", "execute_result", "error", "update_display_data"}:
            self._printed += len(str(msg["content"]))
            if self._printed > MOST_OUTPUT:
                self._end(f"The notebook printed more than {MOST_OUTPUT // 1_000_000} million characters.")
                return None
        return super().process_message(msg, cell, cell_index)  # type: ignore[no-any-return, unused-ignore]

    def _get_timeout(self, cell: NotebookNode | None) -> int | None:
        locked = cell is not None and cell.get("metadata", {}).get("nbgrader", {}).get("locked")
        return CHECK_S if locked or cell is None else self.cell_s

    def _end(self, why: str) -> None:
        if not self._ended:
            self._ended = why
            _kill(self.km.provisioner.process.pid)  # type: ignore[union-attr]


def _mark(cell: NotebookNode, why: str) -> None:
    from nbformat.v4 import new_output

    cell.outputs = [new_output("error", ename="NotRun", evalue=why, traceback=[why])]  # type: ignore[no-untyped-call]


def _honest(cell: NotebookNode) -> None:
    """Replace the result of a cell that should give its points by an error if it is not a valid number.

    nbgrader gives full marks to a cell without output.
    """
    about = cell.get("metadata", {}).get("nbgrader", {})
    if not about.get("grade") or cell.cell_type != "code" or ".points(" not in cell.source:
        return
    results = [output for output in cell.outputs if output.output_type == "execute_result"]
    failed = any(output.output_type == "error" for output in cell.outputs)
    try:
        number = float(results[0]["data"]["text/plain"]) if len(results) == 1 else math.nan
    except (KeyError, TypeError, ValueError):
        number = math.nan
    if not failed and not 0.0 <= number <= float(about["points"]):
        _mark(cell, "The cell did not give its points.")


def _copy(folder: Path, copy: Path) -> None:
    """Copy the files of the submission that are safe to read. Links that lead out of it are left out."""
    found = read(tree.read_folder, folder)
    files = {path: data for path, data in found.files.items() if not path.endswith(".ipynb")}
    write_copy(Submission("", folder, files, (), "", frozenset(found.executable & files.keys())), copy)


def _environment(*folders: Path) -> tuple[dict[str, str], View]:
    ros = with_turtlesim(find_ros())
    course = course_folder()
    package = Path(__file__).resolve().parent.parent
    exercises = course.parent / "exercises"
    shown = ros_view(ros, *(path for path in (package, course, exercises, folders[0]) if path.exists()))
    # The grader's tests contain solutions too, and so does the folder next to the course if it is installed.
    hidden = [path for path in shown.hidden if path.name == "solutions"]
    hidden += [path for path in (package / "tests",) if path.is_dir()]
    view = View(shown.read_only, tuple(hidden), (folders[1],))
    env = environment(ros, home=HOME)
    env |= {CONFINED: "1", "NBGRADER_EXECUTION": "autograde", "IPYTHONDIR": str(HOME / "ipython")}
    if ros.underlay:
        env["XDG_CACHE_HOME"] = str(ros.underlay.parent.parent)
    return env, view


def _kill(pid: int) -> None:
    with suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)

"""The kernels in which `nbgrader autograde` runs notebooks.

Each kernel runs in a sandbox cell (grader.sandbox), and a relay limits its messages (relay.py). On a machine without a
sandbox, kernels run only with `trust_submissions`.

The cells of a notebook are student code. A sandbox cell has only a loopback network and separate disks, so the relay
communicates with the kernel through pipes. Interrupts are sent as messages, because a signal would go to the relay.
"""

from __future__ import annotations

import math
import os
import signal
import subprocess
import tempfile
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jupyter_client.kernelspec import KernelSpec
from jupyter_client.manager import AsyncKernelManager
from nbclient.exceptions import CellControlSignal, CellTimeoutError, DeadKernelError
from nbgrader.preprocessors import Execute
from traitlets import Bool, Instance, Integer, Unicode

from grader.common.interpreter import interpreter
from grader.errors import GraderError, MachineError
from grader.exercise.model import course_folder
from grader.gradebook.cell_outputs import MOST_OUTPUT, TOO_MUCH, honest, mark, put_right
from grader.gradebook.copies import copy_of
from grader.gradebook.relay import WHY_FILE, Order
from grader.notebook.mode import CONFINED
from grader.ros.installation import environment, find_ros
from grader.ros.underlay import with_turtlesim
from grader.sandbox import bubblewrap
from grader.sandbox.bubblewrap import HOME, WORKSPACE, View, ros_view

if TYPE_CHECKING:
    from nbformat import NotebookNode

CHECK_S = 300
"""The time limit (s) for a notebook cell of the instructor. Such a cell can build and run a package, also in wall
time."""
SHOWN = ("stream", "display_data", "execute_result", "error", "update_display_data")
"""The types of messages that add or change outputs of a notebook cell."""


class ConfinedKernelManager(AsyncKernelManager):
    """Starts a kernel in a sandbox cell. The kernel gets a copy of the folder `submission`."""

    submission = Unicode("")
    trusted = Bool(default_value=False)
    why = ""
    """The reason why the kernel was stopped, or an empty string if it exited on its own."""
    _folder = Instance(tempfile.TemporaryDirectory, allow_none=True)
    _life = -1

    @property
    def kernel_spec(self) -> KernelSpec:
        """The course's kernel, even if another kernel is specified in the notebook."""
        argv = interpreter("-m", "grader.gradebook.relay", "{relay_folder}").argv
        return KernelSpec(argv=argv, display_name="", language="python", interrupt_mode="message")

    async def _async_pre_start_kernel(self, **kw: Any) -> Any:  # noqa: ANN401 - as the base class
        # Only the current user can access this folder. The cell sees only the copy of the submission in it.
        self._folder = tempfile.TemporaryDirectory(prefix="kernel-")
        folder = Path(self._folder.name)
        self.transport = "ipc"
        self.connection_file = str(folder / "kernel.json")
        self.ip = str(folder / "socket")
        return await super()._async_pre_start_kernel(**kw)

    async def _async_launch_kernel(self, kernel_cmd: list[str], **kw: Any) -> None:  # noqa: ANN401 - as the base class
        assert self._folder is not None
        folder = Path(self._folder.name)
        _order(Path(self.submission), folder, self.connection_file, trusted=self.trusted).write(folder)
        argv = [word.replace("{relay_folder}", str(folder)) for word in kernel_cmd]
        kw.pop("cwd", None)
        # The relay exits when this pipe is closed, which always happens when this process exits.
        ends, self._life = os.pipe()
        try:
            kw |= {"env": interpreter("-c", "").env, "cwd": "/", "stdin": ends, "stdout": subprocess.DEVNULL}
            await super()._async_launch_kernel(argv, **kw)
        finally:
            os.close(ends)

    def read_why(self) -> str:
        """Return the reason why the relay stopped the kernel, or an empty string if the relay did not stop it."""
        if self._folder is not None and not self.why:
            with suppress(OSError):
                self.why = (Path(self._folder.name) / WHY_FILE).read_text("utf-8")
        return self.why

    async def _async_cleanup_resources(self, restart: bool = False) -> None:
        self.read_why()
        if self._life >= 0:
            os.close(self._life)
            self._life = -1
        await super()._async_cleanup_resources(restart)
        if self._folder is not None:
            with suppress(OSError):
                self._folder.cleanup()
            self._folder = None


class ConfinedExecute(Execute):  # type: ignore[misc, unused-ignore]
    """Runs a submitted notebook in a sandbox cell.

    If the kernel dies, each remaining code cell of the notebook gets an error as its output.
    """

    trust_submissions = Bool(
        default_value=False,
        help="Run notebooks even without a sandbox. Use this only on a machine without important data.",
    ).tag(config=True)

    cell_s = Integer(20, help="Time limit for a student's cell, in seconds.").tag(config=True)

    notebook_s = Integer(1800, help="Time limit for all cells of a notebook together, in seconds.").tag(config=True)

    # If the kernel dies, the wait ends at once. A busy machine may need more than the 60 s of the base class.
    startup_timeout = Integer(300, help="Time limit for the start of the kernel, in seconds.").tag(config=True)

    # On a busy machine, nbgrader may need more than the 4 s of the base class to read what a cell has printed.
    iopub_timeout = Integer(60, help="Time limit for the outputs of a cell after it has ended, in seconds.").tag(
        config=True
    )

    def __init__(self, *arguments: Any, **keywords: Any) -> None:  # noqa: ANN401 - as the base class
        keywords.setdefault("kernel_manager_class", ConfinedKernelManager)
        super().__init__(*arguments, **keywords)
        self._ended = ""
        self._printed = 0
        self._until = 0.0

    def preprocess(self, nb: NotebookNode, resources: Any = None, km: Any = None) -> tuple[NotebookNode, Any]:  # noqa: ANN401
        """Run all cells."""
        self._ended, self._printed = "", 0
        self._until = time.monotonic() + self.notebook_s
        course, about = self.parent.parent.coursedir, resources["nbgrader"]
        folder = course.format_path(course.submitted_directory, about["student"], about["assignment"])
        self._submission = folder
        try:
            nb, resources = super().preprocess(nb, resources, km)
        except MachineError:
            raise
        except Exception as error:
            # The kernel did not start or stop, or nbclient could not process what it sent.
            self._ended = self._ended or self._reason(error)
            self.log.warning("The kernel ended: %s", self._ended)
            for cell in nb.cells:
                if cell.cell_type == "code" and not cell.get("outputs") and cell.get("execution_count") is None:
                    mark(cell, self._ended)
        put_right(nb)
        for cell in nb.cells:
            honest(cell)
        return nb, resources

    def create_kernel_manager(self) -> Any:  # noqa: ANN401 - as the base class
        """Create the manager of this submission's kernel and ignore the kernel in the notebook's metadata."""
        self.km = ConfinedKernelManager(submission=self._submission, trusted=self.trust_submissions, config=self.config)
        self._manager = self.km
        return self.km

    def preprocess_cell(self, cell: NotebookNode, resources: Any, index: int) -> tuple[NotebookNode, Any]:  # noqa: ANN401
        """Run one notebook cell if the kernel is still alive and time is left."""
        if time.monotonic() >= self._until:
            self._end(f"The cells of the notebook took longer than {self.notebook_s} s.")
        if self._ended:
            if cell.cell_type == "code":
                mark(cell, self._ended)
            return cell, resources
        try:
            cell, resources = super().preprocess_cell(cell, resources, index)
        except Exception as error:
            self._end(self._reason(error))
        if self._ended and cell.cell_type == "code":
            mark(cell, self._ended)
        return cell, resources

    def process_message(self, msg: dict[str, Any], cell: NotebookNode, cell_index: int) -> NotebookNode | None:
        """Process a message from the kernel unless the total size of the outputs is too large."""
        if msg["msg_type"] in SHOWN:
            self._printed += len(str(msg["content"]))
            if self._printed > MOST_OUTPUT:
                self._end(TOO_MUCH)
                return None
        try:
            return super().process_message(msg, cell, cell_index)  # type: ignore[no-any-return, unused-ignore]
        except CellControlSignal:
            raise
        except Exception as error:
            self._end(self._reason(error))
            return None

    def on_comm_open_jupyter_widget(self, msg: dict[str, Any]) -> None:
        """Do nothing.

        With a widget, the kernel could make the replies that it receives from nbclient arbitrarily long.
        """

    def _get_timeout(self, cell: NotebookNode | None) -> int | None:
        locked = cell is not None and cell.get("metadata", {}).get("nbgrader", {}).get("locked")
        left_s = max(1, math.ceil(self._until - time.monotonic()))
        return min(left_s, CHECK_S if locked or cell is None else self.cell_s)

    def _reason(self, error: Exception) -> str:
        """Return the reason why the remaining cells cannot be run."""
        why: str = self._manager.read_why()
        if why or isinstance(error, DeadKernelError):
            return why or "The kernel died."
        if isinstance(error, CellTimeoutError):
            return "A cell did not end in time and ignored the interrupt."
        if isinstance(error, RuntimeError | GraderError):
            return str(error).partition("\n")[0]
        self.log.debug("Could not process the kernel's messages", exc_info=error)
        return "The kernel sent messages that nbgrader could not process."

    def _end(self, why: str) -> None:
        if not self._ended:
            self._ended = why
            if self.km is not None and self.km.has_kernel:
                _kill(self.km.provisioner.process.pid)  # type: ignore[union-attr]


def _order(submission: Path, folder: Path, connection_file: str, *, trusted: bool) -> Order:
    """Copy the submission to the relay's `folder`, and return the command that the relay must start."""
    confined = bubblewrap.require(trusted=trusted)
    copy, home, workspace = folder / "submission", HOME, WORKSPACE
    copy_of(submission, copy, notebooks=False)
    if not confined:
        home, workspace = folder / "home", folder / "workspace"
        home.mkdir()
        workspace.mkdir()
    env, view = _environment(copy, home)
    start = interpreter("-m", "grader.notebook.bridge", str(copy), str(workspace), env=env, searches=True)
    return Order(start.argv, start.env, view, confined, connection_file)


def _environment(copy: Path, home: Path) -> tuple[dict[str, str], View]:
    ros = with_turtlesim(find_ros())
    course = course_folder()
    package = Path(__file__).resolve().parent.parent
    exercises = course.parent / "exercises"
    shown = ros_view(ros, *(path for path in (package, course, exercises, copy) if path.exists()))
    # Solutions are also in the grader's tests, and next to the course if it is installed.
    hidden = [path for path in shown.hidden if path.name == "solutions"]
    hidden += [path for path in (package / "tests",) if path.is_dir()]
    view = View(shown.read_only, tuple(hidden))
    env = environment(ros, home=home)
    env |= {CONFINED: "1", "NBGRADER_EXECUTION": "autograde", "IPYTHONDIR": str(home / "ipython")}
    if ros.underlay:
        env["XDG_CACHE_HOME"] = str(ros.underlay.parent.parent)
    return env, view


def _kill(pid: int) -> None:
    with suppress(ProcessLookupError):
        os.kill(pid, signal.SIGKILL)

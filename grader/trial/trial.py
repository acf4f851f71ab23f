"""Trial: one run of the simulator and the node on one clock, from the viewpoint of the grader's own process."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import tempfile
from contextlib import ExitStack, suppress
from dataclasses import asdict, dataclass, field, replace
from typing import IO, TYPE_CHECKING, Any

from grader.common.how_ended import how_ended
from grader.common.system_errors import refusal_in
from grader.common.temporary_folder import temporary_folder
from grader.errors import MachineError
from grader.ros import installation
from grader.sandbox import bubblewrap
from grader.sandbox.holder import HolderError
from grader.sandbox.limits import MIB
from grader.trial.conductor_process import ConductorInRoom, PlainConductor
from grader.trial.inputs import Inputs
from grader.trial.own_domain import own_domain
from grader.trial.recording_json import from_json
from grader.trial.time_limit import TimeLimit

if TYPE_CHECKING:
    from grader.trial.conductor_process import ConductorProcess
    from grader.trial.recording import ClockName, Pose, Recording

MOST_ANSWER = 256 * MIB
"""The maximum size of one response from the conductor (bytes). A large response consists mostly of the messages in a
recording."""
_ENDED_S = 30.0
"""The maximum time to wait for the exit code of a conductor that has closed its standard output (s)."""


@dataclass(frozen=True)
class Plan:
    """The settings of a trial: the clock, the start pose (m, m, rad), the duration (s), and so on."""

    clock: ClockName
    start: Pose
    seed: int | None
    duration_s: float
    stop_at_doubt: bool = True
    inputs: Inputs = field(default_factory=Inputs)
    alone: bool = False
    """Whether the simulator runs without a node."""
    judged: tuple[str, ...] = ()
    """The topics that a check needs. These topics are recorded even if there are very many other topics."""
    beside: tuple[str, ...] = ()
    """The additional executables that run next to the node of the trial."""


def last_words(stderr: bytes) -> str:
    """Return the output of one of the grader's programs, or only its last line if the output contains a traceback."""
    output = stderr.decode("utf-8", "replace").strip()
    return output.splitlines()[-1] if "Traceback (most recent call last)" in output else output


class WallTimeNeeded(Exception):  # noqa: N818 - not an error
    """Simulated time may misjudge this node. The message gives the reason.

    `by_chance` is true if another trial in simulated time may be able to judge the node.
    """

    def __init__(self, why: str, *, by_chance: bool = False) -> None:
        super().__init__(why)
        self.by_chance = by_chance


class OverwhelmedError(Exception):
    """The node made the simulator fail, or kept the trial from finishing (`hung` is true). The message explains how."""

    def __init__(self, how: str, *, hung: bool = False) -> None:
        super().__init__(how)
        self.hung = hung


class Trial:
    """One trial, as a context manager.

    Entering the context starts the simulator and the launcher, so that both are ready when the build is done.
    """

    def __init__(self, plan: Plan, ros: installation.Ros, *, in_cell: bool, share: bool = False) -> None:
        """Prepare a trial. `share` is the argument of fork_client.conductors."""
        self._share = share
        self._plan = plan
        self._ros = ros
        self._in_cell = in_cell
        self._node_runs = False
        self._stack = ExitStack()
        self._started = False
        self._ready = False
        self._domain: int | None = None

    def __enter__(self) -> Trial:  # noqa: PYI034 - typing.Self is Python 3.11's
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def start(self) -> None:
        """Start the simulator and the launcher before the context is entered.

        The caller must enter the context later, or call `close`.
        """
        if self._started:
            return
        self._started = True
        try:
            self._start()
        except BaseException:
            self._stack.close()
            raise

    def close(self) -> None:
        """Kill all processes of the trial."""
        self._stack.close()

    def await_ready(self) -> None:
        """Wait until the simulator and the launcher are ready for the node.

        Raises:
            MachineError: the simulator or the launcher failed.
        """
        if not self._ready:
            self._limit()
            self._answer("ready")
            self._time_limit.cancel()  # the node may be started much later
            self._ready = True

    def suspend(self) -> None:
        """Suspend the simulator until the trial is used, since a waiting simulator uses 0.3 % of a core.

        Any thread may call `suspend`. Without a sandbox, this method does nothing, because suspended processes would
        outlive a killed grader.
        """
        if self._in_cell:
            self._conductor.suspend()

    def run(self, package: str, executable: str, tree: bytes) -> Recording:
        """Run the executable from the install tree (a tar stream), and return the recording.

        Raises:
            WallTimeNeeded: simulated time may misjudge this node.
            OverwhelmedError: the node made the simulator fail, or kept the trial from finishing.
            MachineError: the simulator or the sandbox failed, or the machine was too busy or out of memory.
        """
        arguments = ["--ros-args", "-p", "use_sim_time:=true"] if self._plan.clock == "simulated" else []
        inputs = self._plan.inputs
        if inputs.arguments:
            arguments += ["--ros-args", *inputs.arguments]
        executables = enumerate((executable, *self._plan.beside))
        nodes = [self._order(package, name, arguments, f"install{number or ''}") for number, name in executables]
        order = {"nodes": nodes, "tree_bytes": len(tree)}
        self.await_ready()
        self._limit()
        self._send(json.dumps(order).encode() + b"\n" + tree)
        self._node_runs = True
        recording = from_json(self._answer("recording"))
        if self._conductor.out_of_memory() and recording.end.by == "itself":
            return replace(recording, end=replace(recording.end, out_of="memory"))
        return recording

    def _order(self, package: str, executable: str, arguments: list[str], folder: str) -> dict[str, Any]:
        """Return the data for the launcher of one node. Each launcher unpacks the install tree in its own folder."""
        install = self._workspace / folder
        prefix = install / package
        env = installation.environment(self._ros, home=self._home, overlays=[prefix], domain=self._domain)
        return {
            "script": str(prefix / "lib" / package / executable),
            "ros_arguments": arguments,
            "params_file": self._plan.inputs.params_file,
            "python_path": env["PYTHONPATH"].split(os.pathsep)[:1],
            "env": env,
            "install": str(install),
        }

    def run_alone(self) -> Recording:
        """Return the recording of the simulator without a node, for a plan with `alone` set.

        Raises:
            MachineError: the simulator failed.
        """
        self._limit()
        return from_json(self._answer("recording"))

    def _start(self) -> None:
        if self._in_cell:
            self._workspace, self._home, self._domain = bubblewrap.WORKSPACE, bubblewrap.HOME, None
        else:
            self._workspace = self._stack.enter_context(temporary_folder())
            self._home = self._workspace / "home"
            self._home.mkdir()
            self._domain = own_domain(self._stack)
        self._errors: IO[bytes] = self._stack.enter_context(tempfile.TemporaryFile())  # noqa: SIM115
        self._conductor = self._start_conductor()
        self._time_limit = TimeLimit(self._conductor)
        self._stack.callback(self._end)
        plan = asdict(self._plan) | {"start": [self._plan.start.x, self._plan.start.y, self._plan.start.theta]}
        where = {"home": str(self._home), "domain": self._domain}
        underlay = {"underlay": str(self._ros.underlay) if self._ros.underlay else None}
        self._send(json.dumps({**plan, **where, **underlay}).encode() + b"\n")

    def _start_conductor(self) -> ConductorProcess:
        if not self._in_cell:
            return PlainConductor(self._ros, self._home, self._domain, self._errors)
        nodes = 0 if self._plan.alone else 1 + len(self._plan.beside)
        try:
            return ConductorInRoom(self._ros, nodes, self._errors, share=self._share)
        except (HolderError, OSError) as error:
            raise _fault(str(error)) from error

    def _limit(self) -> None:
        # The grader never waits forever. The limits of the trial itself are much lower.
        self._conductor.resume()
        self._time_limit.start(120.0 + 6.0 * self._plan.duration_s)

    def _end(self) -> None:
        self._time_limit.close()
        self._conductor.close()

    def _send(self, data: bytes) -> None:
        with suppress(BrokenPipeError):  # the process has exited, and `_answer` reports the reason
            self._conductor.stdin.write(data)
            self._conductor.stdin.flush()

    def _answer(self, key: str) -> Any:  # noqa: ANN401 - JSON
        line = self._conductor.stdout.readline(MOST_ANSWER)
        answer = json.loads(line) if line.endswith(b"\n") else {}
        if "doubt" in answer:
            raise WallTimeNeeded(answer["doubt"], by_chance=answer["by_chance"])
        if key in answer:
            return answer[key]
        if "refused" in answer:
            raise _fault(answer["refused"])
        if self._node_runs:
            # The simulator worked until the node started, so the node is the cause.
            if "overwhelmed" in answer:
                raise OverwhelmedError(answer["overwhelmed"])
            if "fault" in answer:
                raise OverwhelmedError(answer["fault"])
            raise self._how_it_ended()
        ended = None if answer else self._how_it_ended()
        self._conductor.kill()
        self._errors.seek(0)
        output = answer.get("fault") or last_words(self._errors.read()[-2000:])
        if isinstance(ended, MachineError) and (self._time_limit.starved or not output):
            raise ended
        raise _fault(output or str(ended or ""))

    def _how_it_ended(self) -> OverwhelmedError | MachineError:
        try:
            code = self._conductor.wait(_ENDED_S)
        except subprocess.TimeoutExpired:
            return OverwhelmedError("it no longer responded", hung=True)
        if self._time_limit.starved:
            message = "The machine was too busy to finish the trial in time. Try again when the machine is less busy."
            return MachineError(message)
        if code != -signal.SIGKILL:
            return OverwhelmedError(f"it {how_ended(code)}")
        if self._time_limit.reached:
            return OverwhelmedError("it was still busy long after the trial should have ended", hung=True)
        return self._killed()

    def _killed(self) -> MachineError:
        """Return the error for a simulator that was killed before its time limit. In a cell, no node can kill it."""
        # A fork of which the fork server reports nothing also counts as killed (grader.trial.fork).
        how = "before the trial had ended" if self._node_runs else "or could not be started"
        if self._conductor.out_of_memory():
            why = "The kernel killed processes of the trial because too little memory was left."
        else:
            no_node = self._in_cell or not self._node_runs
            others = "another program" if no_node else "another program, such as the node,"
            why = f"Perhaps the memory of the machine was used up, or an administrator or {others} killed it."
        message = f"The simulator was killed (SIGKILL) {how}. Its time limit was not the reason. {why}"
        return MachineError(f"{message} Try again when more memory is free.")


def _fault(output: str) -> MachineError:
    """Return the error for a simulator that failed because of the machine."""
    # A complete sentence is one of the grader's messages, and says what to do.
    refused = output if output.endswith(".") else refusal_in(output)
    unknown = f"The simulator failed: {output or 'it printed nothing'}. Check this machine with `grader doctor`."
    return MachineError(f"The simulator failed. {refused}" if refused else unknown)

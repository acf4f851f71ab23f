"""Conduct one trial, in the process that contains the simulator, the recorder and the clock.

This process runs in a room of the sandbox, and the student's node in a cell inside this room (grader.sandbox). Both are
forks of fork servers (grader.trial.fork_server). Without a sandbox, both are new processes. The conductor exchanges
JSON lines with the grader's own process over its standard streams. The first line of input describes the trial. The
conductor sends {"ready": true} when the simulator and the launcher are ready. The second line of input specifies what
to start, and the install tree follows this line. The last line of output is one of these:

- {"recording": {...}};
- {"doubt": "...", "by_chance": false}: simulated time may misjudge the node (grader.trial.rest.DoubtError);
- {"overwhelmed": "..."}: the node made the simulator fail;
- {"refused": "..."}: the machine refused something, or ended a process of the grader, while the node was running;
- {"fault": "..."}: the simulator or a launcher failed for another reason.

If the trial has no node, the conductor reads only the first line, and writes only the last line.
"""

from __future__ import annotations

import json
import os
import sys
import time
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from grader.common.interpreter import interpreter
from grader.common.linux_calls import adopt_orphans
from grader.common.system_errors import refusal
from grader.ros import installation
from grader.sandbox import bubblewrap
from grader.sandbox.descendants import kill_descendants
from grader.sandbox.limits import NODE_LIMITS, limited
from grader.trial.inputs import Inputs
from grader.trial.launcher import postponed
from grader.trial.launchers import LauncherInCell, LauncherProcess, LaunchError
from grader.trial.node_group import NodeGroup
from grader.trial.node_process import NodeProcess
from grader.trial.open_files import lack, raise_limit
from grader.trial.recording import Beside, Pose
from grader.trial.recording_json import new_to_json, to_json
from grader.trial.rest import DoubtError

if TYPE_CHECKING:
    import socket

    from grader.trial.launchers import Launcher
    from grader.trial.simulated import SimulatedTrial
    from grader.trial.wall import WallTrial

LAUNCHER = Path(__file__).absolute().with_name("launcher.py")
BUSY = 0.5
BUSY_S = 0.04
"""The node itself caused a stall if its work used a processor for at least the fraction BUSY of the stall, and for at
least BUSY_S (s). The node caused all stalls if its work used a processor for at least the fraction BUSY of the trial.
The work of the node is the work of its processes and the work that it caused in the simulator."""
REQUESTS_HZ = 500
"""If the simulator answers at least this many requests (Hz), the node caused all stalls, on any machine.

If other programs keep the machine busy, the simulator and the node each get little CPU time. Therefore, CPU time alone
does not show that the node is the cause. For comparison, a node that sends three requests per pose sends 190 requests
per second.
"""
MESSAGES_HZ = 1000
"""If at least this many messages (Hz) arrive (see `_arrived`), the node caused all stalls."""
STARTED = 0.4
STARTED_LEAST = 1.2
"""The node caused all stalls if the processes that it started could use the whole machine. This is the case if the
total time for which these processes were ready to run reaches two limits: the fraction STARTED of the time of all
processors, and STARTED_LEAST times the length of the trial. A single process cannot reach both limits.
"""
SIMULATORS = ("/pose", "/color_sensor")
"""For each turtle, the simulator publishes on topics whose names end with these strings."""


LOST = (
    "A process of the grader that watches the node was killed (SIGKILL). Perhaps the memory of the machine was used "
    "up, or an administrator or another program killed it. Try again when more memory is free."
)


class Overwhelmed(Exception):  # noqa: N818 - the node is at fault, not the grader
    """The simulator failed because of messages or requests from the node."""


class RefusedError(Exception):
    """The machine refused or ended a part of the trial. The node does not count as the cause."""


def main(nodes: socket.socket | None = None) -> None:
    """Conduct the trial that is described on standard input.

    `nodes` is the socket for requesting nodes from the fork server.

    Without this socket, each node is a new process that is not in a cell.
    """
    order = json.loads(sys.stdin.buffer.readline())
    # The output of ROS 2 must not be mixed with the JSON lines.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    try:
        raise_limit()
        _conduct(order, answers, nodes)
    except DoubtError as doubt:
        _say(answers, {"doubt": str(doubt), "by_chance": doubt.by_chance})
    except LaunchError as error:
        _say(answers, {"fault": f"The node's process could not be started: {error}"})
    except Overwhelmed as error:
        _say(answers, {"overwhelmed": str(error)})
    except RefusedError as error:
        _say(answers, {"refused": str(error)})
    except Exception as error:
        _say(answers, {"fault": refusal(error) or f"{type(error).__name__}: {error}"})


def _conduct(order: dict[str, Any], answers: IO[str], nodes: socket.socket | None) -> None:
    ros = replace(installation.find_ros(), underlay=Path(order["underlay"]) if order["underlay"] else None)
    start, inputs = Pose(*order["start"]), Inputs.from_json(order["inputs"])
    prefixes = list(ros.all_prefixes)
    if order["alone"]:
        from grader.trial.without_node import AloneTrial

        alone = AloneTrial(start, prefixes, inputs).record(order["duration_s"], order["seed"])
        _say(answers, {"recording": to_json(alone)})
        return
    names = ["", *order["beside"]]
    with ExitStack() as stack:
        if nodes is None:
            adopt_orphans()
            stack.callback(kill_descendants, os.getpid())
        stack.enter_context(postponed())
        processes = [stack.enter_context(NodeProcess(_launcher(ros, order, nodes), NODE_LIMITS)) for _ in names]
        node = NodeGroup(processes)
        # Without a fork server, these imports are slow. They run here, while the launcher is importing too.
        from grader.trial.simulated import SimulatedTrial
        from grader.trial.wall import WallTrial

        trial: SimulatedTrial | WallTrial
        if order["clock"] == "simulated":
            trial = SimulatedTrial(node, start, prefixes, inputs, order["judged"], stop_at_doubt=order["stop_at_doubt"])
        else:
            trial = WallTrial(node, start, prefixes, inputs, order["judged"])
        node.await_ready()
        _say(answers, {"ready": True})
        line = sys.stdin.buffer.readline()
        if not line:
            return
        go = json.loads(line)
        node.start(go["nodes"], sys.stdin.buffer.read(go["tree_bytes"]))
        sigint_s = _run(trial, order["duration_s"])
        if any(process.lost for process in processes):
            raise RefusedError(LOST)
        first, *others = (Beside(name, *p.output(), p.end(sigint_s)) for name, p in zip(names, processes, strict=True))
        doubts = tuple(trial.doubts)
        recorder = trial.recorder
        recording = new_to_json(
            trial.frames,
            clock=order["clock"],
            why="",
            seed=order["seed"],
            start=start,
            duration_s=order["duration_s"],
            sigint_t_s=sigint_s,
            messages=tuple(recorder.messages),
            dropped=recorder.dropped,
            commands=tuple(recorder.commands),
            log=tuple(recorder.log),
            graphs=tuple(recorder.graphs),
            topics={topic: tuple(sorted(types)) for topic, types in sorted(recorder.topics.items())},
            stdout=first.stdout,
            stderr=first.stderr,
            end=first.end,
            beside=tuple(others),
            own_nodes=trial.own_nodes,
            interventions=tuple(trial.interventions),
            interventions_dropped=trial.interventions_dropped,
            graph_dropped=recorder.graph_dropped,
            calls=trial.calls,
            goals=trial.goals.goals,
            offers=recorder.offers,
            pens=trial.turtles.pens,
            tracks=trial.turtles.tracks,
            withdrawn=() if trial.keeper is None else trial.keeper.withdrawn,
            catch_from_s=None if trial.keeper is None else trial.keeper.catch_from_s,
            doubts=doubts,
            stalls=trial.unreliable or tuple(each for each in trial.stalls if not _own_doing(each, node, trial)),
            crowded=trial.crowded(),
            seconds=trial.seconds,
        )
        _say(answers, {"recording": recording})


def _run(trial: SimulatedTrial | WallTrial, duration_s: float) -> float:
    """Run the scenario, and return the time (s) of SIGINT, or of the node's exit if it exited on its own.

    The node has been started, so it is considered the cause of every failure, unless the machine allows too few open
    files.
    """
    try:
        return trial.run(duration_s)
    except (DoubtError, KeyboardInterrupt):
        raise
    except BaseException as error:
        refused = lack(error)
        if refused:
            raise RefusedError(refused) from error
        message = f"{type(error).__name__}: {error}"
        raise Overwhelmed(message[:500]) from error


def _own_doing(stall: tuple[float, float], node: NodeGroup, trial: SimulatedTrial | WallTrial) -> bool:
    """Return whether the node caused the stall, according to BUSY, REQUESTS_HZ, MESSAGES_HZ and STARTED."""
    now_s = trial.now()
    offset = time.monotonic() - now_s
    begin, end = stall
    if node.started_ready_s() >= max(STARTED_LEAST, STARTED * len(os.sched_getaffinity(0))) * now_s:
        return True
    if trial.requests >= REQUESTS_HZ * now_s or _arrived(trial) >= MESSAGES_HZ * now_s:
        return True
    if node.worked_s(offset, time.monotonic()) + trial.worked_for_node_s(0.0, now_s) >= BUSY * now_s:
        return True
    worked_s = node.worked_s(begin + offset, end + offset) + trial.worked_for_node_s(begin, end)
    return worked_s >= max(BUSY_S, BUSY * (end - begin))


def _arrived(trial: SimulatedTrial | WallTrial) -> int:
    """Return the number of recorded messages on topics other than SIMULATORS, plus all that were not recorded."""
    recorder = trial.recorder
    return recorder.dropped + sum(not message.topic.endswith(SIMULATORS) for message in recorder.messages)


def _launcher(ros: installation.Ros, order: dict[str, Any], nodes: socket.socket | None) -> Launcher:
    if nodes is not None:
        return LauncherInCell(bubblewrap.ros_view(ros, installation.FASTDDS_PROFILE), NODE_LIMITS, nodes)
    env = installation.environment(ros, home=Path(order["home"]), domain=order["domain"])
    launch, env = interpreter(str(LAUNCHER), python=str(ros.python), env=env, searches=True)
    return LauncherProcess(
        ["env", "-i", *(f"{key}={value}" for key, value in env.items()), *limited(launch, NODE_LIMITS)]
    )


def _say(answers: IO[str], what: dict[str, Any]) -> None:
    answers.write(json.dumps(what) + "\n")
    answers.flush()


if __name__ == "__main__":
    main()

"""Create a node for one verb of `ros2`, and wait until the node has discovered the whole graph, up to a deadline."""

from __future__ import annotations

import importlib
import math
import os
import signal
import sys
import time
from collections import Counter
from contextlib import ExitStack, contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import rclpy
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions

from grader.common.interrupts import stops_deferred
from grader.common.system_errors import refusal
from grader.errors import MachineError
from grader.graph.announcements import participant_ports, passed_on
from grader.graph.valid_names import ObservingNode, readable_names
from grader.ros.domain import wrong_domain
from grader.ros.failure import Ros2Error
from grader.ros.installation import FASTDDS_PROFILE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from rclpy.node import Node

QUIET_S = 0.1
"""The graph has settled only if nothing new arrives for this long (s). Time in which this process could not run does
not count."""
DEADLINE_S = 4.0
"""The maximum time (s) to wait for participants that have open ports but send nothing, for example because their
process is stopped. If the response of a node that does not use the grader's profile is lost, the node announces itself
again after 3 s (leaseAnnouncement), and then sends its endpoints."""
NOTHING_THERE_S = 0.5
"""The minimum time (s) to listen if the participants cannot be counted. The real `ros2` also listens for this time."""
LOOPBACK_PROFILE = Path(__file__).with_name("loopback.xml")
"""The Fast DDS profile for the nodes that commands create on the loopback interface."""
PATIENT_PROFILE = LOOPBACK_PROFILE.with_name("loopback_patient.xml")
"""The Fast DDS profile for nodes on the loopback interface that run for hours."""
_RANGE, _PROFILE = "ROS_AUTOMATIC_DISCOVERY_RANGE", "FASTRTPS_DEFAULT_PROFILES_FILE"
_POLL_S = 0.01
_WAKE_S = 0.1
"""The maximum time (s) that one call into rclpy may wait: Python handles Ctrl-C only after the call has returned."""
PREFIX = "_ros2cli"
_UNKNOWN = "_NODE_NAME_UNKNOWN_"


@contextmanager
def cli_node(name: str | None = None, *, use_sim_time: bool = False, patient: bool = False) -> Iterator[Node]:
    """Create a node without services, and remove it from the graph properly on exit from the context.

    Without a `name`, the node is hidden. A `patient` node announces itself less often than the nodes of other commands,
    because it runs for hours.

    Raises:
        Ros2Error: the node could not be created, for example because the domain id is wrong; or, inside the context, a
            name in the graph is not valid UTF-8.
        MachineError: the machine has no memory, files or threads left for a node.
    """
    with ExitStack() as stack:
        with stops_deferred():
            node = _create_node(name, use_sim_time, PATIENT_PROFILE if patient else LOOPBACK_PROFILE)
            stack.callback(_remove, node)
        try:
            with readable_names():
                yield node
        except ExternalShutdownException as error:
            raise KeyboardInterrupt from error


def _create_node(name: str | None, use_sim_time: bool, profile: Path) -> Node:
    domain = _domain()
    _leave_shared_memory_out(profile)
    _leave_generator_out()
    announced = passed_on(domain) if os.environ.get(_PROFILE) == str(profile) else nullcontext()
    # No log file is needed to look at the graph. Python handles the signals, since rclpy's handlers would shut down
    # the context in the middle of a verb.
    arguments = ["--ros-args", "--disable-external-lib-logs"]
    try:
        with announced:
            rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
            node = ObservingNode(
                name or f"{PREFIX}_{os.getpid()}",
                start_parameter_services=False,
                parameter_overrides=[
                    Parameter("start_type_description_service", value=False),
                    Parameter("use_sim_time", value=use_sim_time),
                ],
            )
            rclpy.get_global_executor()  # the first rclpy.spin_once would create it, and could be interrupted
    except Exception as error:
        rclpy.try_shutdown()
        lines = str(error).strip().splitlines() or [type(error).__name__]
        if refused := refusal(error):
            message = f"The ROS 2 node could not be created. {refused}"
            raise MachineError(message) from error
        message = f"The ROS 2 node could not be created: {lines[0]}"
        raise Ros2Error(message) from error
    return node


def _remove(node: Node) -> None:
    # A second Ctrl-C must not interrupt the clean-up of the node.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    node.destroy_node()
    rclpy.try_shutdown()


def _leave_shared_memory_out(profile: Path) -> None:
    """Keep Fast DDS from using shared memory with the grader's usual profile and the discovery range LOCALHOST.

    `profile` is the new profile. loopback.xml explains why `ros2` verbs use neither LOCALHOST nor shared memory.
    """
    ours = os.environ.get(_RANGE) == "LOCALHOST" and os.environ.get(_PROFILE) == str(FASTDDS_PROFILE)
    if ours and rclpy.get_rmw_implementation_identifier().startswith("rmw_fastrtps"):
        os.environ.update({_RANGE: "SYSTEM_DEFAULT", _PROFILE: str(profile)})


def _this_machine_only() -> bool:
    profiles = (str(LOOPBACK_PROFILE), str(PATIENT_PROFILE))
    return os.environ.get(_RANGE) == "LOCALHOST" or os.environ.get(_PROFILE) in profiles


def _leave_generator_out() -> None:
    """Import rosidl_generator_py without its templates and parser, which take a seventh of a verb's start-up time.

    Message modules need only one small function of rosidl_generator_py. If `em` is not installed, rosidl_generator_py
    itself omits the other functions.
    """
    if "em" not in sys.modules:
        sys.modules["em"] = None  # type: ignore[assignment]
        importlib.import_module("rosidl_generator_py")
        del sys.modules["em"]


def _domain() -> int:
    """Return the domain id. Raise Ros2Error if the id is invalid, because Fast DDS would terminate the process."""
    message = wrong_domain(os.environ)
    if message:
        raise Ros2Error(message)
    return int(os.environ.get("ROS_DOMAIN_ID", "") or "0")


class Settling:
    """Waits until nothing new appears in the graph that a node sees, up to a deadline."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._begun = self._read = time.monotonic()
        self._quiet_s = 0.0
        self._graph: Counter[object] = Counter()

    def observe(self, due_s: float = math.inf) -> None:
        """Read the graph, and record whether anything has appeared since the last reading.

        At most `due_s` (s) of the time since the last reading counts as quiet. On a busy machine, a short wait takes
        longer than requested, and other processes have to wait too.
        """
        graph, now = _graph(self._node), time.monotonic()
        self._quiet_s = 0.0 if graph - self._graph else self._quiet_s + min(due_s, now - self._read)
        self._graph, self._read = graph, now

    def settle(self, enough: Callable[[], bool] = lambda: False, deadline_s: float | None = None) -> bool:
        """Wait until nothing new has arrived for 0.1 s and all participants on this machine have sent their data.

        If nodes on other machines can take part, or the number of participants on this machine is unknown, also wait at
        least NOTHING_THERE_S, or `deadline_s` if it is set.

        The wait ends earlier if `enough` returns true. `deadline_s` is the maximum waiting time (s), or None for the
        default. Return False if the deadline passes first.
        """
        begun = time.monotonic()
        most = deadline_s if deadline_s is not None else DEADLINE_S
        self.observe()
        while True:
            now = time.monotonic()
            if enough():
                return True
            if self._quiet_s >= QUIET_S and _complete(self._node, now - self._begun, deadline_s):
                return True
            if now - begun >= most:
                return False
            time.sleep(_POLL_S)
            self.observe(_POLL_S)


def settle(node: Node, enough: Callable[[], bool] = lambda: False, deadline_s: float | None = None) -> bool:
    """Wait until the graph of a new node has settled or `enough` returns true.

    Return False if the deadline passes first.
    """
    return Settling(node).settle(enough, deadline_s)


def published(node: Node, topic: str) -> bool:
    """Return whether a node other than the given node publishes on the topic.

    The given node itself is ignored, because every node publishes on /rosout.
    """
    own = node.get_name()
    return any(publisher.node_name != own for publisher in node.get_publishers_info_by_topic(topic))


def spin_until(
    node: Node, done: Callable[[], bool], timeout_s: float | None = None, *, defer_stops: bool = False
) -> bool:
    """Spin the node until `done` returns true or the timeout expires. Return False after a timeout.

    With `defer_stops`, no signal interrupts a callback, so no response is lost. A callback must not wait for long.
    """
    end = None if timeout_s is None else time.monotonic() + timeout_s
    while not done():
        left = _WAKE_S if end is None else min(_WAKE_S, end - time.monotonic())
        if left <= 0:
            return False
        with stops_deferred() if defer_stops else nullcontext():
            rclpy.spin_once(node, timeout_sec=left)
    return True


def wait_until_acknowledged(publishers: Iterable[Any], timeout_s: float, usual_s: float) -> None:
    """Wait until all reliable subscriptions have received the last messages of the publishers, up to a timeout.

    A subscription that has not discovered the publisher yet, for example because its process is waiting for a
    processor, loses the messages if the publisher leaves the graph. With a profile of the user, acknowledgements may
    take up to 3 s, and the timeout is `usual_s`.
    """
    prompt = os.environ.get(_PROFILE) in (str(LOOPBACK_PROFILE), str(FASTDDS_PROFILE))
    end = time.monotonic() + (timeout_s if prompt else usual_s)
    for publisher in publishers:
        left = min(usual_s, _WAKE_S)
        while left > 0 and not publisher.wait_for_all_acked(Duration(seconds=left)):
            left = min(end - time.monotonic(), _WAKE_S)


def nap(duration_s: float) -> None:
    """Sleep. Unlike a wait inside rclpy, the sleep ends immediately when the user presses Ctrl-C."""
    if duration_s > 0:
        time.sleep(duration_s)


def _graph(node: Node) -> Counter[object]:
    """Return a counter of everything that can appear during the discovery of the graph."""
    graph: Counter[object] = Counter(node.get_node_names_and_namespaces())
    for name, types in node.get_topic_names_and_types():
        graph.update({(name, *types): 1, (name, "publishers"): node.count_publishers(name)})
        graph.update({(name, "subscriptions"): node.count_subscribers(name)})
    graph.update((name, "service", *types) for name, types in node.get_service_names_and_types())
    return graph


def _complete(node: Node, waited_s: float, named_s: float | None = None) -> bool:
    """Return whether all participants on this machine have been discovered, including the names of their nodes.

    Participants on other machines cannot be counted. If they can take part, the discovery is complete only after
    `named_s` (s), the waiting time that the user has set, or after NOTHING_THERE_S if it is None.
    """
    expected = len(participant_ports(node.context.get_domain_id()))
    endpoints: list[Any] = []
    for name, _ in node.get_topic_names_and_types():
        endpoints += node.get_publishers_info_by_topic(name)
        endpoints += node.get_subscriptions_info_by_topic(name)
    ids = {bytes(endpoint.endpoint_gid[:12]) for endpoint in endpoints}
    if any(endpoint.node_name == _UNKNOWN for endpoint in endpoints):
        return False
    if not expected or not _this_machine_only():
        return waited_s >= (NOTHING_THERE_S if named_s is None else named_s) and len(ids) >= expected
    return len(ids) >= expected

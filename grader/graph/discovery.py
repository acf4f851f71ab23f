"""A node for one verb, and waiting until it has seen the whole graph: by what arrives, with a deadline."""

from __future__ import annotations

import importlib
import os
import signal
import sys
import time
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.parameter import Parameter
from rclpy.signals import SignalHandlerOptions

from grader.ros.failure import Ros2Error
from grader.ros.installation import FASTDDS_PROFILE

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rclpy.node import Node

QUIET_S = 0.2
"""The graph has settled when nothing new was heard for this long."""
DEADLINE_S = 4.0
"""For participants that are there (their ports are open) but say nothing, as a stopped process. A node without our
profile whose answer was lost announces itself 3 s later (leaseAnnouncement), and then tells its endpoints."""
NOTHING_THERE_S = 0.5
"""How long to listen where it cannot be known whether anybody is there: as long as the real one does."""
LOOPBACK_PROFILE = Path(__file__).with_name("loopback.xml")
"""How the nodes of the commands hear others of this machine."""
PATIENT_PROFILE = LOOPBACK_PROFILE.with_name("loopback_patient.xml")
"""The same for a node that runs for hours."""
_RANGE, _PROFILE = "ROS_AUTOMATIC_DISCOVERY_RANGE", "FASTRTPS_DEFAULT_PROFILES_FILE"
_POLL_S = 0.01
_WAKE_S = 0.1
"""Python's own handling of Ctrl-C waits for calls into rclpy to return."""
HIGHEST_DOMAIN = 232
"""Beyond it there are no ports (DDSI-RTPS, 9.6.1)."""
PREFIX = "_ros2cli"
_UNKNOWN = "_NODE_NAME_UNKNOWN_"


@contextmanager
def cli_node(name: str | None = None, *, use_sim_time: bool = False, patient: bool = False) -> Iterator[Node]:
    """A hidden node that offers nothing. It leaves in order, so that others do not go on seeing it.

    A `patient` node announces itself seldom: it is to run for hours.

    Raises:
        Ros2Error: it could not be made: say, the domain id is wrong.
    """
    _check_domain()
    _leave_shared_memory_out(PATIENT_PROFILE if patient else LOOPBACK_PROFILE)
    _leave_generator_out()
    # No log file for a look at the graph. Signals stay Python's, since rclpy's shut down in the middle of a verb.
    arguments = ["--ros-args", "--disable-external-lib-logs"]
    try:
        rclpy.init(args=arguments, signal_handler_options=SignalHandlerOptions.NO)
        node = rclpy.create_node(
            name or f"{PREFIX}_{os.getpid()}",
            start_parameter_services=False,
            parameter_overrides=[
                Parameter("start_type_description_service", value=False),
                Parameter("use_sim_time", value=use_sim_time),
            ],
        )
    except Exception as error:
        rclpy.try_shutdown()
        told = str(error).strip().splitlines() or [type(error).__name__]
        message = f"No ROS 2 node could be made: {told[0]}"
        raise Ros2Error(message) from error
    try:
        yield node
    except ExternalShutdownException as error:
        raise KeyboardInterrupt from error
    finally:
        # A second Ctrl-C must not leave half a node behind.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        node.destroy_node()
        rclpy.try_shutdown()


def _leave_shared_memory_out(profile: Path) -> None:
    """Under LOCALHOST, rmw_fastrtps adds shared memory whatever a profile says; loopback.xml says why not here."""
    if os.environ.get(_RANGE) == "LOCALHOST" and os.environ.get(_PROFILE) == str(FASTDDS_PROFILE):
        os.environ.update({_RANGE: "SYSTEM_DEFAULT", _PROFILE: str(profile)})


def _this_machine_only() -> bool:
    profiles = (str(LOOPBACK_PROFILE), str(PATIENT_PROFILE))
    return os.environ.get(_RANGE) == "LOCALHOST" or os.environ.get(_PROFILE) in profiles


def _leave_generator_out() -> None:
    """Import rosidl_generator_py without its templates and parser, a seventh of what a verb computes before it listens.

    Message modules take one small function from it, and it does without the rest where `em` is not installed.
    """
    if "em" not in sys.modules:
        sys.modules["em"] = None  # type: ignore[assignment]
        importlib.import_module("rosidl_generator_py")
        del sys.modules["em"]


def _check_domain() -> None:
    """Say what is wrong with a domain id; Fast DDS would end the process."""
    text = os.environ.get("ROS_DOMAIN_ID", "") or "0"
    if not text.isdecimal() or int(text) > HIGHEST_DOMAIN:
        message = f"ROS_DOMAIN_ID is '{text}'; a whole number from 0 to {HIGHEST_DOMAIN} was expected"
        raise Ros2Error(message)


class Settling:
    """Whether the graph that a node sees has come to rest: by what arrives, with a deadline."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._begun = self._changed = time.monotonic()
        self._seen: object = None

    def observe(self) -> None:
        """Look whether anything has changed since the last look."""
        graph = _graph(self._node)
        if graph != self._seen:
            self._seen, self._changed = graph, time.monotonic()

    def settle(self, enough: Callable[[], bool] = lambda: False, deadline_s: float | None = None) -> bool:
        """Wait until nothing new came for 0.2 s and all participants of this machine have told what they have.

        `enough` ends the wait earlier. `deadline_s` is the longest wait, if the caller named one. Returns whether that
        was so in time.
        """
        begun = time.monotonic()
        most = deadline_s if deadline_s is not None else DEADLINE_S
        while True:
            self.observe()
            now = time.monotonic()
            if enough():
                return True
            if now - self._changed >= QUIET_S and _complete(self._node, now - self._begun, deadline_s):
                return True
            if now - begun >= most:
                return False
            time.sleep(_POLL_S)


def settle(node: Node, enough: Callable[[], bool] = lambda: False, deadline_s: float | None = None) -> bool:
    """Wait until the graph that a new node sees has settled, or until it is `enough`; returns whether in time."""
    return Settling(node).settle(enough, deadline_s)


def published(node: Node, topic: str) -> bool:
    """Whether anybody else publishes on a topic; the node itself does so on /rosout."""
    own = node.get_name()
    return any(publisher.node_name != own for publisher in node.get_publishers_info_by_topic(topic))


def spin_until(node: Node, done: Callable[[], bool], timeout_s: float | None = None) -> bool:
    """Handle what comes until it is `done` or the time is up; returns whether it is done."""
    end = None if timeout_s is None else time.monotonic() + timeout_s
    while not done():
        left = _WAKE_S if end is None else min(_WAKE_S, end - time.monotonic())
        if left <= 0:
            return False
        rclpy.spin_once(node, timeout_sec=left)
    return True


def nap(duration_s: float) -> None:
    """Sleep; a signal ends it at once, unlike a wait inside rclpy."""
    if duration_s > 0:
        time.sleep(duration_s)


def _graph(node: Node) -> object:
    """All that can change while the graph is being heard of."""
    topics = node.get_topic_names_and_types()
    counts = [(name, node.count_publishers(name), node.count_subscribers(name)) for name, _ in topics]
    return (sorted(node.get_node_names_and_namespaces()), topics, counts, node.get_service_names_and_types())


def _complete(node: Node, waited_s: float, named_s: float | None = None) -> bool:
    """Whether as many participants were heard of as there are on this machine, and each told the names of its nodes.

    Those of other machines cannot be counted: the wait for them is as long as the user named, `named_s`.
    """
    expected = _participants(node.context.get_domain_id())
    endpoints: list[Any] = []
    for name, _ in node.get_topic_names_and_types():
        endpoints += node.get_publishers_info_by_topic(name)
        endpoints += node.get_subscriptions_info_by_topic(name)
    heard = {bytes(endpoint.endpoint_gid[:12]) for endpoint in endpoints}
    if any(endpoint.node_name == _UNKNOWN for endpoint in endpoints):
        return False
    if expected is None or not _this_machine_only():
        return waited_s >= (NOTHING_THERE_S if named_s is None else named_s) and len(heard) >= (expected or 0)
    return len(heard) >= expected


def _participants(domain: int) -> int | None:
    """How many DDS participants this machine has in a domain: each opens a port of its own; None if unknown.

    Ports by the DDSI-RTPS standard, 9.6.1.1: metatraffic unicast = 7400 + 250 * domain + 10 + 2 * participant.
    """
    first = 7400 + 250 * domain
    ports: set[int] = set()
    for table in ("/proc/net/udp", "/proc/net/udp6"):
        try:
            rows = Path(table).read_text("ascii").splitlines()[1:]
        except OSError:
            continue
        ports.update(int(row.split()[1].rpartition(":")[2], 16) - first for row in rows)
    found = {port for port in ports if 10 <= port < 250 and port % 2 == 0}
    return len(found) or None

"""When learners check their own work, the fork server for conductors is a fork of the one for nodes."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
from dataclasses import replace

import pytest

from grader.common.interpreter import Start, interpreter
from grader.errors import MachineError
from grader.ros import installation
from grader.ros.installation import find_ros
from grader.ros.underlay import with_turtlesim
from grader.sandbox import bubblewrap
from grader.tests.trial.forks import WALL, forks, kill, mapped, run
from grader.tests.waiting import HANG_S, only_child, until_gone
from grader.trial import fork_client
from grader.trial.trial import Trial

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")
CHECKED = """
import os
os.environ["ROS_PYTHON_CHECK_FIELDS"] = "1"
from std_msgs.msg import String
from grader.trial import fork_server
fork_server._set_environment({"ROS_PYTHON_CHECK_FIELDS": "0"})
print(String(data=5).data)
"""
FORKED = """
import os, socket, sys
from grader.trial import conductor, fork_server
os.dup2(1, fork_server.NODES_SOCKET)
orders = iter([({"conductors": {"ROS_PYTHON_CHECK_FIELDS": "0"}}, [os.dup(1), os.dup(1)]), ({}, [])])
fork_server._next_order = lambda requests: next(orders)
fork_server._try = lambda import_: ([], "")
fork_server._enter_room = lambda order, problem: None
conductor.main = lambda nodes: print(os.environ["ROS_PYTHON_CHECK_FIELDS"], flush=True)
os.environ["ROS_PYTHON_CHECK_FIELDS"] = "1"
sys.argv = ["", "node", str(os.dup(1))]
fork_server.main()
"""


def python(code: str) -> Start:
    """Return the start of a Python that imports from the ROS 2, as a fork server does."""
    env = installation.environment(find_ros(), home=fork_client.NOBODYS_HOME, domain=None)
    return interpreter("-c", code, env=env, searches=True)


def test_the_conductor_and_the_node_are_forks_of_one_import() -> None:
    with Trial(WALL, with_turtlesim(find_ros()), in_cell=True, share=True) as trial:
        trial.await_ready()
        conductor, node = forks(trial)
        assert mapped(conductor) == mapped(node)


def test_nodes_check_the_values_in_messages() -> None:
    stderr = run("#!/usr/bin/env python3\nfrom std_msgs.msg import String\nString(data=5)\n", share=True).stderr.text
    assert "AssertionError: The 'data' field must be of type 'str'" in stderr


def test_conductors_do_not_check_the_values_in_messages() -> None:
    start = python(CHECKED)
    done = subprocess.run(start.argv, env=start.env, capture_output=True, text=True, check=False, timeout=HANG_S)
    assert done.stdout == "5\n", done.stderr


def test_a_server_for_conductors_has_their_environment_although_it_is_a_fork_of_the_one_for_nodes() -> None:
    ours, theirs = socket.socketpair()
    start = python(FORKED)
    with ours, theirs:
        done = subprocess.run(
            start.argv, env=start.env, stdout=theirs.fileno(), stderr=subprocess.PIPE, check=False, timeout=HANG_S
        )
        theirs.close()
        assert (ours.recv(64), done.returncode) == (b"0\n", 0), done.stderr.decode()


def test_a_forked_server_ends_with_the_server_that_forked_it_and_both_are_started_again() -> None:
    for _ in range(2):
        assert run("#!/usr/bin/env python3\nprint('again')\n", share=True).stdout.text == "again\n"
        server = fork_client.nodes(with_turtlesim(find_ros()))
        assert server._process is not None
        forked = only_child(server._process.pid)
        assert os.getsid(forked) == forked, "a signal to the process group of one server reaches the other"
        kill(server)
        until_gone(forked)


@pytest.mark.parametrize("share", [False, True])
def test_a_node_is_not_blamed_if_its_server_is_killed(*, share: bool) -> None:
    server = fork_client.nodes(with_turtlesim(find_ros()))
    script = "#!/usr/bin/env python3\nimport time\ntime.sleep(600.0)\n"
    with pytest.raises(MachineError, match=r"^The simulator (failed\. A process .*|)was killed \(SIGKILL\)"):
        run(script, replace(WALL, duration_s=HANG_S), share=share, meanwhile=lambda: kill(server))


def test_a_fork_counts_as_killed_if_the_server_ends_before_the_request() -> None:
    """The server for nodes closes the socket if it cannot fork the server for conductors: too many processes."""
    ended = fork_client.ForkServer(lambda _: None)
    assert ended.request({}, []).wait(HANG_S) == -signal.SIGKILL

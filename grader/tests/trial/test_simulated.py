from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from grader.ros.installation import FASTDDS_PROFILE

if TYPE_CHECKING:
    from grader.tests.in_ros import InRos


def test_between_the_announcements_of_two_participants_there_is_silence_however_they_fall(in_ros: InRos) -> None:
    (period,) = ET.parse(FASTDDS_PROFILE).iterfind(".//{*}leaseAnnouncement")
    parts = [int(period.findtext(f"{{*}}{name}") or 0) for name in ("sec", "nanosec")]
    assert 0 < in_ros.run("trial.scenarios:quiet_s").result < (parts[0] + parts[1] / 1e9) / 2


def test_a_late_node_and_another_process_are_in_doubt(in_ros: InRos) -> None:
    assert in_ros.run("trial.scenarios:what_is_in_doubt").result == {
        "late": ["the node computes for so long that it would be late in wall time", True],
        "another process": ["the node has started another process, which may need wall time", False],
        "another process at the end": None,
        "nothing": None,
    }

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

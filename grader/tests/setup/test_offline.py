from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.setup import machine

if TYPE_CHECKING:
    from pathlib import Path

ROUTES = "Iface Destination Gateway\n"
LOOPBACK = "0" * 32 + " 00 00000001 lo\n"


@pytest.mark.parametrize(
    ("ipv4", "ipv6", "env", "offline"),
    [
        ("", LOOPBACK, {}, True),
        ("eth0 00000000 0102A8C0\n", LOOPBACK, {}, False),
        ("", LOOPBACK + "0" * 32 + " 00 00000001 wlan0\n", {}, False),
        ("", LOOPBACK, {"https_proxy": "http://127.0.0.1:3128"}, False),
        ("", LOOPBACK, {"PIP_FIND_LINKS": "/opt/wheels"}, False),
    ],
)
def test_a_machine_without_a_route_is_offline(
    tmp_path: Path, ipv4: str, ipv6: str, env: dict[str, str], offline: bool
) -> None:
    (tmp_path / "proc/net").mkdir(parents=True)
    (tmp_path / "proc/net/route").write_text(ROUTES + ipv4)
    (tmp_path / "proc/net/ipv6_route").write_text(ipv6)
    assert machine.is_offline({"HOME": str(tmp_path), **env}, tmp_path) is offline
    (tmp_path / "etc").mkdir()
    (tmp_path / "etc/pip.conf").touch()
    assert not machine.is_offline({"HOME": str(tmp_path), **env}, tmp_path)

"""The installed packages and interfaces, as read from the ament index."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.ros import index
from grader.ros.failure import Ros2Error

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def prefix(tmp_path: Path) -> Path:
    """Create a prefix with a package that has a message and a service."""
    for kind, text in (("packages", ""), ("rosidl_interfaces", "msg/Box.msg\nsrv/Open.srv\n")):
        file = tmp_path / "share/ament_index/resource_index" / kind / "things"
        file.parent.mkdir(parents=True)
        file.write_text(text)
    return tmp_path


@pytest.mark.parametrize("value", ["", ":", None])
def test_the_current_folder_is_not_a_prefix(prefix: Path, value: str | None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(prefix)
    if value is None:
        monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    else:
        monkeypatch.setenv("AMENT_PREFIX_PATH", value)
    assert index.prefixes() == []
    assert not index.has_package("things")


@pytest.mark.parametrize("name", ["things/msg/Open", "things/msg/Opn", "things/srv/Ope"])
def test_a_suggested_interface_exists(prefix: Path, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    with pytest.raises(Ros2Error, match="Did you mean 'things/srv/Open'"):
        index.interface_file(name)


def test_an_interface_is_installed_if_its_file_exists(prefix: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    for file in ("msg/Box.msg", "srv/Open.idl"):
        path = prefix / "share/things" / file
        path.parent.mkdir(parents=True)
        path.write_text("")
    assert index.has_interface("things", "msg", "Box")
    assert index.has_interface("things", "srv", "Open")
    assert index.has_interface("things", "srv", "Open_Request")
    assert not index.has_interface("things", "msg", "Open")
    assert not index.has_interface("things/msg/..", "msg", "../msg/Box")

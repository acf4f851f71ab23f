"""The class of a message or service type whose name a submission chose."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import pytest
from geometry_msgs.msg import Twist
from std_srvs.srv import SetBool

from grader.trial.interface_class import load_class

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def prefix(tmp_path: Path) -> Path:
    """Return a prefix with the interface files of Twist and SetBool."""
    for name in ("geometry_msgs/msg/Twist.msg", "std_srvs/srv/SetBool.srv"):
        file = tmp_path / "share" / name
        file.parent.mkdir(parents=True)
        file.touch()
    return tmp_path


def test_an_installed_type_is_loaded(prefix: Path) -> None:
    assert load_class("geometry_msgs/msg/Twist", "msg", [prefix]) is Twist
    assert load_class("std_srvs/srv/SetBool", "srv", [prefix]) is SetBool


@pytest.mark.parametrize(
    ("type_name", "kind"),
    [
        ("geometry_msgs/msg/Twist", "srv"),
        ("std_srvs/srv/SetBool", "msg"),
        ("this/msg/Path", "msg"),
        ("../msg/Path", "msg"),
        ("a.b/msg/Path", "msg"),
        ("geometry_msgs/Twist", "msg"),
        ("geometry_msgs/msg/Twist ", "msg"),
        ("", "msg"),
    ],
)
def test_no_other_name_is_imported(prefix: Path, type_name: str, kind: str) -> None:
    before = set(sys.modules)
    assert load_class(type_name, kind, [prefix]) is None  # type: ignore[arg-type]
    assert set(sys.modules) == before

"""The command that an error of a bag suggests can be typed as it stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.ros.failure import Ros2Error
from grader.ros2.bag.bag_reader import open_bag

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(("name", "quote"), [("bag", ""), ("my bag", "'")])
def test_an_interrupted_bag_names_a_command_that_finds_it(tmp_path: Path, name: str, quote: str) -> None:
    bag = tmp_path / name
    bag.mkdir()
    (bag / "bag_0.mcap").touch()
    with pytest.raises(Ros2Error) as error, open_bag(bag):
        pass
    assert str(error.value).endswith(f"ros2 bag reindex {quote}{bag}{quote}")

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from grader.tests.shared import made_once

if TYPE_CHECKING:
    from pathlib import Path

    import pytest


def test_a_shared_folder_is_created_only_once(tmp_path_factory: pytest.TempPathFactory) -> None:
    made: list[Path] = []

    def make(folder: Path) -> list[int]:
        made.append(folder)
        (folder / "file").write_text("made")
        return [1, 2]

    both = [made_once(tmp_path_factory, "of-this-test", make) for _ in range(2)]
    assert both[0] == both[1]
    assert both[0][1] == [1, 2]
    assert (both[0][0] / "file").read_text() == "made"
    assert json.loads((both[0][0] / "made.json").read_text()) == [1, 2]
    assert len(made) == 1

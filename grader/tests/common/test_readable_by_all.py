from __future__ import annotations

from typing import TYPE_CHECKING

from grader.common.readable_by_all import make_readable

if TYPE_CHECKING:
    from pathlib import Path


def test_every_user_may_read_the_files_and_run_the_programs(tmp_path: Path) -> None:
    folder = tmp_path / "grader"
    folder.mkdir(mode=0o700)
    for name, mode in {"module.py": 0o600, "program": 0o700}.items():
        (folder / name).touch()
        (folder / name).chmod(mode)
    (tmp_path / "mine").touch(mode=0o600)
    (folder / "link").symlink_to(tmp_path / "mine")
    make_readable(folder)
    modes = {path.name: path.stat().st_mode & 0o777 for path in [folder, *folder.iterdir()]}
    assert modes == {"grader": 0o755, "module.py": 0o644, "program": 0o755, "link": 0o600}

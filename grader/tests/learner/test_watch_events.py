"""Events of a watched package: saves with every kind of editor, and keys."""

from __future__ import annotations

import shutil
import threading
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.learner import watch
from grader.learner.watch import Events, folders
from grader.tests.waiting import HANG_S, until

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def package(tmp_path: Path) -> Path:
    solution = ROOT / "solutions" / "03-circle-publisher" / "my_robot_controller"
    return Path(shutil.copytree(solution, tmp_path / "my_robot_controller"))


def node_of(package: Path) -> Path:
    return package / "my_robot_controller" / "draw_circle.py"


@pytest.mark.parametrize("how", ["write", "rename", "delete", "create"])
def test_a_save_is_noticed_with_every_kind_of_editor(package: Path, how: str) -> None:
    node = node_of(package)
    saves: dict[str, Callable[[], object]] = {
        "write": lambda: node.write_text("x = 1\n"),
        "rename": lambda: (package / "draw.tmp").replace(node),
        "delete": node.unlink,
        "create": lambda: (node.parent / "new.py").write_text(""),
    }
    (package / "draw.tmp").write_text("x = 2\n")
    events = Events(None)
    events.watch(package)
    heard = iter(events)
    assert next(heard).kind == "saved"  # every save is noticed after this event
    saves[how]()
    assert next(heard).kind == "saved"
    events.close()


def test_watching_follows_the_path_when_another_folder_takes_it(package: Path) -> None:
    events = Events(None)
    events.watch(package)
    happened = iter(events)
    assert next(happened).kind == "saved"
    kept = package.with_name("kept-aside")
    package.rename(kept)
    assert next(happened).kind == "saved"  # the file was removed
    shutil.copytree(kept, package.with_name("another")).rename(package)
    assert next(happened).kind == "saved"  # another file took its name
    node_of(package).write_text("x = 1\n")
    assert next(happened).kind == "saved"
    events.close()


def test_a_folder_that_is_removed_as_soon_as_it_is_watched_is_a_save(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    yielded = threading.Event()
    calls: list[Path] = []

    def removed(top: Path) -> list[str]:
        if top != package:  # the watcher of an earlier test, which is just ending
            return folders(top)
        calls.append(top)
        if len(calls) == 2:
            yielded.wait(HANG_S)
            package.rename(package.with_name("kept-aside"))
        return folders(top)

    monkeypatch.setattr(watch, "folders", removed)
    events = Events(None)
    events.watch(package)
    happened = iter(events)
    assert next(happened).kind == "saved"
    yielded.set()
    assert next(happened).kind == "saved"
    events.close()


def test_a_save_in_a_new_folder_is_noticed(package: Path) -> None:
    events = Events(None)
    events.watch(package)
    happened = iter(events)
    assert next(happened).kind == "saved"
    file = package / "new" / "below" / "module.py"
    file.parent.mkdir(parents=True)
    assert next(happened).kind == "saved"
    until(lambda: str(file.parent) in events.watched)
    while events.waiting():
        next(happened)
    file.write_text("x = 1\n")
    assert next(happened).kind == "saved"
    events.close()


def test_links_and_endless_folders_do_not_use_up_the_watches_of_the_user(
    package: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (package / "everything").symlink_to("/")
    (package / "itself").symlink_to(package)
    (package / "build" / "of colcon").mkdir(parents=True)
    own = [str(each) for each in (package, *package.rglob("*")) if each.is_dir() and not each.is_symlink()]
    assert sorted(folders(package)) == sorted(each for each in own if "/build" not in each)
    monkeypatch.setattr("grader.learner.watch.MOST_FOLDERS", 2)
    assert len(folders(package)) == 2


def test_keys_come_in_order_and_the_end_of_input_ends_the_loop() -> None:
    keys = iter(["h", "r", ""])
    assert [happened.key for happened in Events(lambda: next(keys))] == ["h", "r"]


def test_waiting_saves_become_one_and_a_key_after_them_is_kept(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    saved, reported = threading.Event(), threading.Event()

    def watch(*_: object, stop_event: threading.Event, **__: object) -> Iterator[set[str]]:
        yield from ({"first"}, {"second"})
        saved.set()
        stop_event.wait()  # without this, the folder would be watched again, and another save would be reported

    def keys() -> Iterator[str]:
        assert saved.wait(HANG_S)
        yield "h"
        reported.set()
        yield ""

    monkeypatch.setattr("grader.learner.watch.watch", watch)
    events = Events(partial(next, keys()))
    events.watch(package)
    with closing(events):
        assert reported.wait(HANG_S)
        assert [happened.kind for happened in events] == ["saved", "key"]

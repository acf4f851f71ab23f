"""If a user names a pipe, a device, a folder or a damaged file, the command says so in one sentence."""

from __future__ import annotations

import argparse
import io
import os
import re
import shutil
import signal
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, NoReturn

import pytest

from grader.ros import message_values
from grader.ros.failure import Ros2Error
from grader.ros2 import given_file
from grader.ros2.bag import convert
from grader.ros2.bag.bag_reader import open_bag
from grader.ros2.bag.recovery import recover
from grader.ros2.given_file import standard_input, why_not
from grader.ros2.param import load
from grader.tests import made_bag
from grader.tests.ros2.world import World, world
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

HEAD = "rosbag2_bagfile_information:\n  compression_format: ''\n"


@pytest.fixture(autouse=True)
def _limited() -> Iterator[None]:
    """Fail instead of waiting for ever on a pipe."""

    def late(*_: object) -> NoReturn:
        message = "still waiting"
        raise TimeoutError(message)

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(round(HANG_S))
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a bag with 20 poses."""
    folder = tmp_path_factory.mktemp("good") / "bag"
    made_bag.record(folder, made_bag.poses()[:20])
    return folder


@pytest.fixture
def bag(good: Path, tmp_path: Path) -> Path:
    """Return a copy of the bag."""
    return Path(shutil.copytree(good, tmp_path / "bag"))


@pytest.fixture
def quiet(tmp_path: Path) -> Iterator[World]:
    """Create a world in which no node is running."""
    yield from world(tmp_path)


def _change(bag: Path, pattern: str, value: str) -> None:
    metadata = bag / "metadata.yaml"
    changed, times = re.subn(pattern, rf"\g<1>{value}", metadata.read_text(), count=1)
    assert times == 1
    metadata.write_text(changed)


def _piped(file: Path) -> None:
    file.unlink(missing_ok=True)
    os.mkfifo(file)


def _endless(file: Path) -> None:
    file.unlink()
    file.symlink_to("/dev/zero")


def _fold(file: Path) -> None:
    file.unlink()
    file.mkdir()


def _fill(file: Path) -> None:
    os.truncate(file, given_file.MOST_BYTES + 1)


@pytest.mark.parametrize(
    ("name", "harm", "expected"),
    [
        ("metadata.yaml", _piped, "metadata.yaml: it is a named pipe, not a file"),
        ("metadata.yaml", _endless, "metadata.yaml: it is a device, not a file"),
        ("metadata.yaml", _fold, "metadata.yaml: it is a folder, not a file"),
        ("metadata.yaml", _fill, "metadata.yaml: it has more than 10 MB"),
        ("bag.mcap", _piped, "bag.mcap: it is a named pipe, not a file"),
        ("bag.mcap", _endless, "bag.mcap: it is a device, not a file"),
    ],
)
def test_a_bag_of_something_else_than_files_is_refused(
    bag: Path, name: str, harm: Callable[[Path], None], expected: str
) -> None:
    harm(bag / name)
    with pytest.raises(Ros2Error, match=re.escape(f"The bag '{bag}' cannot be read: {expected}")), open_bag(bag):
        pass


def test_a_pipe_that_only_the_metadata_name_is_refused(bag: Path) -> None:
    _piped(bag / "pipe")
    _change(bag, r"(relative_file_paths:\n\s*- )\S+", "pipe")
    with pytest.raises(Ros2Error, match="pipe: it is a named pipe, not a file"), open_bag(bag):
        pass


@pytest.mark.parametrize("file", [_piped, _endless, _fold])
def test_reindex_and_one_file_of_a_bag_do_not_wait(bag: Path, file: Callable[[Path], None]) -> None:
    data = bag / "bag.mcap"
    file(data)
    with pytest.raises(Ros2Error, match=r"bag.mcap' cannot be read: it is .*, not a file"):
        recover(bag)
    with pytest.raises(Ros2Error, match=r"not a file|No metadata\.yaml"), open_bag(data):
        pass
    assert os.path.lexists(data)


@pytest.mark.parametrize(
    ("pattern", "value", "expected"),
    [
        (r"(duration:\n\s+nanoseconds: )\d+", ".nan", "the duration is not a number from 0 to 2**63 - 1: nan"),
        (r"(duration:\n\s+nanoseconds: )\d+", "-5", "the duration is not a number from 0 to 2**63 - 1: -5"),
        (r"(duration:\n\s+nanoseconds: )\d+", "9" * 40, "the duration is not a number from 0 to 2**63 - 1: 999999"),
        (r"(\n  starting_time:\n\s+nanoseconds_since_epoch: )\d+", ".inf", "the start is not a number"),
        (r"(\n  message_count: )\d+", "1.5", "the number of messages is not a number"),
        (r"(\n  - message_count: )\d+", "[1]", "the number of messages on /turtle1/pose is not a number"),
        (r"( name: )\S+", "5", "the name of a topic is not a string: 5"),
        (r"( name: )\S+", "[a, b]", "the name of a topic is not a string: ['a', 'b']"),
        (r"( type: )\S+", "null", "the type of a topic is not a string: None"),
    ],
)
def test_values_that_do_not_describe_a_bag_are_named(bag: Path, pattern: str, value: str, expected: str) -> None:
    _change(bag, pattern, value)
    with pytest.raises(Ros2Error, match=re.escape(f"The bag '{bag}' cannot be read: {expected}")), open_bag(bag):
        pass


def test_a_good_bag_and_its_file_are_read(bag: Path) -> None:
    (bag / "broken link").symlink_to("nowhere")
    for path in (bag, bag / "bag.mcap"):
        with open_bag(path) as reader:
            assert reader.message_count == 20


def test_a_topic_with_an_invalid_name_is_ignored(quiet: World) -> None:
    record = made_bag.poses()[:20]
    made_bag.record(quiet.home / "bag", [*record, *made_bag.commands(0.3)])
    for name in ("metadata.yaml", "bag.mcap"):
        file = quiet.home / "bag" / name
        file.write_bytes(file.read_bytes().replace(b"/turtle1/cmd_vel", b"/turtle1/cmd-vel"))
    done = quiet.run("ros2 bag play bag --rate 10")
    assert "Ignoring a topic '/turtle1/cmd-vel', reason: Invalid topic name: topic name must not contain" in done.stderr
    assert done.code == 0
    done = quiet.run("ros2 bag play bag --topics /turtle1/cmd-vel")
    assert "None of the selected topics can be published." in done.stderr
    assert done.code == 1
    os.mkfifo(quiet.home / "pipe")
    done = quiet.run(f"timeout {HANG_S / 2} ros2 bag info pipe")
    assert done.stderr == "[ERROR] [ros2bag]: The bag 'pipe' cannot be read: pipe: it is a named pipe, not a file\n"
    assert done.code == 1
    assert "cannot be opened: File name too long" in quiet.run(f"ros2 bag info {'a' * 300}").stderr


OPTIONS = (b"\xff\xfe", b"[" * 100_000, b"output_bags: 2027-13-01\n", b"output_bags: [5]\n")


@pytest.mark.parametrize("data", OPTIONS, ids=["bytes", "deep", "date", "number"])
def test_options_that_cannot_be_read_are_one_sentence(tmp_path: Path, data: bytes) -> None:
    file = tmp_path / "options.yaml"
    file.write_bytes(data)
    with pytest.raises(Ros2Error, match="does not contain valid options for new bags"):
        convert._options(convert._options_file(str(file)))


def test_options_and_parameters_in_a_pipe_of_a_folder_are_refused(tmp_path: Path) -> None:
    _piped(tmp_path / "pipe")
    with pytest.raises(argparse.ArgumentTypeError, match="it is a named pipe, not a file"):
        convert._options_file(str(tmp_path / "pipe"))
    for path, kind in ((tmp_path / "pipe", "a named pipe"), (Path("/dev/zero"), "a device"), (tmp_path, "a folder")):
        with pytest.raises(Ros2Error, match=f"The parameter file {path} cannot be read: it is {kind}, not a file"):
            load.read(str(path), use_wildcard=True)


def test_a_pipe_of_the_shell_is_read() -> None:
    reads, sends = os.pipe()
    os.write(sends, b"output_bags:\n- uri: new\n")
    os.close(sends)
    with os.fdopen(reads):
        assert not why_not(Path(f"/dev/fd/{reads}"), piped=True)
        assert convert._options(convert._options_file(f"/dev/fd/{reads}"))[0]["uri"] == "new"
        assert why_not(Path(f"/dev/fd/{reads}")) == "it is a named pipe, not a file"


@pytest.mark.parametrize(
    ("given", "expected"),
    [(b"\xff", "is not a text in UTF-8"), (b"x" * 10_000_001, "has more than 10 MB")],
    ids=["bytes", "long"],
)
def test_standard_input_is_limited(monkeypatch: pytest.MonkeyPatch, given: bytes, expected: str) -> None:
    monkeypatch.setattr(sys, "stdin", SimpleNamespace(buffer=io.BytesIO(given)))
    with pytest.raises(Ros2Error, match=expected):
        standard_input()


@pytest.mark.parametrize("text", ["[" * 100_000, "{a: 2027-13-01}"])
def test_values_that_yaml_cannot_read_are_one_sentence(text: str) -> None:
    with pytest.raises(Ros2Error, match=r"nested too deeply|cannot be read: month must be in 1\.\.12"):
        message_values.parse(text)

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from grader.errors import UsageError
from grader.submission import tree
from grader.submission.package import open_answers, open_submission
from grader.submission.search import SeveralPackagesError
from grader.tests.submission.folder import PACKAGE, make

if TYPE_CHECKING:
    from pathlib import Path


def test_a_package_folder_is_the_submission(package: Path) -> None:
    submission = open_submission(package)
    assert submission.name == str(package)
    assert submission.package_dir == package.resolve()
    assert submission.files == {path: str(data).encode() for path, data in PACKAGE.items()}
    assert submission.rejected == ()


def test_a_folder_around_one_package_is_the_submission_too(package: Path) -> None:
    around = open_submission(package.parent.parent)
    assert around.package_dir == package.resolve()
    assert around.files == open_submission(package).files
    assert around.digest == open_submission(package).digest


@pytest.mark.parametrize("path", [".", "pkg/..", "pkg/"])
def test_the_name_is_the_users_and_the_folder_is_absolute(
    package: Path, path: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(package)
    if path == "pkg/":
        monkeypatch.chdir(package.parent)
    submission = open_submission(path)
    assert submission.name == path
    assert submission.package_dir == package.resolve()


@pytest.mark.parametrize("only", ["package.xml", "setup.py"])
def test_one_of_the_two_files_makes_a_package(tmp_path: Path, only: str) -> None:
    make(tmp_path, {f"src/one/{only}": ""})
    assert open_submission(tmp_path).package_dir == (tmp_path / "src/one").resolve()


def test_what_lies_below_a_package_belongs_to_it(package: Path) -> None:
    make(package / "copy", PACKAGE)
    submission = open_submission(package.parent)
    assert submission.package_dir == package.resolve()
    assert "copy/package.xml" in submission.files


@pytest.mark.parametrize(
    "other", ["build/pkg", "install/pkg/share/pkg", "log/latest", ".git/x", "venv", "__pycache__", "ignored"]
)
def test_folders_that_tools_create_are_not_searched_for_packages(package: Path, other: str) -> None:
    make(package.parent / other, {"package.xml": "", "setup.py": ""})
    make(package.parent, {"venv/pyvenv.cfg": "", "ignored/COLCON_IGNORE": ""})
    assert open_submission(package.parent).package_dir == package.resolve()


def refused(path: Path | str) -> str:
    with pytest.raises(UsageError) as caught:
        open_submission(path)
    assert caught.value.exit_code == 2
    return str(caught.value)


def test_no_such_folder_names_the_part_that_exists(tmp_path: Path) -> None:
    message = refused(tmp_path / "nope" / "pkg")
    assert f"no folder {tmp_path}/nope/pkg" in message
    assert f"the path exists up to {tmp_path}" in message


def test_a_path_through_a_file_is_no_folder(package: Path) -> None:
    assert "no folder" in refused(package / "setup.py" / "x")


def test_a_node_file_is_answered_with_its_package(package: Path) -> None:
    message = refused(package / "pkg" / "node.py")
    assert "node.py is a file" in message
    assert message.endswith(f"Give the folder of the package: {package.resolve()}.")


def test_an_archive_is_to_be_unpacked(tmp_path: Path) -> None:
    make(tmp_path, {"work.zip": "PK"})
    assert "Unpack the archive" in refused(tmp_path / "work.zip")


def test_a_link_to_nowhere_is_named(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to("gone")
    assert "symlink to a path that does not exist" in refused(tmp_path / "link")


def test_no_package_says_what_is_there(tmp_path: Path) -> None:
    make(tmp_path, {"draw_circle.py": "", "notes/a.txt": ""})
    message = refused(tmp_path)
    assert message.startswith("There is no package in ")
    assert "The folder contains draw_circle.py, notes/." in message


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (["a.zip"], "a.zip must be unpacked: the grader does not look into an archive."),
        (["a.ZIP", "b.rar", "c.py"], "a.ZIP and b.rar must be unpacked: the grader does not look into archives."),
    ],
)
def test_archives_beside_other_files_are_to_be_unpacked(tmp_path: Path, names: list[str], said: str) -> None:
    make(tmp_path, dict.fromkeys(names, ""))
    assert said in refused(tmp_path)


def test_a_folder_with_too_many_entries_is_not_called_empty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tree, "MAX_ENTRIES", 2)
    make(tmp_path, dict.fromkeys("abc", ""))
    assert "contains more than 2 files and folders" in refused(tmp_path)


@pytest.mark.parametrize("path", ["answers.toml", "nope"])
def test_no_package_is_asked_for_if_the_exercise_has_none(tmp_path: Path, path: str) -> None:
    make(tmp_path, {"answers.toml": ""})
    with pytest.raises(UsageError, match=r"Give the folder that contains your answers\.toml\.$") as caught:
        open_answers(tmp_path / path)
    assert "package" not in str(caught.value).replace(str(tmp_path), "")


def test_rejected_answers_are_not_asked_for_again(tmp_path: Path) -> None:
    (tmp_path / "answers.toml").symlink_to("/answers.toml")
    with pytest.raises(UsageError, match=r"an absolute path, which can differ on another machine\.$"):
        open_answers(tmp_path)


def test_an_empty_folder_is_called_empty(tmp_path: Path) -> None:
    assert "empty" in refused(tmp_path)


def test_inside_of_the_package_the_folder_around_is_proposed(package: Path) -> None:
    assert refused(package / "pkg").endswith(f"The folder is inside the package {package.name}: give that folder.")


@pytest.mark.parametrize("name", ["Package.xml", "package.xml.txt", "SETUP.PY"])
def test_a_name_that_is_nearly_right_is_named(tmp_path: Path, name: str) -> None:
    make(tmp_path, {f"pkg/{name}": ""})
    message = refused(tmp_path)
    assert f"pkg/{name} is almost right" in message


def test_a_linked_package_is_named_and_not_followed(tmp_path: Path, package: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "pkg").symlink_to(package)
    message = refused(tmp_path / "mine")
    assert "pkg is a link" in message


def test_a_folder_that_colcon_ignores_is_named(tmp_path: Path) -> None:
    make(tmp_path / "pkg", {**PACKAGE, "COLCON_IGNORE": ""})
    assert "COLCON_IGNORE" in refused(tmp_path)
    assert open_submission(tmp_path / "pkg").files  # the user has named this package


def test_several_packages_are_listed(tmp_path: Path) -> None:
    for name in ("two", "one"):
        make(tmp_path / "src" / name, PACKAGE)
    message = refused(tmp_path)
    assert f"contains 2 packages: {tmp_path}/src/one, {tmp_path}/src/two." in message
    assert message.endswith(f"for example {tmp_path}/src/one.")


NAMED = "<package><name> {} </name></package>"


@pytest.mark.parametrize(
    ("one", "two", "chosen"),
    [
        ({"package.xml": NAMED.format("turtle")}, {"package.xml": NAMED.format("other")}, "one"),
        ({"package.xml": NAMED.format("other")}, {"package.xml": NAMED.format("turtle")}, "two"),
        ({"package.xml": NAMED.format("turtle")}, {"package.xml": "<package"}, "one"),
        ({"package.xml": NAMED.format("turtle")}, {"setup.py": ""}, "one"),
    ],
)
def test_of_several_packages_the_only_one_of_the_right_name_counts(
    tmp_path: Path, one: dict[str, str | bytes], two: dict[str, str | bytes], chosen: str
) -> None:
    make(tmp_path / "src/one", one)
    make(tmp_path / "src/two", two)
    assert open_submission(tmp_path, "turtle").package_dir == tmp_path / "src" / chosen
    with pytest.raises(SeveralPackagesError, match="contains 2 packages"):
        open_submission(tmp_path)
    with pytest.raises(SeveralPackagesError, match="contains 2 packages"):
        open_submission(tmp_path, "whale")


@pytest.mark.parametrize("manifest", [None, "<package/>", "pipe", "link", "secret"])
def test_without_a_name_in_package_xml_the_name_of_the_folder_counts(tmp_path: Path, manifest: str | None) -> None:
    package = make(tmp_path / "src/turtle", {"setup.py": ""})
    make(tmp_path / "src/other", PACKAGE)
    file = package / "package.xml"
    if manifest == "pipe":
        os.mkfifo(file)
    elif manifest == "link":
        (tmp_path / "outside").write_text(NAMED.format("other"))
        file.symlink_to(tmp_path / "outside")
    elif manifest is not None:
        file.write_text("" if manifest == "secret" else manifest)
    if manifest == "secret":
        file.chmod(0)
    assert open_submission(tmp_path, "turtle").package_dir == package


def test_two_packages_of_the_right_name_are_named_without_the_others(tmp_path: Path) -> None:
    for name in ("turtle", "turtle (copy)"):
        make(tmp_path / "src" / name, {"package.xml": NAMED.format("turtle")})
    make(tmp_path / "src/other", PACKAGE)
    with pytest.raises(SeveralPackagesError) as raised:
        open_submission(tmp_path, "turtle")
    assert "contains 2 packages" in str(raised.value)
    assert "other" not in str(raised.value)


def test_too_many_folders_end_the_search(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("grader.submission.search.MAX_FOLDERS", 3)
    make(tmp_path, {f"{number}/a": "" for number in range(4)})
    assert "more than 3 folders" in refused(tmp_path)

"""Results on disk: each result is either complete or absent."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from pathlib import Path
from typing import NoReturn

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.key import Key, changed, grader_key
from grader.classroom.own_folders import MARK
from grader.classroom.results import Results, file_name, opened
from grader.errors import MachineError, UsageError
from grader.tests.report.reports import report

KEY = Key("submission", "anna", "exercise", "grader", "ros", "options")


def test_a_saved_result_can_be_loaded(tmp_path: Path) -> None:
    with opened(tmp_path / "grades") as results:
        saved = results.save("anna", report("failed"), KEY, b"<p>page")
        assert results.load("anna", saved.report.exercise) == saved
        assert results.load("ben", saved.report.exercise) is None


def test_other_users_cannot_read_the_marks(tmp_path: Path) -> None:
    with opened(tmp_path / "new" / "grades"):
        assert (tmp_path / "new" / "grades").stat().st_mode & 0o777 == 0o700


@pytest.mark.parametrize("chosen", [True, False])
def test_only_a_folder_that_was_chosen_can_be_another(tmp_path: Path, *, chosen: bool) -> None:
    """`grader gradebook sync` has no option --out."""
    with opened(tmp_path / "grades"), pytest.raises(UsageError) as used, opened(tmp_path / "grades", chosen=chosen):
        pass
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "file").touch()
    with pytest.raises(UsageError) as foreign, opened(tmp_path / "other", chosen=chosen):
        pass
    assert ["--out" in str(error.value) for error in (used, foreign)] == [chosen, chosen]


@pytest.fixture
def of_the_student(tmp_path: Path) -> Path:
    """Return a folder with forged results that a student has handed in."""
    with opened(tmp_path / "of the student" / "grades") as results:
        results.save("mallory", report("passed"), KEY, b"<p>forged")
    (tmp_path / "class").mkdir()
    return results.folder


def test_results_that_a_student_has_handed_in_are_refused(
    tmp_path: Path, of_the_student: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "home of the instructor"))
    handed_in = of_the_student.rename(tmp_path / "class" / "grades")
    with pytest.raises(UsageError, match="may have put forged results there"), opened(handed_in, [tmp_path / "class"]):
        pass
    with opened(tmp_path / "class" / "own", [tmp_path / "class"]):
        pass
    with opened(tmp_path / "class" / "own", [tmp_path / "class"]):
        pass


def test_a_student_cannot_choose_the_folder_of_the_results_with_a_link(tmp_path: Path, of_the_student: Path) -> None:
    link = tmp_path / "class" / "grades"
    for leads_to in (of_the_student, tmp_path / "nowhere"):
        link.symlink_to(leads_to)
        with pytest.raises(UsageError, match="may have put forged results there"), opened(link, [tmp_path / "class"]):
            pass
        link.unlink()
    assert not (tmp_path / "nowhere").exists()


def test_an_empty_folder_among_the_submissions_is_not_taken_for_the_results(tmp_path: Path) -> None:
    (tmp_path / "grades").mkdir()
    with pytest.raises(UsageError, match="nothing shows that you created it"), opened(tmp_path / "grades", [tmp_path]):
        pass


def test_the_folder_of_the_submissions_is_not_taken_for_the_results(tmp_path: Path) -> None:
    (tmp_path / MARK).write_text("0" * 32)
    with pytest.raises(UsageError, match="may have put forged results there"), opened(tmp_path, [tmp_path]):
        pass


def test_after_a_full_disk_the_same_command_works(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> NoReturn:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    grades = tmp_path / "grades"
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(MachineError, match="Free some space"), opened(grades, [tmp_path]):
            pass
    for _ in range(2):
        with opened(grades, [tmp_path]):
            assert {each.name for each in grades.iterdir()} == {MARK, "reports"}


def test_results_among_the_submissions_need_the_list_of_marks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without the list, the next run could not tell the results from forged ones."""
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "file"))
    with (
        pytest.raises(MachineError, match=r"grades: Not a directory \(.*file/"),
        opened(tmp_path / "class/grades", [tmp_path / "class"]),
    ):
        pass
    assert not (tmp_path / "class/grades").exists()
    with opened(tmp_path / "elsewhere", [tmp_path / "class"]):
        pass


def test_a_result_without_a_page_is_not_complete(tmp_path: Path) -> None:
    with opened(tmp_path / "grades") as results:
        saved = results.save("anna", report("failed"), KEY, b"<p>page")
        (tmp_path / "grades" / "reports" / saved.page).unlink()
        assert results.load("anna", saved.report.exercise) is None


def test_a_full_disk_leaves_the_old_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with opened(tmp_path / "grades") as results:
        saved = results.save("anna", report("failed"), KEY, b"<p>page")

        def full(_: int) -> None:
            raise OSError(errno.ENOSPC, "No space left on device")

        monkeypatch.setattr("os.fsync", full)
        with pytest.raises(MachineError, match=r"No space left on device.*run the same command again"):
            results.save("anna", report("passed"), KEY, b"<p>new")
        assert results.load("anna", saved.report.exercise) == saved
        assert not list((tmp_path / "grades").rglob("*.partial"))


@pytest.mark.parametrize(
    ("number", "todo"), [(errno.ENOSPC, "Free some space"), (errno.EROFS, "Make the folder writable")]
)
def test_what_to_do_depends_on_why_the_folder_cannot_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int, todo: str
) -> None:
    def fails(*_: object, **__: object) -> None:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(Path, "mkdir", fails)
    with pytest.raises(MachineError, match=rf"{os.strerror(number)}\. {todo}, or choose"), opened(tmp_path / "out"):
        pass


def test_a_folder_with_other_files_is_not_touched(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("mine")
    with pytest.raises(UsageError, match="contains files that are not results"), opened(tmp_path):
        pass
    assert [file.name for file in tmp_path.iterdir()] == ["index.html"]


def test_a_run_that_was_killed_before_it_had_marked_the_folder_is_repeated(tmp_path: Path) -> None:
    code = (
        "import os, signal, sys\nfrom pathlib import Path\nfrom grader.classroom.own_folders import mark\n"
        "os.fsync = lambda _: os.kill(os.getpid(), signal.SIGKILL)\nmark(Path(sys.argv[1]), needed=False)"
    )
    folder = tmp_path / "grades"
    folder.mkdir()
    env = {**os.environ, "XDG_STATE_HOME": str(tmp_path / "state")}
    done = subprocess.run([sys.executable, "-c", code, folder / MARK], check=False, env=env)
    assert (done.returncode, [each.name for each in folder.iterdir()]) == (-9, [f".{MARK}.partial"])
    with opened(folder) as results:
        assert not list(folder.rglob("*.partial"))
        assert results.save("anna", report("passed"), KEY, b"<p>page")


def test_a_file_in_the_place_of_the_folder_is_reported_as_a_file(tmp_path: Path) -> None:
    (tmp_path / "grades").write_text("mine")
    with pytest.raises(UsageError, match=r"grades is not a folder\. Choose a new folder"), opened(tmp_path / "grades"):
        pass


def test_the_key_shows_what_changed() -> None:
    assert changed(KEY.to_data(), KEY) == ()
    assert changed({**KEY.to_data(), "grader": "older"}, KEY) == ("grader",)
    assert changed({}, KEY) == ("submission", "student", "exercise", "grader", "ros", "options")


def test_the_key_of_the_grader_has_its_version_and_its_sources() -> None:
    version, sources = grader_key().split()
    assert version.count(".") == 2
    assert len(sources) == 16


def test_the_key_of_the_grader_changes_with_each_file_that_judges(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def put(name: str, text: str) -> str:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
        return grader_key.__wrapped__()

    monkeypatch.setattr("grader.__file__", str(tmp_path / "__init__.py"))
    first = put("checks/rate.py", "1")
    assert put("tests/checks/test_rate.py", "1") == put("checks/__pycache__/rate.pyc", "1") == first
    (tmp_path / "checks/.#rate.py").symlink_to("the lock of an editor")
    keys = [first, put("checks/rate.py", "2"), put("checks/again/rate.py", "2"), put("checks/table.toml", "2")]
    assert len(set(keys)) == len(keys)


@given(st.text(min_size=1, max_size=300).filter(lambda text: "/" not in text and "\0" not in text))
def test_every_name_becomes_a_valid_file_name(student: str) -> None:
    name = file_name(student, "03-circle-publisher")
    assert "/" not in name
    assert not name.startswith(".")
    assert len(name.encode()) < 200


@given(st.lists(st.text(min_size=1, max_size=300), min_size=2, max_size=2, unique=True))
def test_no_two_students_share_a_file(students: list[str]) -> None:
    first, second = (file_name(student, "x") for student in students)
    assert first != second
    first, second = (file_name(student, "x", ignores_case=True) for student in students)
    assert first.casefold() != second.casefold()


def test_two_spellings_do_not_share_a_file_on_a_disk_that_ignores_capitals(tmp_path: Path) -> None:
    with opened(tmp_path / "grades") as results:
        ordinary = results.save("Anna", report("passed"), KEY, b"page").page
        assert ordinary == f"{file_name('Anna', report('passed').exercise)}.html"
        (tmp_path / "grades" / ".GRADER-RESULTS").touch()  # what such a disk shows for .grader-results
        pages = [results.save(name, report("passed"), KEY, b"page").page for name in ("anna", "Anna", "ANNA")]
        assert len({page.casefold() for page in pages}) == 3
        assert all(results.load(name, report("passed").exercise) for name in ("anna", "Anna", "ANNA"))


def test_a_name_that_is_not_utf8_can_be_saved(tmp_path: Path) -> None:
    with opened(tmp_path / "grades") as results:
        saved = results.save("ann\udce4", report("failed"), KEY, b"")
        found = results.load("ann\udce4", saved.report.exercise)
        assert isinstance(results, Results)
        assert found is not None
        assert found.page == saved.page

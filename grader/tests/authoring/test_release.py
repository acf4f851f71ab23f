from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from grader.authoring.release import main, release, released, stale
from grader.errors import UsageError

ROOT = Path(__file__).parent.parent.parent.parent
MARKED = "a = 1\n# BEGIN SOLUTION\nb = 2\n# END SOLUTION\n# BEGIN STARTER\n# # TODO\n# END STARTER\n"


@pytest.fixture
def root(tmp_path: Path) -> Path:
    step = tmp_path / "solutions" / "01-x"
    (step / "pkg").mkdir(parents=True)
    (step / "pkg" / "node.py").write_text(MARKED)
    (step / "pkg" / "data.bin").write_bytes(b"\x00\xff\r\n")
    (step / "pkg" / "run.sh").write_text("true\n")
    (step / "pkg" / "run.sh").chmod(0o755)
    return tmp_path


def test_no_later_starting_point_contains_the_solution_of_a_step() -> None:
    steps = sorted(folder.name for folder in (ROOT / "solutions").iterdir() if folder.name >= "07")
    nodes = {step: {path.name: path for path in (ROOT / "solutions" / step).glob("*/*/*.py")} for step in steps}
    for place, step in enumerate(steps):
        own = [name for name, path in nodes[step].items() if place == 0 or name not in nodes[steps[place - 1]]]
        marked = [name for name in own if "BEGIN STARTER" in nodes[step][name].read_text()]
        later = [(other, name) for other in steps[place + 1 :] for name in marked if name in nodes[other]]
        assert [each for each in later if nodes[each[0]][each[1]].read_text() != nodes[step][each[1]].read_text()] == []


def test_exercises_are_up_to_date_with_solutions() -> None:
    assert stale(ROOT / "solutions", ROOT / "exercises") == ()


def test_files_are_stripped_or_copied_as_they_are(root: Path) -> None:
    release(root / "solutions" / "01-x", root / "out")
    assert (root / "out/pkg/node.py").read_text() == "a = 1\n# TODO\n"
    assert (root / "out/pkg/data.bin").read_bytes() == b"\x00\xff\r\n"
    modes = {path.name: path.stat().st_mode & 0o777 for path in (root / "out/pkg").iterdir()}
    assert modes == {"node.py": 0o644, "data.bin": 0o644, "run.sh": 0o755}


def test_files_that_are_no_longer_released_are_removed(root: Path) -> None:
    step = root / "solutions" / "01-x"
    release(step, root / "out")
    (step / "pkg" / "data.bin").unlink()
    (root / "out" / "pkg" / "node.py").write_text("changed")
    release(step, root / "out")
    assert sorted(path.name for path in (root / "out/pkg").iterdir()) == ["node.py", "run.sh"]
    assert (root / "out/pkg/node.py").read_text() == "a = 1\n# TODO\n"


def test_a_file_that_becomes_empty_is_not_released(root: Path) -> None:
    step = root / "solutions" / "01-x"
    (step / "pkg" / "node.py").write_text("# BEGIN SOLUTION\na = 1\n# END SOLUTION\n")
    (step / "pkg" / "__init__.py").write_text("")
    assert sorted(released(step)) == ["pkg/__init__.py", "pkg/data.bin", "pkg/run.sh"]


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("a.py", "def f():\n# BEGIN SOLUTION\n    return 1\n# END SOLUTION\n"),
        ("a.xml", "<a>\n<!-- BEGIN SOLUTION -->\n</a>\n<!-- END SOLUTION -->\n"),
        ("a.toml", "a = [\n# BEGIN SOLUTION\n]\n# END SOLUTION\n"),
    ],
)
def test_released_files_must_parse(root: Path, path: str, text: str) -> None:
    (root / "solutions" / "01-x" / path).write_text(text)
    with pytest.raises(UsageError, match=rf"01-x/{path}: the released file cannot be parsed"):
        released(root / "solutions" / "01-x")


def test_a_solution_that_cannot_be_parsed_needs_no_starter_block(root: Path) -> None:
    step = root / "solutions" / "01-x"
    (step / "pkg" / "node.py").write_text(f"{MARKED}def main((:\n    pass\n")
    with pytest.raises(UsageError, match=r"node\.py: the file cannot be parsed: [^<]*\(line \d+\)\.$"):
        released(step)


def test_a_mistake_is_reported_in_the_file_and_not_in_the_copy_in_a_notebook(root: Path) -> None:
    step = root / "solutions" / "01-x"
    (step / "01-x.ipynb").write_text("{")
    (step / "pkg" / "node.py").write_text("# END SOLUTION\n")
    with pytest.raises(UsageError, match=r"node\.py:1: END SOLUTION without a BEGIN SOLUTION"):
        released(step)


def test_a_marker_in_an_unknown_type_of_file_is_an_error(root: Path) -> None:
    (root / "solutions" / "01-x" / "a.cpp").write_text("// BEGIN SOLUTION\n")
    with pytest.raises(UsageError, match=r"a\.cpp: a file of an unknown type contains a marker"):
        released(root / "solutions" / "01-x")


def test_a_text_file_that_is_not_utf8_is_an_error(root: Path) -> None:
    (root / "solutions" / "01-x" / "a.py").write_bytes(b"# \xff\n")
    with pytest.raises(UsageError, match=r"a\.py: not UTF-8"):
        released(root / "solutions" / "01-x")


def test_a_link_that_leads_out_is_an_error(root: Path) -> None:
    (root / "solutions" / "01-x" / "link").symlink_to("/etc/hostname")
    with pytest.raises(UsageError, match="link is a link to /etc/hostname"):
        released(root / "solutions" / "01-x")


def test_notebooks_lose_solutions_and_output(root: Path) -> None:
    cells = [
        {"cell_type": "markdown", "source": ["é\n", "<!-- BEGIN SOLUTION -->\n", "x\n", "<!-- END SOLUTION -->"]},
        {"cell_type": "code", "source": MARKED, "outputs": [{"text": "2"}], "execution_count": 3},
    ]
    path = root / "solutions" / "01-x" / "a.ipynb"
    path.write_text(json.dumps({"nbformat": 4, "cells": cells}))
    text = released(root / "solutions" / "01-x")["a.ipynb"].data.decode()
    markdown, code = json.loads(text)["cells"]
    assert markdown["source"] == ["é\n"]
    assert code["source"] == ["a = 1\n", "# TODO\n"]
    assert code["outputs"] == []
    assert code["execution_count"] is None
    assert "é" in text
    assert text.startswith('{\n "cells": [')
    assert text.endswith("}\n")


def test_wrong_markers_in_a_notebook_name_the_cell(root: Path) -> None:
    cells = [{"cell_type": "raw", "source": "a"}, {"cell_type": "code", "source": "# END SOLUTION"}]
    (root / "solutions" / "01-x" / "a.ipynb").write_text(json.dumps({"cells": cells}))
    with pytest.raises(UsageError, match=r"a\.ipynb, cell 2:1: END SOLUTION without"):
        released(root / "solutions" / "01-x")


@pytest.mark.parametrize("text", ["no json", "[]", '{"cells": [{}]}'])
def test_a_broken_notebook_is_an_error(root: Path, text: str) -> None:
    (root / "solutions" / "01-x" / "a.ipynb").write_text(text)
    with pytest.raises(UsageError, match=r"a\.ipynb is not a notebook"):
        released(root / "solutions" / "01-x")


def test_the_command_makes_and_checks(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    check = ["--check", "--root", str(root)]
    (root / "exercises").mkdir()
    assert main(check) == 1
    assert "01-x/pkg/node.py is missing." in capsys.readouterr().out
    assert main(["--root", str(root)]) == 0
    assert main(check) == 0


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ("printf x >> 01-x/pkg/node.py", "01-x/pkg/node.py does not match its solution."),
        ("chmod -x 01-x/pkg/run.sh", "01-x/pkg/run.sh and its solution differ in the executable bit."),
        ("touch 01-x/more.txt", "01-x/more.txt does not come from a solution. Delete it."),
        ("mkdir 02-y; touch 02-y/a", "02-y/a does not come from a solution. Delete it."),
        ("rm 01-x/pkg/data.bin", "01-x/pkg/data.bin is missing."),
    ],
)
def test_every_change_by_hand_is_found(root: Path, change: str, what: str) -> None:
    main(["--root", str(root)])
    subprocess.run(change, shell=True, check=True, cwd=root / "exercises")
    assert stale(root / "solutions", root / "exercises") == (f"{root}/exercises/{what}",)


def test_the_command_prints_errors_without_a_traceback(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (root / "solutions" / "01-x" / "pkg" / "node.py").write_text("# END SOLUTION\n")
    assert main(["--root", str(root)]) == 2
    assert "node.py:1: END SOLUTION without" in capsys.readouterr().err

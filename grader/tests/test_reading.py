"""Only one kind of process reads the files of students: the process of submission/reader.py."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

import pytest

from grader.tests.test_process_starts import GRADER, in_functions, sources

if TYPE_CHECKING:
    from collections.abc import Iterator

READS = {
    "read_tree", "read_folder", "find_package", "read_code", "read_module", "read_manifest", "read_setup_py",
    "read_plain_setup", "read_answers", "read_tar", "read_all", "read_entry_points", "wall_clues", "uses_of", "judge",
    "judge_so_far", "judge_early",
    "recording_format.load", "parse_package_string", "read_notebook", "nbformat.read", "zipfile.ZipFile",
    "read_payloads", "tarfile.open", "tokenize.tokenize", "tomllib.loads", "ast.parse", "json.loads", "json.load",
    "ET.fromstring", "yaml.safe_load", "pickle.load", "pickle.loads",
}  # fmt: skip
"""Functions that read their argument, with their names in the source."""
NO_SUBMISSIONS = {"benchmarks", "exercise", "graph", "ros", "ros2", "setup", "turtlesim", "view"}
"""Packages of the grader whose code never reads a submission."""
INSIDE = {"checks", "evidence", "submission"}
"""Packages of the grader whose code runs in the reading process."""
BEHIND_THE_DOOR = {
    ("bench", "takes_options"): "bench",
    ("budget", "_read"): "relay: a separate process with limits",
    ("called", "read_called"): "calls",
    ("comparison", "installs"): "trials",
    ("clues", "wall_clues"): "judging",
    ("cli", "_judged"): "cli",
    ("class_reports", "_report_in"): "class_reports",
    ("in_words", "_parts"): "compare",
    ("judging", "_all"): "judging",
    ("judging", "_early"): "judging",
    ("clock", "first_clock"): "judging",
    ("json", "from_json"): "class_reports, and our own results",
    ("predicted", "_may_look_around"): "trials",
    ("predicted", "predict"): "trials",
    ("rebuild", "_with_texts"): "rebuild",
    ("kernel_scores", "_scores_in"): "kernel_scores",
    ("unpack", "_tar"): "archives",
    ("unpack", "_zip"): "archives",
    ("result", "run_of"): "tests",
    ("runner", "_described"): "runner",
    ("runner", "_entry_points"): "runner",
}
"""Maps each other function that reads a submission to the module that calls `read` for this function."""
OURS = {
    ("bridge", "main"): "a request of the relay",
    ("cell_calls", "_returned"): "the output of a child process, in the cell of student code",
    ("cell_calls", "main"): "a request of calling.py, in the cell",
    ("check", "_graded"): "the output of the notebook's grader",
    ("conductor", "_conduct"): "a request of trial.py",
    ("conductor", "main"): "a request of trial.py",
    ("dask_engine", "perform_here"): "a task of the instructor's command",
    ("desk", "from_json"): "messages of the desk to its page process",
    ("desk_server", "_awake"): "checked requests of a page",
    ("desk_server", "_wanted"): "checked requests of a page",
    ("gradescope_archive", "build_archive"): "an archive that we write",
    ("in_cell", "_next_run"): "the command that colcon starts, in its cell",
    ("judging", "so_far"): "a submission that is already read",
    ("fork_server", "_next_order"): "a request of fork_client.py",
    ("holder", "await_ready"): "the output of bubblewrap",
    ("launcher", "run"): "a request of the conductor",
    ("node_in_cell", "main"): "a request of the desk",
    ("own_environment", "require_own_environment"): "the record of our set-up",
    ("page_process", "main"): "a request of the desk",
    ("parse_colcon", "_main"): "the commands of a lesson, from validate",
    ("parse_colcon", "colcon_faults"): "the output of a process that parses the commands of a lesson",
    ("predicted", "tree"): "a stream that we write",
    ("progress", "_read"): "the learner's state",
    ("relay", "main"): "a request of confined_autograde.py",
    ("relay", "read"): "a request of confined_autograde.py",
    ("release", "_read"): "a solution",
    ("released", "released_notebook"): "a notebook of the course",
    ("bench", "pack"): "a stream that we write",
    ("relayed_node", "_ask"): "a response of the grader, in a cell",
    ("session", "_run_tests"): "a request of the lane, in a cell",
    ("session", "main"): "a request of the lane, in a cell",
    ("results", "load"): "our own result",
    ("build_store", "_unpacked"): "a build that we stored",
    ("solution_programs", "_packages"): "a solution",
    ("source", "refreshed"): "a notebook of the course",
    ("trial", "_answer"): "the output of the conductor",
    ("runner", "_pack"): "a stream that we write",
    ("workspace", "add_missing"): "a starting point",
}
"""Maps each function that reads data which no student wrote to a description of this data."""


def reading(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Yield the functions that read a file or a stream, and the functions that they call for reading."""
    for function, node in in_functions(tree):
        if isinstance(node, ast.Call):
            name = ast.unparse(node.func)
            if name in READS or name.rpartition(".")[2] in READS:
                yield function, name


def test_all_reading_is_behind_the_door_or_of_what_is_ours() -> None:
    found = {
        (path.stem, function): f"{path.relative_to(GRADER)}, {function}: {name}"
        for path, tree in sources()
        if path.relative_to(GRADER).parts[0] not in INSIDE | NO_SUBMISSIONS
        for function, name in reading(tree)
    }
    known = {**BEHIND_THE_DOOR, **OURS}
    unknown = [reported for where, reported in found.items() if where not in known]
    assert (unknown, known.keys() - found.keys() - {("clues", "wall_clues")}) == ([], set()), "see submission/reader.py"


def test_the_list_of_modules_that_call_the_reader_is_right() -> None:
    doors = {
        path.stem
        for path, tree in sources()
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module in ("grader.submission.reader", "grader.submission")
        for alias in node.names
        if alias.name in ("read", "reader")
    }
    behind = {module for module in BEHIND_THE_DOOR.values() if re.fullmatch(r"\w+", module)}
    assert behind <= doors
    assert {"package", "content", "copies", "converters", "compare", "html", "html_notebook", "picture"} <= doors


NEW = ("tree.read_tree(folder)", "import json\njson.loads(notebook)", "judge(evidence)")


@pytest.mark.parametrize("code", NEW)
def test_a_new_place_that_reads_would_be_found(code: str) -> None:
    assert [function for function, _ in reading(ast.parse(f"def function():\n    pass\n{code}"))] == [""]

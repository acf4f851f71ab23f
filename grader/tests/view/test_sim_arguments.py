"""The arguments of `grader sim`: its own options, and those for ROS 2."""

from __future__ import annotations

import pytest

from grader.errors import MachineError, UsageError
from grader.view import launch
from grader.view.cli import refuse_unknown


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--domain", "77"], "`grader shell --domain N` opens a shell with domain N."),
        (["--domain=77"], "`grader sim` has no option --domain."),
        (["--domino"], "`grader sim` has no argument --domino."),
        (["-view"], "`grader sim` has no argument -view. Did you mean --view?"),
        (["view"], "Did you mean --view?"),
        (["terminl"], "Did you mean --view terminal?"),
        (["XY"], "`grader sim` has no argument XY. `grader sim --help` lists the options."),
        (["page"], "`grader sim` has no argument page. `grader sim --help` lists the options."),
    ],
)
def test_an_unknown_argument_is_refused_by_grader_sim_itself(arguments: list[str], words: str) -> None:
    with pytest.raises(UsageError) as refused:
        refuse_unknown(arguments)
    assert words in str(refused.value)
    assert ("grader shell" in str(refused.value)) == arguments[0].startswith("--domain")


@pytest.mark.parametrize("arguments", [[], ["--ros-args", "-p", "background_r:=7"]])
def test_arguments_for_ros_2_are_passed_on(arguments: list[str]) -> None:
    refuse_unknown(arguments)


@pytest.mark.parametrize(
    ("instead", "end"), [("", "what is missing."), ("the text is printed", "what is missing; the text is printed.")]
)
def test_only_a_command_with_another_view_names_it(monkeypatch: pytest.MonkeyPatch, instead: str, end: str) -> None:
    monkeypatch.setattr(launch, "find_spec", lambda name: None if name != "uvicorn" else name)
    with pytest.raises(MachineError, match="the page needs starlette and websockets, which") as lacking:
        launch.see_that_it_can_be_served(*[instead] if instead else [])
    assert str(lacking.value).endswith(end)

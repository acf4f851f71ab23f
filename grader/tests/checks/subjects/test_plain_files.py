"""The check of the files: files that the grader left out of the submission are reported."""

from __future__ import annotations

import pytest

from grader.tests.checks.made import evidence, finding, submission


@pytest.mark.parametrize(
    ("more", "observed"),
    [
        ((), "Left out: data: a link that leaves the package."),
        (("x",), "Left out: data: a link that leaves the package (and 1 more)."),
        (("x", "y", "And 7 more."), "Left out: data: a link that leaves the package (and 9 more)."),
    ],
)
def test_what_was_left_out_of_the_submission_is_reported(more: tuple[str, ...], observed: str) -> None:
    given = evidence(package=submission(rejected=("data: a link that leaves the package.", *more)))
    found = finding("files", given)
    assert (found.diagnosis, found.observed) == ("rejected-file", observed)


@pytest.mark.parametrize(("rejected", "found"), [((), True), (("data: a link that leaves the package.",), False)])
def test_files_that_are_not_normal_are_told(rejected: tuple[str, ...], *, found: bool) -> None:
    reported = finding("files", evidence(package=submission(rejected=rejected)))
    assert (reported.observed == "The package contains only normal files and folders.") == found
    assert (reported.expected == "A package contains only normal files and folders of a limited size.") != found

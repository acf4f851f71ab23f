from __future__ import annotations

from typing import get_args

from grader.checks.diagnoses import DIAGNOSES
from grader.checks.diagnosis import Diagnosis


def test_the_type_of_diagnoses_has_the_ids_of_the_catalogue_in_their_order() -> None:
    assert get_args(Diagnosis) == tuple(DIAGNOSES)

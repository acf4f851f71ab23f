from __future__ import annotations

import pytest

from grader.ros.domain import wrong_domain


@pytest.mark.parametrize("text", ["", "0", "7", "007", "232"])
def test_the_domains_of_dds_are_accepted(text: str) -> None:
    assert wrong_domain({"ROS_DOMAIN_ID": text}) == ""


@pytest.mark.parametrize("text", ["233", "-1", "1.5", "abc", " 1", "9" * 5000, "0" * 5000])
def test_any_other_text_is_quoted_in_one_sentence(text: str) -> None:
    said = wrong_domain({"ROS_DOMAIN_ID": text})
    assert said.startswith(f"ROS_DOMAIN_ID is '{text[:40]}'; a whole number from 0 to 232 was expected.")
    assert len(said) < 200


def test_without_the_variable_the_domain_is_0() -> None:
    assert wrong_domain({}) == ""

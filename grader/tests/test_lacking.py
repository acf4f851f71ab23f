from __future__ import annotations

import pytest

from grader.tests.lacking import give_up


@pytest.mark.parametrize(("ci", "how"), [("true", pytest.fail.Exception), ("", pytest.skip.Exception)])
def test_only_ci_insists_on_every_program(monkeypatch: pytest.MonkeyPatch, ci: str, how: type[BaseException]) -> None:
    monkeypatch.setenv("CI", ci)
    with pytest.raises(how, match="there is no Chromium: apt-get install chromium"):
        give_up("Chromium", "chromium")

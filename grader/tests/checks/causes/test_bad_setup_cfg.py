"""Why setuptools cannot read setup.cfg."""

from __future__ import annotations

import pytest

from grader.checks.causes.bad_setup_cfg import why_setup_cfg_unreadable

RIGHT = "[develop]\nscript_dir=$base/lib/p\n[install]\ninstall_scripts=$base/lib/p\n"


@pytest.mark.parametrize(
    ("data", "cause", "where"),
    [
        (RIGHT.encode("utf-16"), "Save the file as UTF-8.", "setup.cfg"),
        (RIGHT.encode("utf-8-sig"), "without a byte order mark", "setup.cfg"),
        (f"# Namen\n# f\xfcr\n{RIGHT}".encode("latin-1"), "Save the file as UTF-8.", "setup.cfg:2"),
        (RIGHT.partition("\n")[2].encode(), "such as [develop], must come before this line.", "setup.cfg:1"),
        (
            RIGHT.replace("[develop]", "[develop").encode(),
            "A section needs square brackets on both sides",
            "setup.cfg:1",
        ),
        (RIGHT.replace("[develop]", "(develop)").encode(), "A section needs square brackets on both", "setup.cfg:1"),
        (f"{RIGHT}install_lib\n".encode(), "This line is neither [SECTION] nor NAME=VALUE.", "setup.cfg:5"),
        (
            f"{RIGHT}install_scripts=x\n".encode(),
            "Each section, and each name in a section, may occur only once.",
            "setup.cfg:5",
        ),
        (
            f"{RIGHT}[develop]\n".encode(),
            "Each section, and each name in a section, may occur only once.",
            "setup.cfg:5",
        ),
    ],
)
def test_an_invalid_setup_cfg_is_reported_with_its_line_and_the_reason(data: bytes, cause: str, where: str) -> None:
    found = why_setup_cfg_unreadable(data)
    assert found is not None
    assert str(found.where) == where
    assert found.diagnosis == ("not-utf8" if cause == "Save the file as UTF-8." else "setup-cfg")
    assert cause in found.text


@pytest.mark.parametrize(
    "data", [b"", RIGHT.encode(), f"{RIGHT}Install_scripts=x\n".encode(), f"# f\xfcr\n{RIGHT}".encode()]
)
def test_a_readable_setup_cfg_has_no_reason(data: bytes) -> None:
    assert why_setup_cfg_unreadable(data) is None

"""Explain why setuptools cannot read setup.cfg."""

from __future__ import annotations

import codecs
import configparser
import re

from grader.checks.cause import Cause
from grader.checks.causes.syntax import UTF_16
from grader.common.words import line_at
from grader.submission.where import Where

FILE = "setup.cfg"
SECTION = re.compile(r"\W*(?:develop|install)\W*$")
"""Matches a line that has only the name of a section, with any characters around it."""


def why_setup_cfg_unreadable(data: bytes) -> Cause | None:
    """Return the cause if setuptools cannot read this content of setup.cfg, else None."""
    parser = configparser.RawConfigParser()
    parser.optionxform = str  # type: ignore[method-assign, assignment]  # as in setuptools
    try:
        if data.startswith(UTF_16):
            return Cause("not-utf8", "Save the file as UTF-8.", Where(FILE))
        if data.startswith(codecs.BOM_UTF8):
            return Cause("setup-cfg", "Save the file as UTF-8 without a byte order mark (BOM).", Where(FILE))
        parser.read_string(data.decode("utf-8"))
    except UnicodeDecodeError as error:
        return Cause("not-utf8", "Save the file as UTF-8.", Where(FILE, line_at(data, error.start)))
    except configparser.MissingSectionHeaderError as error:
        text = "A line with a section, such as [develop], must come before this line."
        if SECTION.match(error.line):
            text = "A section needs square brackets on both sides of its name, as in [develop]."
        return Cause("setup-cfg", text, Where(FILE, error.lineno))
    except configparser.ParsingError as error:
        return Cause("setup-cfg", "This line is neither [SECTION] nor NAME=VALUE.", Where(FILE, error.errors[0][0]))
    except (configparser.DuplicateOptionError, configparser.DuplicateSectionError) as error:
        return Cause(
            "setup-cfg", "Each section, and each name in a section, may occur only once.", Where(FILE, error.lineno)
        )
    return None

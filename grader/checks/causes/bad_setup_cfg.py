"""Explain why setuptools cannot read setup.cfg."""

from __future__ import annotations

import codecs
import configparser

from grader.checks.cause import Cause
from grader.checks.causes.syntax import UTF_16
from grader.submission.where import Where

FILE = "setup.cfg"


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
        return Cause("not-utf8", "Save the file as UTF-8.", Where(FILE, data.count(b"\n", 0, error.start) + 1))
    except configparser.MissingSectionHeaderError as error:
        text = "A line with a section, such as [develop], must come before this line."
        return Cause("setup-cfg", text, Where(FILE, error.lineno))
    except configparser.ParsingError as error:
        return Cause("setup-cfg", "This line is neither [SECTION] nor NAME=VALUE.", Where(FILE, error.errors[0][0]))
    except (configparser.DuplicateOptionError, configparser.DuplicateSectionError) as error:
        return Cause(
            "setup-cfg", "Each section, and each name in a section, may occur only once.", Where(FILE, error.lineno)
        )
    return None

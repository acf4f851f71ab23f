"""Explain why setuptools cannot read setup.cfg."""

from __future__ import annotations

import codecs
import configparser

from grader.checks.cause import Cause
from grader.submission.where import Where

FILE = "setup.cfg"
_MARKS = (codecs.BOM_UTF8, codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def why_setup_cfg_unreadable(data: bytes) -> Cause | None:
    """Return the cause if setuptools cannot read this content of setup.cfg, else None."""
    try:
        if data.startswith(_MARKS):
            return Cause("setup-cfg", "Save the file as UTF-8 without a byte order mark (BOM).", Where(FILE))
        configparser.RawConfigParser().read_string(data.decode("utf-8"))
    except UnicodeDecodeError as error:
        return Cause("setup-cfg", "Save the file as UTF-8.", Where(FILE, data.count(b"\n", 0, error.start) + 1))
    except configparser.ParsingError as error:
        line = error.lineno if isinstance(error, configparser.MissingSectionHeaderError) else error.errors[0][0]
        return Cause("setup-cfg", "A line is either [SECTION] or NAME=VALUE.", Where(FILE, line))
    except (configparser.DuplicateOptionError, configparser.DuplicateSectionError) as error:
        return Cause("setup-cfg", "A section, or a name in a section, occurs only once.", Where(FILE, error.lineno))
    return None

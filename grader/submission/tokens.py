"""The tokens of a file that may not be valid Python."""

from __future__ import annotations

import io
import tokenize
from contextlib import suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator


def tokens(data: bytes) -> Iterator[tokenize.TokenInfo]:
    """Yield the tokens of the file, up to the place at which Python's tokenizer fails.

    It may fail at unfinished strings and brackets, at wrong indentation, and at bytes that are not in the encoding of
    the file.
    """
    with suppress(tokenize.TokenError, SyntaxError, UnicodeDecodeError):
        yield from tokenize.tokenize(io.BytesIO(data).readline)

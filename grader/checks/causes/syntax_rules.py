"""Rules of Python's syntax that beginners break, and syntax of other languages with its form in Python."""

from __future__ import annotations

import keyword
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis

RULES: tuple[tuple[str, Diagnosis, str], ...] = (
    (
        r"expected '\('",
        "syntax-error",
        "After def and the name, write parentheses. The name has only letters, digits and underscores.",
    ),
    (
        r"invalid (?:decimal|hexadecimal|octal|binary) literal",
        "syntax-error",
        "A name cannot begin with a digit, and no letter can follow a number directly.",
    ),
    (
        r"non-default argument follows|without a default follows",
        "syntax-error",
        "The parameters with a default value come after all parameters without a default value.",
    ),
    (r"leading zeros", "syntax-error", "Write a number without a zero before it: 5, not 05."),
    (
        r"expected after dictionary key|after dictionary key and ':'",
        "syntax-error",
        "Each entry of a dictionary has a key, a colon and a value.",
    ),
    (
        r"f-string: (?:expecting '}'|single '}'|empty expression|valid expression required)",
        "syntax-error",
        "In an f-string, write { before a value and } after it. For the character { or } itself, write {{ or }}.",
    ),
    (
        r"expected 'except' or 'finally'",
        "syntax-error",
        "After a try block, write except or finally, with the same indentation as try.",
    ),
    (
        r"multiple exception types",
        "syntax-error",
        "To give the exception a name, write as: except ValueError as e. Several types need parentheses.",
    ),
    (r"expected 'else' after", "syntax-error", "This form needs an else: VALUE if CONDITION else OTHER_VALUE."),
    (
        r"assignment expressions",
        "equals",
        "Only a plain name can be before :=. To assign a value on a line of its own, write =.",
    ),
)
"""Tuples (pattern of Python's message, diagnosis, cause). syntax.py uses them after its own patterns."""
KEYWORDS = "|".join(word for word in keyword.kwlist if word.islower())
CAPITALS = "Class|Def|If|Elif|Else|For|While|Import|From|Return|Try|With"
OTHER_LANGUAGES = (
    (r"\s*(?:else\s*if|elsif)\b.*", "Python spells else if as one word: elif."),
    (r".*(?:\+\+|--)\s*;?\s*", "Python has no ++ and no --. Write += 1 or -= 1."),
    (r"\s*(?:def|class|if|for|while)\b.*\{\s*", "In Python, a block begins with a colon, not with a brace."),
    (r"\s*import\s+[\w\s,]+\s+from\s+[\w.]+\s*", "In Python, from comes first: from MODULE import NAME."),
    (r".*[(,]\s*/\w+/?\w*\s*[,)].*", "A topic name is a string, so it needs quotation marks."),
    (r"\s*(?://|/\*).*", "In Python, a comment begins with #."),
    (
        r".*=\s*new\s+\w+.*",
        "Python has no keyword new. To create an object, write the class name, followed by ().",
    ),
    (r"\s*else\s*:.*", "An else needs an if, for, while or try before it, with the same indentation."),
    (r"\s*catch\b.*", "Python has no keyword catch. It has except."),
    (r"\s*(?:function|func|fun|fn|void)\s+\w+\s*\(.*", "In Python, a function begins with the keyword def."),
    (rf"\s*(?:{CAPITALS})\b.*", "Python has its keywords in small letters, such as class, def, if and import."),
    (
        r"\s*(?:var|let|const|int|float|double|str|string|String|bool|auto)\s+[\w.]+\s*=.*",
        "In Python, no word such as var or int comes before the name of a variable.",
    ),
    (r"\s*class\b.*\bextends\b.*", "In Python, the base class is in parentheses: class NAME(BASE)."),
    (r"\s*(?:if|elif|while|for)\b.*\b(?:then|do)\s*:?\s*", "Python has no then and no do. A colon ends this line."),
    (
        r"\s*(?:if|elif|while)\b[^\"'#]*(?:=>|=<|<>|!(?!=)).*",
        "Python compares with ==, !=, <, <=, > and >=. The opposite of a condition begins with the word not.",
    ),
    (r"\s*\w+->.*", "In Python, a dot comes before an attribute, not ->."),
    (
        rf"\s*(?:\w+\.)+(?:{KEYWORDS})\s*=.*|\s*(?:{KEYWORDS})\s*=[^=].*",
        "A keyword of Python, such as class or import, cannot be the name of a variable. Choose another name.",
    ),
)
"""Tuples (pattern of an unreadable line, cause) for syntax of other languages, and for other frequent mistakes."""

"""Operators of mutation: what a line of C++ or GLSL becomes when one thing of it is wrong.

They go by the repository's layout: clang-format puts spaces round binary operators and none round template arguments.
"""

import re
from typing import Iterator, NamedTuple


class Mutant(NamedTuple):
    line: int  # from 0
    column: int
    length: int  # of what is replaced [characters]
    new: str
    operator: str


def masked(text: str) -> str:
    """Returns the text with comments, strings and characters blanked, every place kept."""
    pattern = re.compile(r'//[^\n]*|/\*.*?\*/|R"\(.*?\)"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])\'', re.S)
    return pattern.sub(lambda found: re.sub(r"[^\n]", " ", found.group()), text)


def scaled(number: str) -> str:
    """Returns another number: twice a real one, one more than a whole one, 1 for nothing."""
    body, suffix = re.fullmatch(r"(0[xX][0-9a-fA-F]+|[0-9.eE+-]*?)([fFuUlL]*)", number).groups()
    if re.search(r"[xX]", body):
        return hex(int(body, 16) + 1) + suffix
    if re.search(r"[.eE]", body):
        return repr(float(body) * 2 or 1.0) + suffix
    if suffix[:1] in ("f", "F"):
        return number
    return str(int(body) + 1) + suffix


SWAPS = [  # operator's name, pattern, what takes its place
    ("comparison", r"(?<= )<(?= )", ["<=", ">"]),
    ("comparison", r"(?<= )<=(?= )", ["<", ">"]),
    ("comparison", r"(?<= )>(?= )", [">=", "<"]),
    ("comparison", r"(?<= )>=(?= )", [">", "<"]),
    ("comparison", r"(?<= )==(?= )", ["!="]),
    ("comparison", r"(?<= )!=(?= )", ["=="]),
    ("logic", r"(?<= )&&(?= )", ["||"]),
    ("logic", r"(?<= )\|\|(?= )", ["&&"]),
    ("logic", r"(?<![\w!])!(?=[\w(])", [""]),
    ("logic", r"\btrue\b", ["false"]),
    ("logic", r"\bfalse\b", ["true"]),
    ("arithmetic", r"(?<=\S )\+(?= )", ["-"]),
    ("arithmetic", r"(?<=\S )-(?= )", ["+"]),
    ("arithmetic", r"(?<=\S )\*(?= )", ["/"]),
    ("arithmetic", r"(?<=\S )/(?= )", ["*"]),
    ("arithmetic", r"(?<= )\+=(?= )", ["-="]),
    ("arithmetic", r"(?<= )-=(?= )", ["+="]),
    ("arithmetic", r"(?<= )\*=(?= )", ["/="]),
    ("arithmetic", r"\+\+(?=[\w])|(?<=\w)\+\+", ["--"]),
    ("sign", r"(?<=[(\[])-(?=[\w(])|(?<=[,=?:*/] )-(?=[\w(])|(?<=return )-(?=[\w(])", [""]),
    ("extreme", r"\bstd::min\b", ["std::max"]),
    ("extreme", r"\bstd::max\b", ["std::min"]),
]
NUMBER = re.compile(r"(?<![\w.<])(?:0[xX][0-9a-fA-F]+[uUlL]*|(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]?\d+)?[fFuUlL]*)(?![\w.])")
STATEMENT = re.compile(
    r"(?!(?:return|break|continue|using|case|default|throw|static|const|constexpr|auto|else|for|while|do|goto|explicit)\b)"
    r"(?:[\w.:>\-\[\]*+()]+ [-+*/|&^]?=(?!=) .*|[\w.:>\-\[\]]+\(.*\)|(?:\+\+|--)[\w.>\-]+|if \(.*\) .+);"
)


def mutants_of(text: str) -> Iterator[Mutant]:
    """Yields every mutant of a source, in the order of its lines."""
    before = ";"  # the last character of the code so far: a statement begins after these only
    for row, line in enumerate(masked(text).split("\n")):
        bare = line.strip()
        if not bare or bare.startswith("#") or "static_assert" in bare:
            continue
        for name, pattern, news in SWAPS:
            for found in re.finditer(pattern, line):
                for new in news:
                    yield Mutant(row, found.start(), len(found.group()), new, name)
        for found in NUMBER.finditer(line):
            if (new := scaled(found.group())) != found.group():
                yield Mutant(row, found.start(), len(found.group()), new, "constant")
        if before in ";{}:" and line[0] == " " and STATEMENT.fullmatch(bare) and bare.count("(") == bare.count(")"):
            yield Mutant(row, len(line) - len(line.lstrip()), len(bare), ";", "statement")
        before = bare[-1]


def applied(text: str, mutant: Mutant) -> str:
    """Returns the source with this one fault."""
    lines = text.split("\n")
    line = lines[mutant.line]
    lines[mutant.line] = line[: mutant.column] + mutant.new + line[mutant.column + mutant.length :]
    return "\n".join(lines)

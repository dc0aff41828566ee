#!/usr/bin/env python3
"""Keeps doc/theory.md in step with the code: its index from the paper's equations to the lines where
they happen, and its listing of the reference recursion.

A comment in src/ or include/ that names an equation, such as `// (2.7)`, makes an entry of the index;
a range, such as (2.5)-(2.7), names a chapter and makes none. Entries are one row for each equation and
function; the lines of a row are links. The listing is the file that LISTING names, as it stands.
"""
import argparse
import pathlib
import re
import sys

DOCUMENT = pathlib.PurePath("doc/theory.md")
LISTING = pathlib.PurePath("test/core/reference_recursion.h")
NOTATION = "notation.h"  # the symbols, and no line where anything happens
REFRESH = "refresh it with scripts/equation_index.py --write"
# Links may be off by so many lines: what they name is still on the screen that opens.
REACH = 10
EQUATION = re.compile(r"\((?:2\.[1-7]|3\.[1-8]|4\.[1-3]|5\.(?:1[01]|[1-9]))\)")
RANGE = re.compile(EQUATION.pattern + r"-" + EQUATION.pattern)
COMMENT = re.compile(r"//.*")
CALLED = re.compile(r"(operator\S+|[A-Za-z_]\w*)\s*\(")
TYPE = re.compile(r"\b(?:class|struct)\s+(\w+)[^()]*$")
TEXT = re.compile(r'"(?:[^"\\]|\\.)*"' + r"|'(?:[^'\\]|\\.)*'")
TEMPLATE = re.compile(r"template\s*<[^()]*?>\s*(?=[A-Z_a-z])")
ROW = re.compile(r"^\| (\S+) \| `([^`]*)` \| (\S+): (.*) \|$")
LINK = re.compile(r"\[\d+\]\([^)]*#L(\d+)\)")


class Declarations:
    """The functions and types of a source file, by lines counted from 0."""

    def __init__(self, lines):
        self._inside = [None] * len(lines)  # the function or type that a line begins in
        self._heads = []  # (first line, last line, name or None) of statements outside of functions
        scopes = []  # names; None: a block or a namespace
        head, first = "", 0  # what has been read of a statement, and where it began
        for at, line in enumerate(lines):
            names = [name for name in scopes if name]
            self._inside[at] = names[-1] if names else None
            if line.lstrip().startswith("#"):
                continue
            for letter in TEXT.sub('""', COMMENT.sub("", line)) + "\n":
                if letter not in "{};":
                    if not head.strip():
                        head, first = "", at
                    head += letter
                    continue
                name = self._name(head, scopes)
                if letter == "}" and scopes:
                    scopes.pop()
                elif letter != "}" and head.strip() and not self._in_function(scopes):
                    self._heads.append((first, at, name))
                if letter == "{":
                    scopes.append(name)
                head = ""

    @staticmethod
    def _in_function(scopes):
        return any(scope and scope.endswith("()") for scope in scopes)

    @classmethod
    def _name(cls, head, scopes):
        """What a statement declares or defines: a type, or a function that is not within another."""
        head = TEMPLATE.sub("", head).strip()
        if head.startswith(("namespace", "using", "extern", "enum")) or cls._in_function(scopes):
            return None
        found = TYPE.search(head)
        if found and "=" not in head:
            return found.group(1)
        found = CALLED.search(head)
        return found.group(1) + "()" if found and "=" not in head[:found.start()] else None

    def owner(self, at, alone):
        """The function or type that line `at` is in or, where a comment stands `alone`, introduces."""
        inside = self._inside[at]
        if inside and inside.endswith("()"):
            return inside
        for first, last, name in self._heads:
            if first <= at <= last or (alone and first > at):
                return name or inside or ""
        return inside or ""


def mentions(root):
    """(equation, path, owner) -> lines, in the order of equations, files and lines."""
    found = {}
    for top in ("include", "src"):
        for path in sorted((root / top).rglob("*")):
            if path.suffix not in (".h", ".cpp") or path.name == NOTATION:
                continue
            text = path.read_text(encoding="utf-8")
            if not EQUATION.search(text):
                continue
            lines = text.splitlines()
            place = path.relative_to(root).as_posix()
            declarations = Declarations(lines)
            for at, line in enumerate(lines):
                comment = COMMENT.search(line)
                if not comment:
                    continue
                owner = declarations.owner(at, alone=not line[:comment.start()].strip())
                for equation in set(EQUATION.findall(RANGE.sub("", comment.group()))):
                    found.setdefault((equation, place, owner), []).append(at + 1)
    order = {place: i for i, place in enumerate(dict.fromkeys(place for _, place, _ in found))}
    number = lambda equation: tuple(int(part) for part in equation.strip("()").split("."))
    return dict(sorted(found.items(), key=lambda item: (number(item[0][0]), order[item[0][1]],
                                                        item[1][0])))


def index_of(root):
    """The index as lines of Markdown."""
    lines = ["| equation | in | lines |", "|---|---|---|"]
    for (equation, place, name), at in mentions(root).items():
        links = " ".join(f"[{line}](../{place}#L{line})" for line in at)
        lines.append(f"| {equation} | `{name}` | {place}: {links} |")
    return lines


def listing_of(root):
    """The listing as lines of Markdown."""
    return ["```cpp"] + (root / LISTING).read_text(encoding="utf-8").splitlines() + ["```"]


PARTS = {"index": index_of, "listing": listing_of}


def markers(part):
    return f"<!-- begin {part}: scripts/equation_index.py -->", f"<!-- end {part} -->"


def split(text, part):
    """What stands before, in and behind a part of the document."""
    lines = text.splitlines()
    begin, end = markers(part)
    if lines.count(begin) != 1 or lines.count(end) != 1 or lines.index(end) < lines.index(begin):
        raise ValueError(f"{DOCUMENT}: needs '{begin}' and, behind it, '{end}', once each")
    first, last = lines.index(begin) + 1, lines.index(end)
    return lines[:first], lines[first:last], lines[last:]


def rows_of(lines):
    """(equation, owner, path) -> lines that the rows of an index link to."""
    rows = {}
    for line in lines:
        found = ROW.match(line)
        if found:
            rows[found.group(1, 2, 3)] = [int(at) for at in LINK.findall(found.group(4))]
    return rows


def problems_of(root):
    """Where the document is not in step with the code."""
    text = (root / DOCUMENT).read_text(encoding="utf-8")
    problems = []
    found, wanted = rows_of(split(text, "index")[1]), rows_of(index_of(root))
    for equation, name, place in sorted(set(found) - set(wanted)):
        problems.append(f"{DOCUMENT}: {equation} is no longer in {name} of {place}")
    for row, at in wanted.items():
        equation, name, place = row
        if row not in found:
            problems.append(f"{DOCUMENT}: the index lacks {equation} in {name} of {place}")
        elif len(found[row]) != len(at):
            problems.append(f"{DOCUMENT}: {equation} has {len(found[row])} lines of {name} in {place}, "
                            f"not {len(at)}")
        elif any(abs(old - new) > REACH for old, new in zip(found[row], at)):
            problems.append(f"{DOCUMENT}: {equation} has moved in {place}: {found[row]} is now {at}")
    if split(text, "listing")[1] != listing_of(root):
        problems.append(f"{DOCUMENT}: the listing is not {LISTING}")
    return problems


def write(root):
    path = root / DOCUMENT
    text = path.read_text(encoding="utf-8")
    for part, lines_of in PARTS.items():
        before, _, behind = split(text, part)
        text = "\n".join(before + lines_of(root) + behind) + "\n"
    path.write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(
        description="Prints where the paper's equations are in src/ and include/, by the comments there; "
        "keeps the index and the listing of doc/theory.md in step with the code.")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--write", action="store_true", help="put index and listing into the document")
    what.add_argument("--check", action="store_true",
                      help="fail when the document lacks an entry, has one too many, has a link that is "
                      f"off by more than {REACH} lines, or lists another recursion than that of the test")
    parser.add_argument("--root", type=pathlib.Path,
                        default=pathlib.Path(__file__).resolve().parent.parent,
                        help="checkout to look at (default: this one)")
    arguments = parser.parse_args()
    try:
        if arguments.write:
            write(arguments.root)
        elif not arguments.check:
            for (equation, place, name), at in mentions(arguments.root).items():
                print(f"{equation:<7}{place}:{','.join(map(str, at))} {name}")
        if arguments.write or arguments.check:
            problems = problems_of(arguments.root)
            for problem in problems:
                print(f"{problem}; {REFRESH}", file=sys.stderr)
            return 1 if problems else 0
    except (OSError, ValueError) as error:
        print(f"equation_index.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""Rules about pages: words, lengths, columns, cells of the tables of keys, and the commits of measured pages."""
import re

import index
import source_rules
from tree import Fault

MOST_WORDS, MOST_COLUMNS, MOST_CELL_WORDS = 2300, 120, 25  # ten minutes at 230 words a minute
ITEM = re.compile(r"^(\s*(?:[-*+]|\d+[.)])\s+)(.*)$")
FENCE = re.compile(r"^\s*(```|~~~)")
COMMIT = re.compile(r"\b(?:commit|Made from [^,\s]+,) ([0-9a-f]{7,40})\b")
TOKEN = re.compile(r"(?:`[^`]*`|[^\s`]|`)+")  # what stays in one line: a word, or code
KEYS = "config/KEYS.md"
INDEXED = (KEYS, "monitor/FAULTS.md")  # are searched


def code_lines(lines):
    """Which lines are code: those between fences, and those that four blanks indent outside of a list."""
    found, is_fenced, is_item, before, was_code = [], False, False, "", False
    for line in lines:
        if FENCE.match(line):
            is_fenced = not is_fenced
            was_code = True
        else:
            is_indented = line.startswith("    ") and not is_item and (was_code or not before.strip())
            was_code = is_fenced or is_indented
        if not line.startswith(" ") and line.strip():
            is_item = bool(ITEM.match(line)) or (is_item and bool(before.strip()))
        found.append(was_code)
        before = line
    return found


def prose(text):
    """The lines outside of code: number and text."""
    lines = text.split("\n")
    return [(number, line) for number, (line, is_code) in enumerate(zip(lines, code_lines(lines)), 1) if not is_code]


def cells(line):
    """The cells of a row of a table; none if the line is no row."""
    if not line.startswith("|") or re.fullmatch(r"[|\s:-]+", line):
        return []
    bare = line.strip().removeprefix("|").removesuffix("|")
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", bare)]


def can_break(line):
    """Has the line a blank at which it could be broken before the limit? A heading or a long address has none."""
    begin = re.match(r"\s*(?:[-*+]\s|\d+\.\s)?\s*", line).end()
    first = TOKEN.match(line, begin)
    return not line.startswith("#") and first is not None and first.end() < min(MOST_COLUMNS + 1, len(line.rstrip()))


def check(tree):
    words = source_rules.Words(tree)
    references = {row.split()[0] for _, row in tree.rows("references.txt")}
    for path in tree.of(".md"):
        lines = list(prose(tree.text(path)))
        count = sum(len(line.split()) for _, line in lines)
        if count > MOST_WORDS and path not in references:
            yield Fault("page-length", path, 1, f"has {count} words; {MOST_WORDS} at most, unless tests/house/references.txt lists it")
        for number, line in lines:
            for _, word, instead in words.in_text(re.sub(r"`[^`]*`|\]\([^)]*\)", "", line)):
                yield Fault("word", path, number, f"found '{word}'; write {instead}")
            if len(line) > MOST_COLUMNS and not line.startswith("|") and can_break(line):
                yield Fault("page-line", path, number,
                            f"has {len(line)} columns; {MOST_COLUMNS} at most (tests/house/reflow {path} does it)")
            for cell in cells(line) if path == KEYS else ():
                if len(cell.split()) > MOST_CELL_WORDS:
                    yield Fault("cell", path, number, f"a cell has {len(cell.split())} words; {MOST_CELL_WORDS} at most: '{cell[:40]}...'")
        if path in INDEXED and not index.is_right(tree.text(path)):
            yield Fault("index", path, 1, f"'## Index' is not what the page holds (tests/house/reflow {path} writes it)")
    for path in sorted(references - set(tree.paths)):
        yield Fault("page-length", path, 1, "is in tests/house/references.txt and does not exist")
    yield from measured(tree)


def measured(tree):
    """A measured page says of which commit its figures are, and that commit can be built again."""
    history = set((tree.git("rev-list", "HEAD") or "").split()) if tree.has_history() else None
    for path in tree.of(".md", under="tools/bench/measured/"):
        text = tree.text(path)
        commits = [(text.count("\n", 0, found.start()) + 1, found[1]) for found in COMMIT.finditer(text)]
        if not commits:
            yield Fault("measured", path, 1, "names no commit; expected 'commit HASH' or 'Made from VERSION, HASH'")
        for line, commit in commits if history is not None else ():
            if not any(each.startswith(commit) for each in history):
                yield Fault("measured", path, line, f"commit {commit} is not in the history")

"""Rules about sources: lengths, the words of comments and names, how a comment begins, and locks that state what they guard."""
import re

import sources
from tree import Fault

MOST_LINES, MOST_FUNCTION_LINES = 400, 80
# A comment that begins with one of these has neither a noun nor a verb there, and no sentence before it to lean on. That
# the rest has a verb cannot be decided by a list, so it is not.
NO_BEGINNING = set("""also and again because but else hence it its like nor not or otherwise so than that their them
then therefore they those thus too which who whom whose yet""".split())
# Clang cannot check these locks. Packages that build alone against ROS 2 lack the product's headers.
_BARE_LOCK = re.compile(r"\bstd::(\w*mutex|lock_guard|unique_lock|scoped_lock|shared_lock)\b")
_OF_LOCKS, _WITHOUT_LOCKS = ("core/", "config/", "monitor/", "tools/"), ("monitor/interface/mutex.hpp", "tools/ros2/")
_PARTS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")


class Words:
    """The list of words that are not used, each with what is used instead.

    A row is `word TEXT -> REPLACEMENT` for comments and pages, `part TEXT -> ...` for a part of a name, or
    `name EXPRESSION -> ...` for whole names.
    """

    def __init__(self, tree):
        self.words, self.parts, self.names, self.bad_rows = {}, {}, [], []
        for where, row in tree.rows("words.txt"):
            found = re.fullmatch(r"(word|part|name)\s+(.+?)\s+->\s+(\S.*)", row)
            if not found:
                self.bad_rows.append(Fault("word", *where.split(":"), f"found '{row}'; expected KIND WORD -> REPLACEMENT"))
            elif found[1] == "name":
                self.names.append((re.compile(found[2]), found[3]))
            else:
                (self.words if found[1] == "word" else self.parts)[found[2]] = found[3]
        any_word = "|".join(re.escape(word).replace(r"\ ", r"\s+") for word in self.words)
        self._text = re.compile(rf"(?<![\w-])({any_word})(?![\w-])", re.IGNORECASE) if any_word else None

    def in_text(self, text):
        """The words of the list in this text, each with its place."""
        for found in self._text.finditer(text) if self._text else ():
            word = " ".join(found[1].lower().split())
            yield found.start(), word, self.words[word]

    def in_name(self, name):
        bare = name.rstrip("_")
        for expression, instead in self.names:
            if expression.fullmatch(bare):
                return instead
        for part in _PARTS.findall(bare):
            if part.lower() in self.parts:
                return self.parts[part.lower()]
        return None


def check(tree):
    words = Words(tree)
    yield from words.bad_rows
    for path in tree.of(".cpp", ".hpp"):
        source = sources.CppSource(tree.text(path))
        yield from lengths(path, tree.text(path), source.functions())
        yield from comments(path, source.comments, words)
        if path.startswith(_OF_LOCKS) and not path.startswith(_WITHOUT_LOCKS):
            yield from locks(path, tree.text(path))
        for name, line in source.names().items():
            if instead := words.in_name(name):
                yield Fault("word", path, line, f"found the name '{name}'; write {instead}")
    for path in tree.scripts():
        text = tree.text(path)
        is_python = path.endswith(".py") or "python" in text.split("\n", 1)[0]
        yield from lengths(path, text, sources.python_functions(text) if is_python else [])
        yield from comments(path, sources.hash_comments(text), words)
    for path in tree.of(".js", ".mjs", ".idl"):
        text = tree.text(path)
        yield from lengths(path, text, [])
        yield from comments(path, sources.CppSource(text).comments, words)


def lengths(path, text, functions):
    lines = text.count("\n")
    if lines > MOST_LINES:
        yield Fault("file-length", path, 1, f"has {lines} lines; {MOST_LINES} at most")
    if functions is None:
        yield Fault("function-length", path, 1, "has braces that do not close each other, so no function was found")
    for function in functions or ():
        if function.lines > MOST_FUNCTION_LINES:
            yield Fault("function-length", path, function.line,
                        f"{function.name} has {function.lines} lines; {MOST_FUNCTION_LINES} at most")


def locks(path, text):
    for number, line in enumerate(text.splitlines(), 1):
        if found := _BARE_LOCK.search(line):
            yield Fault("lock", path, number, f"found '{found[0]}'; write Mutex or Lock (monitor/interface/mutex.hpp)")


def comments(path, blocks, words):
    for block in blocks:
        for _, word, instead in words.in_text(block.text):
            yield Fault("word", path, block.line, f"found '{word}'; write {instead}")
        first = re.match(r"[A-Za-z]+(?![\w'(])", block.text)
        if block.is_alone and first and first[0][0].isupper() and first[0].lower() in NO_BEGINNING:
            yield Fault("comment", path, block.line, f"begins with '{first[0]}'; begin with a verb or a noun")

"""The rule about what a user can state: each option and each key is named by a page or by a test.

It sees options and keys that stand as texts in sources of C++: an option that a `add_option`, `add_flag` or a row of a
table names, a key that a reader asks its map for, or a row with the member that it sets. It does not see names that are
put together.
"""
import re

from tree import Fault

_OPTION = re.compile(r'(?:add_(?:option|flag|flag_function|option_function)\w*(?:<[^>]*>)?\(|\{)\s*'
                     r'"(?:-\w,)?(--[a-z][a-z0-9-]*)(?:,--[a-z0-9-]+)*"')
_KEY = re.compile(r'\b(?:optional|required)\w*\(\s*(?:\w+,\s*)?"([a-z][a-z0-9_]*)"|\{"([a-z][a-z0-9_]*)",\s*&\w+::')


def check(tree):
    named = "\n".join(tree.text(path) for path in tree.of(".md"))
    tests = [path for path in tree.paths if path.startswith("tests/") and not path.startswith("tests/house/")]
    named += "\n".join(tree.text(path) for path in tests)
    sources = [path for path in tree.of(".cpp", ".hpp") if not path.startswith("tests/")]
    options = set(re.findall(r"--[a-z][a-z0-9-]*", named))
    yield from unnamed(tree, "option", _OPTION, sources, options)
    keys = set(re.findall(r"[a-z][a-z0-9_]*", "\n".join(tree.text(path) for path in tree.of(".md"))))
    yield from unnamed(tree, "key", _KEY, [path for path in sources if path.startswith("config/")], keys)


def unnamed(tree, kind, expression, sources, named):
    places = "no page names it" if kind == "key" else "no page and no test names it"
    for path in sources:
        text = tree.text(path)
        for found in expression.finditer(text):
            name = next(group for group in found.groups() if group)
            if name not in named:
                yield Fault(kind, path, text.count("\n", 0, found.start()) + 1, f"found the {kind} '{name}'; {places}")

"""The list of slips: reads it, finds each slip in the sources, and plants all of them as switches."""
import collections, pathlib, re

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "tests" / "mutants"
PRODUCT = ("core", "config", "monitor")  # the folders that slips are planted into
HEADER = "tests/mutants/chosen_slip.hpp"
NUMBERS = int(re.search(r"kClearanceSlips = (\d+);", (ROOT / HEADER).read_text())[1])  # of slips are below this

# `tests`: the folder in tests/ whose tests come first.
Slip = collections.namedtuple("Slip", "id file tests context original text reason where")
FILE = re.compile(r"^([^\s`]+)(?: +first +tests/(\S+))?$")
ROW = re.compile(r"^(\d+) +`([^`]+)` +-> +`([^`]*)`(?: +for +([^#]+?))?(?: +# (.*))?$")
EACH = "{each}"  # in a row that ends with `for WORD WORD`: one word a slip


class ListError(Exception):
    """A row that does not fit the sources, or that nobody can read."""


def lists():
    return sorted(FOLDER.glob("*.slips"))


def read_lists():
    """All slips of tests/mutants/*.slips, sorted by number."""
    slips, errors = {}, []
    for path in lists():
        file, tests = None, None
        for number, line in enumerate(path.read_text().splitlines(), 1):
            where = f"{path.name}:{number}"
            if not line.strip() or line.startswith("#"):
                continue
            if named := FILE.match(line.strip()):
                file, tests = named[1], (named[2] or named[1].rpartition("/")[0]) + "/"
                continue
            match = ROW.match(line)
            if not match or not file:
                errors.append(f"{where}: expected NUMBER `original` -> `slip`, with the name of a file above it")
                continue
            for slip in slips_of_row(match, file, tests, where):
                if slip.id in slips:
                    errors.append(f"{where}: {slip.id} is taken by {slips[slip.id].where}: choose a number that is free")
                elif slip.id >= NUMBERS:
                    errors.append(f"{where}: {slip.id} is too high: choose a number below {NUMBERS}")
                elif ("{|" in slip.context) != ("|}" in slip.context):
                    errors.append(f"{where}: {{| and |}} mark the expression in its context: one of them is missing")
                else:
                    slips[slip.id] = slip
    if errors:
        raise ListError("\n".join(errors))
    return [slips[number] for number in sorted(slips)]


def slips_of_row(match, file, tests, where):
    """One slip; or, with `for`, one for each word, numbered on from the number of the row."""
    number, context, text, words, reason = match.groups()
    for offset, word in enumerate(words.split() if words else [""]):
        of_word, slip = context.replace(EACH, word), text.replace(EACH, word)
        marked = of_word.partition("{|")[2].partition("|}")[0]
        yield Slip(int(number) + offset, file, tests, of_word, marked or of_word, slip, reason, where)


def pattern(text):
    """A regular expression that finds the text whatever its line breaks and indentation are."""
    return r"\s+".join(re.escape(word) for word in text.split())


def span(slip, source):
    """Where the slip's expression stands in the source: (begin, end)."""
    before, mark, rest = slip.context.partition("{|")
    if mark:
        inside, _, after = rest.partition("|}")
        spaced = lambda left, right: r"\s*" if left[-1:].isspace() or right[:1].isspace() else ""
        expression = (pattern(before) + spaced(before, inside) + "(" + pattern(inside) + ")" +
                      spaced(inside, after) + pattern(after))
    else:
        expression = "(" + pattern(slip.context) + ")"
    found = list(re.finditer(expression, source))
    if len(found) != 1:
        times = "not at all" if not found else f"{len(found)} times"
        raise ListError(f"{slip.where}: slip {slip.id}: its text occurs {times} in {slip.file}: `{slip.context}`. "
                        "Adapt the row to the source, so that the text is found exactly once.")
    return found[0].span(1)


# What stands before a statement, once comments are left out; and an operator that has lost its left operand.
BEFORE_STATEMENT = re.compile(r"([;{}):]|\belse)\s*(//[^\n]*\s*)*$")
LOOSE = re.compile(r"[-+*/%&|<>=?]+ ")


def compiles_as_a_choice(source, begin, original):
    """Whether the text is a whole statement or an expression that may stand in parentheses, as far as its ends tell."""
    if original.endswith(";"):
        return BEFORE_STATEMENT.search(source, 0, begin) is not None
    return not LOOSE.match(original)


def plant_into(source, slips):
    """The source with all slips of its file as switches; line numbers stay. Raises ListError."""
    spans, errors = collections.defaultdict(list), []
    for slip in slips:
        try:
            begin, end = span(slip, source)
            spans[begin, end].append(slip)
            if not compiles_as_a_choice(source, begin, source[begin:end]):
                errors.append(f"{slip.where}: slip {slip.id}: `{source[begin:end]}` is a part of a statement or of an "
                              "expression: mark a whole expression by {| and |}.")
        except ListError as error:
            errors.append(str(error))
    ordered = sorted(spans)
    for (begin, end), (next_begin, _) in zip(ordered, ordered[1:]):
        if next_begin < end:
            one, other = spans[begin, end][0], [s for k, s in spans.items() if k[0] == next_begin][0][0]
            errors.append(f"{one.where}: slip {one.id} overlaps slip {other.id}: mark equal or separate expressions")
    if errors:
        raise ListError("\n".join(errors))
    for begin, end in reversed(ordered):
        original = source[begin:end]
        planted = spans[begin, end]
        if original.endswith(";"):
            cases = "".join(f"if (clearance_slip({s.id})) {{ {s.text} }} else " for s in planted)
            text = f"{{ {cases}{{ {original} }} }}"
        else:
            text = "(" + "".join(f"clearance_slip({s.id}) ? ({s.text}) : " for s in planted) + f"({original}))"
        source = source[:begin] + text + source[end:]
    return source


def by_file(slips):
    files = collections.defaultdict(list)
    for slip in slips:
        files[slip.file].append(slip)
    return files


def planted_sources(slips):
    """{file: its text with switches} for every file that has slips. Raises ListError with all that is wrong."""
    sources, errors = {}, []
    for file, of_file in sorted(by_file(slips).items()):
        if not file.startswith(tuple(folder + "/" for folder in PRODUCT)) or not (ROOT / file).is_file():
            errors.append(f"{of_file[0].where}: there is no product source {file}")
            continue
        try:
            sources[file] = plant_into((ROOT / file).read_text(), of_file)
        except ListError as error:
            errors.append(str(error))
    if errors:
        raise ListError("\n".join(errors))
    return sources

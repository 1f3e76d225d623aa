"""The index of a page that is searched: its sections, each with the keys or codes that its tables explain."""
import re

HEADING = "## Index\n"
_SECTION = re.compile(r"^##+ (.+)$")
_NAME = re.compile(r"`\[?([a-z][a-z0-9_/-]*)\]?`")


def _cells(line):
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip().removeprefix("|").removesuffix("|"))]


def _anchor(title):
    return re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def sections(text):
    """Titles, each with the names that stand in columns of keys, sections or codes, in their order."""
    found, title, columns, last = [], None, [], ""
    for line in text.split("\n"):
        if heading := _SECTION.match(line):
            title = heading[1]
            found.append((title, {}))
        if not line.startswith("|"):
            columns = []
        elif re.fullmatch(r"[|\s:-]+", line):
            columns = [i for i, head in enumerate(_cells(last)) if re.match(r"(key|section|code)\b", head)]
        elif title and columns:
            cells = _cells(line)
            # What a bracket adds is about another section's keys.
            texts = [re.sub(r"\(.*?\)", "", cells[i]) for i in columns if i < len(cells)]
            found[-1][1].update((name, None) for text in texts for name in _NAME.findall(text))
        last = line
    return found


def index(text):
    """The section of the index as it has to be, with lines of any length."""
    rows = [f"- [{title}](#{_anchor(title)}): " + ", ".join(f"`{name}`" for name in names) for title, names in sections(text) if names]
    return HEADING + "\n" + "\n".join(rows) + "\n\n"


def present(text):
    """The section of the index as it is; none if the page has no index."""
    if HEADING not in text:
        return None
    begin = text.index(HEADING)
    end = text.find("\n## ", begin)
    return text[begin:end + 1] if end >= 0 else text[begin:]


def is_right(text):
    there = present(text)
    return there is not None and there.split() == index(text.replace(there, "")).split()


def written(text):
    """The page with its index made anew; unchanged if it has none."""
    there = present(text)
    return text if there is None else text.replace(there, index(text.replace(there, "")))

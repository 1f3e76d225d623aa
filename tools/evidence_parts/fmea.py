"""Faults as cause, effect, detection, time, reaction and test: the rows of monitor/FAULTS.md, with times of a run."""
import re

# Titles of columns in FAULTS.md by their meaning here; the first match counts.
COLUMNS = {
    "detection": ("code", "CAUSE", "code, or the line", "code, or what you see", "code of the line, or status",
                  "message", "the line says", "the line"),
    "cause": ("cause", "meaning", "the line says, or cause", "what is wrong", "what happens", "fault of a client"),
    "effect": ("published meanwhile", "what the daemon does"),
    "reaction": ("what to do",),
    "test": ("test",),
}
MEASURED = "time until detected: "  # properties of tests: "MEDIAN LONGEST RUNS", in ticks


def cells(line):
    return [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line.strip())[1:-1]]


def tables(text):
    """Of each table of a page: its section, its columns, and its rows as lists of cells."""
    section, lines = "", text.splitlines()
    for i, line in enumerate(lines):
        if line.startswith("#"):
            section = line.lstrip("# ")
        elif re.fullmatch(r"[|\s:-]*-[|\s:-]*", line) and i and lines[i - 1].startswith("|"):
            rows = []
            for row in lines[i + 1:]:
                if not row.startswith("|"):
                    break
                rows.append(cells(row))
            yield section, cells(lines[i - 1]), rows


def without_links(text):
    return re.sub(r"\[([^\]]+)\]\([^)]+\)", r"\1", text)


def anchor(section):
    return re.sub(r"[^a-z0-9 -]", "", section.lower()).replace(" ", "-")


def rows(page):
    """All rows that name a cause and what to do, or what happens. An empty first cell repeats the one above.

    Where a row says nothing of its effect, detection or reaction, the line of its code or of its section does.
    """
    tested, defaults, found = {}, {}, []
    for section, columns, listed in tables(page):
        if columns == ["section", "rows", "tests"]:
            for sections, _, tests in listed:
                for name in re.findall(r"\(#([^)]+)\)", sections):
                    tested.setdefault(name, []).append(without_links(tests))
            continue
        if columns[0] == "of rows in":
            for codes_or_section, effect, detection, reaction in listed:
                for name in re.findall(r"\(#([^)]+)\)|(`\[[a-z-]+\]`)", codes_or_section):
                    defaults["".join(name)] = {"effect": effect, "detection": detection, "reaction": without_links(reaction)}
            continue
        places = {kind: next((columns.index(name) for name in names if name in columns), None)
                  for kind, names in COLUMNS.items()}
        if places["cause"] is None or (places["reaction"] is None and places["effect"] is None):
            continue
        above = ""
        for row in listed:
            entry = {kind: without_links(row[place]) if place is not None else "" for kind, place in places.items()}
            above = entry["detection"] = entry["detection"] or above
            if not above:
                entry["detection"] = ", ".join(f"see {code}" for code in re.findall(r"`\[[a-z-]+\]`", entry["cause"]))
            found.append({"section": section, **entry})
    for entry in found:
        entry["test"] = entry["test"] or "; ".join(tested.get(anchor(entry["section"]), []))
        of_code = [code for code in re.findall(r"`\[[a-z-]+\]`", entry["detection"]) if code in defaults]
        for name in [*of_code, anchor(entry["section"])]:
            for kind, text in defaults.get(name, {}).items():
                entry[kind] = entry[kind] or text
    return found


def tells(row, name):
    """True if a row is about this code of the log, or about this cause of a refusal."""
    is_of_code = row["detection"].startswith("`[") and f"`[{name}]`" in row["detection"]
    return is_of_code or name in [part.strip() for part in row["detection"].split(";")]


def joined(page, times):
    """The rows with the times of {name: [{kind, p50, max, runs}]}, each at its first row; and what has no row."""
    found, lost = rows(page), []
    for entry in found:
        entry["times"] = []
    for name, measured in sorted(times.items()):
        row = next((entry for entry in found if tells(entry, name)), None)
        if row is None:
            lost.append(f"monitor/FAULTS.md has no row for '{name}', which {measured[0]['test']} has told")
        else:
            row["times"] += [{"told_as": name, **each} for each in measured]
    return found, lost


def times_of(case, suite):
    """The times that a case of googletest's JSON has recorded, by name."""
    for key, value in case.items():
        if key.startswith(MEASURED):
            p50, longest, runs = map(int, value.split())
            yield key.removeprefix(MEASURED), {"kind": case["name"].split("/")[-1], "test": f"{suite}.{case['name']}",
                                               "p50_ticks": p50, "max_ticks": longest, "runs": runs}

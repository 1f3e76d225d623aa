"""The list of what breaks a rule and may do so: RULE PATH COUNT. A path that ends with / is a folder."""
import re

from tree import Fault

LIST = "tests/house/exceptions.txt"


def read(tree):
    """The rows: place, rule, path, count."""
    for where, row in tree.rows("exceptions.txt"):
        words = row.split()
        if len(words) != 3 or not words[2].isdigit() or words[2] == "0":
            raise SystemExit(f"{where}: found '{row}'; expected RULE PATH COUNT")
        yield int(where.rpartition(":")[2]), words[0], words[1], int(words[2])


def assign(tree, faults):
    """Each row with its faults, and the faults that no row names. A fault belongs to the longest path that fits."""
    rows = list(read(tree))
    of_row = {row: [] for row in rows}
    rest = []
    for fault in faults:
        fitting = [row for row in rows if row[1] == fault.rule and
                   (fault.path == row[2] or row[2].endswith("/") and fault.path.startswith(row[2]))]
        if fitting:
            of_row[max(fitting, key=lambda row: len(row[2]))].append(fault)
        else:
            rest.append(fault)
    return of_row, rest


def judge(tree, faults):
    """The faults that the list does not allow, and the rows that allow more than there is."""
    of_row, out = assign(tree, faults)
    for (line, rule, path, count), found in of_row.items():
        if len(found) > count:
            out += [fault._replace(text=f"{fault.text} ({path} may have {count}, has {len(found)})") for fault in found]
        elif len(found) < count:
            out.append(Fault(rule, LIST, line, f"{path} has {len(found)} of {count}: lower it, or tests/house/check --tighten does"))
    return out


def tighten(tree, faults):
    """Lowers the counts to what was found, and drops the rows and the groups of which nothing is left."""
    of_row, _ = assign(tree, faults)
    lines = tree.text(LIST).split("\n")
    for (line, _, _, count), found in of_row.items():
        if len(found) < count:
            lines[line - 1] = re.sub(r"\b\d+(?=\s*(#|$))", str(len(found)), lines[line - 1], count=1) if found else None
    head, *groups = "\n".join(line for line in lines if line is not None).strip().split("\n\n")
    groups = [group for group in groups if any(not line.startswith("#") for line in group.split("\n"))]
    (tree.root / LIST).write_text("\n\n".join([head, *groups]) + "\n", encoding="utf-8")

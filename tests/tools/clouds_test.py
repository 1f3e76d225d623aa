#!/usr/bin/env python3
"""Replays rendered bags with the cells of config/cells/cameras, and has the folder's check.py judge the distances.

usage: clouds_test.py BUILD [FOLDER]
  BUILD    has bin/clearance-replay
  FOLDER   has the six bags, check.py, and beside it `robots` with the descriptions; or $CLEARANCE_CLOUDS.
           Without either, nothing is checked, and the status is 77.
"""

import csv
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

CELLS = Path(__file__).resolve().parents[2] / "config/cells/cameras"
BAGS = {
    "a1_fr3_depth16": "fr3_depth",
    "a2_fr3_cloud": "fr3_points",
    "a3_fr3_vga32": "fr3_depth",
    "a4_fr3_unorganised": "fr3_points",
    "b1_ur5_table_depth16": "ur5_depth",
    "b2_ur5_table_cloud": "ur5_points",
}
ORGANISED = ("a2_fr3_cloud", "b2_ur5_table_cloud")


def links_of(table, links):
    """The table of check.py: a row for each link and tick."""
    with open(table, newline="") as rows, open(links, "w", newline="") as to:
        out = csv.writer(to)
        out.writerow(["t_ns", "link", "lower", "upper"])
        for row in csv.DictReader(rows):
            link = row["object_b"] if row["object_a"] == "camera" else row["object_a"]
            out.writerow([row["now_ns"], link, row["lower"], row["upper"]])


def judged(replay, folder, bag, cell, work, environment):
    """Says what check.py found of this bag, and returns whether it found no fault."""
    table, links = work / "table.csv", work / "links.csv"
    done = subprocess.run(
        [replay, "check", "--cell", cell, folder / bag, "--tick-hz", "0", "--csv", table, "--force"],
        env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        print(f"{bag}: clearance-replay ended with status {done.returncode}\n{done.stdout}{done.stderr}")
        return False
    links_of(table, links)
    # The truth of depth images is rounded to float32.
    eps = "1e-6" if "depth" in cell.stem else "1e-9"
    check = subprocess.run(
        [sys.executable, folder / "check.py", links, folder / bag, "--eps", eps], capture_output=True, text=True)
    said = [line for line in check.stdout.splitlines() if check.returncode != 0 or re.match(r"\d+ rows|slack|no fault", line)]
    print(f"{bag}, {cell.name}:", *said, check.stderr, sep="\n  ", flush=True)
    return check.returncode == 0


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    given = sys.argv[2] if len(sys.argv) == 3 else os.environ.get("CLEARANCE_CLOUDS", "")
    if not given:
        print("skipped: no folder with the rendered bags is given (CLEARANCE_CLOUDS)")
        return 77
    folder = Path(given).resolve()
    replay = Path(sys.argv[1]).resolve() / "bin/clearance-replay"
    with tempfile.TemporaryDirectory() as name:
        work = Path(name)
        (work / "share").symlink_to(folder.parent / "robots")
        environment = {**os.environ, "AMENT_PREFIX_PATH": name}
        good = [judged(replay, folder, bag, CELLS / f"{cell}.yaml", work, environment) for bag, cell in BAGS.items()]
        for bag in ORGANISED:
            cell = work / f"{BAGS[bag]}_neighbours.yaml"
            text = (CELLS / f"{BAGS[bag]}.yaml").read_text()
            cell.write_text(re.sub(r"spacing: [0-9.]+", "spacing: neighbours", text))
            good.append(judged(replay, folder, bag, cell, work, environment))
    print(f"{sum(good)} of {len(good)} without a fault")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())

"""Checks the layouts of ROS 2 types in idl/ against the type hashes that Clearance announces.

Oracle: the hashes in monitor/wire, which ROS 2's own tools computed (REP-2011). A field with another name, type or place gives another
hash. The hashes of our own messages come from the same function.
"""

import pathlib
import re
import sys

root = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(root / "idl"))
sys.dont_write_bytecode = True

import ros_messages  # noqa: E402


def main():
    types = ros_messages.all_types(root / "idl")
    stated = []
    for path in sorted((root / "monitor/wire").glob("*_types.hpp")):
        stated += re.findall(r"&(\w+?)_msg_dds__(\w+?)__desc,\s*\"typehash=RIHS01_([0-9a-f]{64});\"", path.read_text())
    wrong = 0
    for package, name, expected in stated:
        found = ros_messages.type_hash(f"{package}/msg/{name}", types)
        if found != expected:
            wrong += 1
            print(f"{package}/msg/{name}: the layout has the hash {found}, and {expected} is announced")
    print(f"{len(stated)} types, {wrong} with a wrong layout or hash")
    return 1 if wrong or len(stated) < 9 else 0


if __name__ == "__main__":
    sys.exit(main())

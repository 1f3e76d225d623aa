"""Checks the layouts of ROS 2 types in idl/ against the type hashes that Clearance announces.

Oracle: REP-2011. The hash of a type is the SHA-256 of its description as JSON, with the descriptions of all types that it contains. A
field with another name, type or place gives another hash. The hashes in monitor/wire are those that ROS 2's own tools computed.
"""

import hashlib
import json
import pathlib
import re
import sys

NESTED, ARRAY, BOUNDED, UNBOUNDED = 1, 48, 96, 144
IDS = {"int8": 2, "octet": 3, "long": 6, "unsigned long": 7, "float": 10, "double": 11, "boolean": 15, "string": 17}
# `byte` in ROS 2; every other octet is a `uint8`. Both are one octet on the wire.
BYTES = {("diagnostic_msgs/msg/DiagnosticStatus", "level"), ("moveit_msgs/msg/CollisionObject", "operation")}
BYTE = 16


def ros_name(scope, name):
    parts = name.split("::")
    package = scope if len(parts) == 1 else parts[0]
    return f"{package}/msg/{parts[-1][:-1]}"


def fields_of(package, owner, body):
    fields = []
    for kind, length, name, size in re.findall(
        r"(sequence<[^;]*?>|unsigned long|[\w:]+?)(?:<(\d+)>)?\s+(\w+)(?:\[(\d+)\])?;", body
    ):
        offset = capacity = 0
        inner = kind
        if kind.startswith("sequence<"):
            inner, _, bound = kind[len("sequence<") : -1].partition(",")
            offset, capacity = (BOUNDED, int(bound)) if bound else (UNBOUNDED, 0)
        elif size:
            offset, capacity = ARRAY, int(size)
        inner = inner.strip()
        nested = "" if inner in IDS else ros_name(package, inner)
        number = IDS.get(inner, NESTED)
        if (owner, name) in BYTES:
            number = BYTE
        fields.append(
            {
                "name": name,
                "type": {
                    "type_id": number + offset,
                    "capacity": capacity,
                    "string_capacity": int(length or 0),
                    "nested_type_name": nested,
                },
            }
        )
    return fields


def types_in(text):
    text = re.sub(r"//.*", "", text)
    types = {}
    for package, module in re.findall(r"module (\w+) \{ module msg \{ module dds_ \{(.*?)\}; \}; \};", text, re.S):
        for name, body in re.findall(r"@final struct (\w+)_ \{(.*?)\};", module, re.S):
            full = f"{package}/msg/{name}"
            types[full] = fields_of(package, full, body)
    return types


def contained(name, types, found):
    for field in types[name]:
        nested = field["type"]["nested_type_name"]
        if nested and nested not in found:
            found.add(nested)
            contained(nested, types, found)
    return found


def type_hash(name, types):
    def description(each):
        return {"type_name": each, "fields": types[each]}

    text = json.dumps(
        {
            "type_description": description(name),
            "referenced_type_descriptions": [description(each) for each in sorted(contained(name, types, set()))],
        }
    )
    return hashlib.sha256(text.encode()).hexdigest()


def main(root):
    types = {}
    for path in ("idl/ros2.idl", "idl/moveit.idl", "idl/camera.idl"):
        types.update(types_in((root / path).read_text()))
    stated = []
    for path in sorted((root / "monitor/wire").glob("*_types.hpp")):
        stated += re.findall(r"&(\w+?)_msg_dds__(\w+?)__desc,\s*\"typehash=RIHS01_([0-9a-f]{64});\"", path.read_text())
    wrong = 0
    for package, name, expected in stated:
        found = type_hash(f"{package}/msg/{name}", types)
        if found != expected:
            wrong += 1
            print(f"{package}/msg/{name}: the layout has the hash {found}, and {expected} is announced")
    print(f"{len(stated)} types, {wrong} with a wrong layout or hash")
    return 1 if wrong or len(stated) < 9 else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(__file__).resolve().parents[2]))

#!/usr/bin/env python3
"""Makes the ROS 2 package clearance_msgs from clearance.idl: its messages, the same types for DDS, and their type hashes.

usage: idl/ros_messages.py FOLDER [--version 0.2.0]
  FOLDER/clearance_msgs/            package.xml, CMakeLists.txt and msg/*.msg, for colcon
  FOLDER/clearance_msgs.idl         the types as ROS 2 has them in DDS, for idlc
  FOLDER/clearance_msgs_hashes.hpp  USER_DATA of their readers and writers
example: idl/ros_messages.py build/ros2

ROS 2 has no keys and no constants as bounds. The messages have the fields of the IDL in the same order, so that one layout in memory
and on the wire serves both. A topic whose type has a key becomes a message with the list of all its instances.
"""

import argparse
import hashlib
import json
import pathlib
import re
import sys

NESTED, ARRAY, BOUNDED, UNBOUNDED, BOUNDED_STRING, BYTE = 1, 48, 96, 144, 21, 16
# IDL: the number of the type in a type description (REP-2011), and its name in a .msg file.
BASIC = {
    "int8": (2, "int8"),
    "octet": (3, "uint8"),
    "long": (6, "int32"),
    "unsigned long": (7, "uint32"),
    "long long": (8, "int64"),
    "unsigned long long": (9, "uint64"),
    "float": (10, "float32"),
    "double": (11, "float64"),
    "boolean": (15, "bool"),
    "string": (17, "string"),
}
# `byte` in ROS 2; every other octet is a `uint8`. Both are one octet on the wire.
BYTES = {("diagnostic_msgs/msg/DiagnosticStatus", "level"), ("moveit_msgs/msg/CollisionObject", "operation")}
# Types that ROS 2 has already, with the same fields.
STANDARD = {"Vector3": "geometry_msgs/msg/Vector3", "Quaternion": "geometry_msgs/msg/Quaternion"}
OURS = "clearance_msgs"
# The messages of topics, by the keys of topics. Zones have a key in DDS, and so a list here.
TOPICS = {
    "catalogue": "Catalogue",
    "distances": "Distances",
    "zones": "ZoneStates",
    "health": "Health",
    "separation": "Separation",
    "gradients": "Gradients",
}


class Field:
    def __init__(self, owner, kind, name, size, constants):
        self.name, self.comment = name, ""
        sequence = re.fullmatch(r"sequence<\s*(.+?)\s*(?:,\s*(\w+)\s*)?>", kind)
        inner = sequence[1] if sequence else kind
        bounded = re.fullmatch(r"string<(\d+)>", inner)
        self.string_capacity = int(bounded[1]) if bounded else 0
        self.inner = "string" if bounded else inner
        bound = sequence and sequence[2]
        self.capacity = int(size or constants.get(bound, bound) or 0)
        self.offset = (BOUNDED if bound else UNBOUNDED) if sequence else ARRAY if size else 0
        self.nested = ""
        if self.inner not in BASIC:
            parts = self.inner.split("::")
            package = owner.split("/")[0] if len(parts) == 1 else parts[0]
            base = parts[-1].removesuffix("_")
            self.nested = STANDARD.get(base, f"{OURS}/msg/{base}") if package == OURS else f"{package}/msg/{base}"
        self.is_byte = (owner, name) in BYTES

    def description(self):
        number = NESTED if self.nested else BOUNDED_STRING if self.string_capacity else BASIC[self.inner][0]
        return {
            "name": self.name,
            "type": {
                "type_id": (BYTE if self.is_byte else number) + self.offset,
                "capacity": self.capacity,
                "string_capacity": self.string_capacity,
                "nested_type_name": self.nested,
            },
        }

    def in_msg(self):
        kind = self.nested.replace("/msg/", "/") if self.nested else BASIC[self.inner][1]
        if self.string_capacity:
            kind += f"<={self.string_capacity}"
        if self.offset:
            kind += {BOUNDED: f"[<={self.capacity}]", UNBOUNDED: "[]", ARRAY: f"[{self.capacity}]"}[self.offset]
        return f"{kind} {self.name}" + (f"  # {self.comment}" if self.comment else "")

    def in_idl(self):
        kind = "{}::msg::dds_::{}_".format(*self.nested.split("/msg/")) if self.nested else self.inner
        if self.string_capacity:
            kind = f"string<{self.string_capacity}>"
        if self.offset in (BOUNDED, UNBOUNDED):
            kind = f"sequence<{kind}, {self.capacity}>" if self.capacity else f"sequence<{kind}>"
        return f"{kind} {self.name}" + (f"[{self.capacity}]" if self.offset == ARRAY else "") + ";"


def read_types(text):
    """The structs of an IDL file: {"PACKAGE/msg/NAME": ([fields], comment)}. Unions and enums are not among them."""
    constants = dict(re.findall(r"const unsigned long (\w+) = (\d+);", text))
    types, package, comment = {}, "", []
    pattern = r"module (\w+)\s*\{|//([^\n]*)|@final struct (\w+)\s*\{(.*?)\};|@final union.*?\n\};|\n[ \t]*\n"
    for module, remark, name, body in re.findall(pattern, text, re.S):
        if module and module not in ("msg", "dds_"):
            package = OURS if module == "clearance" else module
        if remark:
            comment.append(remark.strip())
        elif name:
            full = f"{package}/msg/{name.removesuffix('_')}"
            types[full] = (read_fields(full, body, constants), comment)
            comment = []
        else:
            comment = []
    return types


def read_fields(owner, body, constants):
    fields = []
    for line in body.split("\n"):
        code, _, comment = line.partition("//")
        for kind, name, size in re.findall(r"\s*(?:@key\s+)?([\w:][\w: ]*(?:<[^;]*?>)?)\s+(\w+)(?:\[(\d+)\])?;", code):
            fields.append(Field(owner, kind, name, size, constants))
        if comment and fields and code.strip():
            fields[-1].comment = comment.strip()
    return fields


def contained(name, types, found):
    """The types that a type contains, at any depth, each behind those that it needs."""
    for field in types[name][0]:
        if field.nested and field.nested not in found:
            contained(field.nested, types, found)
            found.append(field.nested)
    return found


def type_hash(name, types):
    """REP-2011: the SHA-256 of the type's description as JSON, with the descriptions of all types that it contains."""

    def description(each):
        return {"type_name": each, "fields": [field.description() for field in types[each][0]]}

    referenced = [description(each) for each in sorted(contained(name, types, []))]
    text = json.dumps({"type_description": description(name), "referenced_type_descriptions": referenced})
    return hashlib.sha256(text.encode()).hexdigest()


def all_types(folder):
    """The types of all IDL files, with the lists for keyed topics."""
    types = {}
    for name in ("ros2", "moveit", "camera", "clearance"):
        types.update(read_types((folder / f"{name}.idl").read_text()))
    for message in TOPICS.values():
        if f"{OURS}/msg/{message}" not in types:
            single = message.removesuffix("s")
            zones = Field(f"{OURS}/msg/{message}", f"sequence<{single}, 256>", "zones", "", {})
            types[f"{OURS}/msg/{message}"] = ([zones], ["The state of every zone, in the order of the catalogue."])
    return types


def our_types(types):
    """The messages of topics and what they contain, each behind those that it needs."""
    found = []
    for message in TOPICS.values():
        name = f"{OURS}/msg/{message}"
        found += [each for each in contained(name, types, []) + [name] if each not in found]
    return [each for each in found if each.startswith(OURS)]


def files(types, version):
    ours = our_types(types)
    made = {}
    idl = ["// Made by idl/ros_messages.py from clearance.idl: the messages of clearance_msgs as ROS 2 has them in DDS.", '#include "ros2.idl"']
    idl.append(f"module {OURS} {{ module msg {{ module dds_ {{")
    hashes = [
        "// Made by idl/ros_messages.py: what readers and writers of clearance_msgs say in their USER_DATA.",
        "#pragma once",
        "",
        "namespace clearance::ros_hashes {",
    ]
    for name in ours:
        fields, comment = types[name]
        short = name.split("/")[-1]
        head = [f"# {line}" for line in ["Units: m, rad, s; stamps and ages: ns.", *comment]]
        made[f"{OURS}/msg/{short}.msg"] = head + [field.in_msg() for field in fields]
        idl += [f"@final struct {short}_ {{", *(f"  {field.in_idl()}" for field in fields), "};"]
        hashes.append(f'inline constexpr char k{short}[] = "typehash=RIHS01_{type_hash(name, types)};";')
    made["clearance_msgs.idl"] = [*idl, "}; }; };"]
    made["clearance_msgs_hashes.hpp"] = [*hashes, "}  // namespace clearance::ros_hashes"]
    made[f"{OURS}/package.xml"] = [
        '<?xml version="1.0"?>',
        '<package format="3">',
        f"  <name>{OURS}</name>",
        f"  <version>{version}</version>",
        "  <description>The reports of the distance monitor clearanced as messages of ROS 2</description>",
        '  <maintainer email="unknown@example.org">Clearance</maintainer>',
        "  <license>no licence chosen</license>",
        "  <buildtool_depend>ament_cmake</buildtool_depend>",
        "  <buildtool_depend>rosidl_default_generators</buildtool_depend>",
        "  <depend>geometry_msgs</depend>",
        "  <exec_depend>rosidl_default_runtime</exec_depend>",
        "  <member_of_group>rosidl_interface_packages</member_of_group>",
        "  <export><build_type>ament_cmake</build_type></export>",
        "</package>",
    ]
    made[f"{OURS}/CMakeLists.txt"] = [
        "cmake_minimum_required(VERSION 3.16)",
        f"project({OURS})",
        "find_package(ament_cmake REQUIRED)",
        "find_package(geometry_msgs REQUIRED)",
        "find_package(rosidl_default_generators REQUIRED)",
        "rosidl_generate_interfaces(${PROJECT_NAME}",
        *(f"  msg/{name.split('/')[-1]}.msg" for name in ours),
        "  DEPENDENCIES geometry_msgs)",
        "ament_export_dependencies(rosidl_default_runtime)",
        "ament_package()",
    ]
    return made


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("folder", type=pathlib.Path)
    arguments.add_argument("--version", default="0.2.0")
    given = arguments.parse_args()
    for name, lines in files(all_types(pathlib.Path(__file__).resolve().parent), given.version).items():
        path, text = given.folder / name, "\n".join(lines) + "\n"
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text() != text:  # else what depends on it is built again
            path.write_text(text)


if __name__ == "__main__":
    sys.exit(main())

"""The packages of tools/ros2: complete, and their launch file makes command lines that clearanced takes.

usage: ros_packages_test.py BUILD
"""

import importlib.util
import pathlib
import re
import subprocess
import sys
import tempfile
import types
import unittest
import xml.etree.ElementTree as xml

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
OURS = ROOT / "tools/ros2/clearance_ros"
MESSAGES = BUILD / "idl/clearance_msgs"


class Named:
    """Any class of launch: it keeps what it was given."""

    def __init__(self, *args, **kwargs):
        self.args, self.kwargs = args, kwargs


def launch_file():
    for module, names in {
        "launch": ["LaunchDescription"],
        "launch.actions": ["DeclareLaunchArgument", "ExecuteProcess", "OpaqueFunction"],
        "launch.conditions": ["IfCondition"],
        "launch.substitutions": ["LaunchConfiguration"],
        "launch_ros": [],
        "launch_ros.actions": ["Node"],
    }.items():
        sys.modules[module] = types.ModuleType(module)
        for name in names:
            setattr(sys.modules[module], name, type(name, (Named,), {}))
    spec = importlib.util.spec_from_file_location("launched", OURS / "launch/clearance.launch.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def defaults(module):
    return {name: default for name, default, _ in module.ARGUMENTS}


class RosPackages(unittest.TestCase):
    def check(self, given):
        line = launch_file().command_line({**defaults(launch_file()), **given})
        return subprocess.run([BUILD / "bin" / line[0], *line[1:], "--check"], capture_output=True, text=True, timeout=120)

    def test_the_launch_file_makes_command_lines_that_the_daemon_takes(self):
        with tempfile.TemporaryDirectory() as folder:
            given = {"cell": str(ROOT / "config/cells/mcintyre.yaml"), "domain": "7", "priority": "80"}
            done = self.check({**given, "outputs": "messages,markers", "record": f"{folder}/run.mcap"})
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_wrong_argument_is_refused_by_the_daemon(self):
        done = self.check({"cell": str(ROOT / "config/cells/mcintyre.yaml"), "outputs": "marker"})
        self.assertNotEqual(done.returncode, 0)

    def test_the_robot_description_takes_the_place_of_a_cell(self):
        module = launch_file()
        line = module.command_line({**defaults(module), "srdf": "r.srdf"})
        self.assertEqual(line[1:5], ["--robot-description", "/robot_description", "--srdf", "r.srdf"])
        options = subprocess.run([BUILD / "bin/clearanced", "--help"], capture_output=True, text=True, check=True).stdout
        for option in (each for each in line if each.startswith("--")):
            self.assertIn(option, options)

    def test_the_files_that_the_launch_file_names_exist(self):
        nodes = [each for each in launch_file().generate_launch_description().args[0] if type(each).__name__ == "Node"]
        files = [path for node in nodes for path in node.kwargs.get("arguments", []) + node.kwargs.get("parameters", []) if "/" in path]
        self.assertEqual(len(files), 2)
        for path in files:
            self.assertTrue(pathlib.Path(path).is_file(), path)

    def test_each_package_has_the_name_of_its_folder_and_one_version(self):
        found = [xml.parse(folder / "package.xml").getroot() for folder in (OURS, MESSAGES)]
        self.assertEqual([each.find("name").text for each in found], ["clearance_ros", "clearance_msgs"])
        self.assertEqual(found[0].find("version").text, found[1].find("version").text)
        for folder in (OURS, MESSAGES):
            self.assertIn(f"project({folder.name}", (folder / "CMakeLists.txt").read_text())

    def test_every_message_is_listed_and_every_listed_message_exists(self):
        listed = re.findall(r"msg/\w+\.msg", (MESSAGES / "CMakeLists.txt").read_text())
        self.assertEqual(sorted(listed), sorted(f"msg/{path.name}" for path in (MESSAGES / "msg").iterdir()))
        self.assertGreater(len(listed), 20)


if __name__ == "__main__":
    unittest.main()

"""The packages of tools/ros2: complete, and their launch file makes command lines that clearanced takes.

usage: ros_packages_test.py BUILD
"""

import importlib.util
import json
import os
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
SOURCES = ROOT / "tools/ros2/clearance"
CONTROL = ROOT / "tools/ros2/clearance_control"
MOVEIT = ROOT / "tools/ros2/clearance_moveit"

# Packages of Debian that tools/setup installs, and the keys that rosdep has for them; None: it has none.
KEYS = {
    "cyclonedds-dev": "cyclonedds",
    "cyclonedds-tools": "cyclonedds",
    "libassimp-dev": "assimp",
    "libboost-dev": "libboost-dev",
    "libcli11-dev": "cli11",
    "libeigen3-dev": "eigen",
    "libfmt-dev": "fmt",
    "libgmp-dev": "libgmp",
    "libhwy-dev": None,
    "liblz4-dev": "liblz4-dev",
    "liblzma-dev": "liblzma-dev",
    "libmodbus-dev": "libmodbus-dev",
    "libmosquitto-dev": "mosquitto-dev",
    "libncurses-dev": "libncurses-dev",
    "libspdlog-dev": "spdlog",
    "libsqlite3-dev": "libsqlite3-dev",
    "libssl-dev": "libssl-dev",
    "libsystemd-dev": "libsystemd-dev",
    "libtinyxml2-dev": "tinyxml2",
    "libyaml-cpp-dev": "yaml-cpp",
    "libzstd-dev": "libzstd-dev",
    "nlohmann-json3-dev": "nlohmann-json-dev",
    "prometheus-cpp-dev": None,
    "python3": "python3",
    "zlib1g-dev": "zlib",
}
OF_COLCON = {"g++", "ninja-build"}  # or of another compiler and build program

# The keywords that Jazzy's classes of launch and launch_ros take, as far as these launch files may need them.
OF_ACTION = {"condition"}
OF_PROCESS = OF_ACTION | {"cmd", "name", "cwd", "env", "additional_env", "shell", "output", "log_cmd", "on_exit", "respawn", "respawn_delay", "sigterm_timeout"}
KEYWORDS = {
    "LaunchDescription": set(),
    "DeclareLaunchArgument": OF_ACTION | {"default_value", "description", "choices"},
    "ExecuteProcess": OF_PROCESS,
    "GroupAction": OF_ACTION | {"scoped", "forwarding", "launch_configurations"},
    "IncludeLaunchDescription": OF_ACTION | {"launch_arguments"},
    "OpaqueFunction": OF_ACTION | {"function", "args", "kwargs"},
    "Shutdown": OF_ACTION | {"reason"},
    "PythonLaunchDescriptionSource": set(),
    "LaunchConfiguration": {"default"},
    "Node": (OF_PROCESS - {"cmd"}) | {"package", "executable", "namespace", "exec_name", "parameters", "remappings", "ros_arguments", "arguments"},
}


class Named:
    """Any class of launch: it keeps what it was given, and refuses keywords that the class does not have."""

    def __init__(self, *args, **kwargs):
        unknown = set(kwargs) - KEYWORDS[type(self).__name__]
        if unknown:
            raise TypeError(f"{type(self).__name__} has no {', '.join(sorted(unknown))}")
        self.args, self.kwargs = args, kwargs


GIVEN = {}  # LaunchConfiguration(...).perform(): arguments by name
MISSING = {"rviz2"}  # packages that this ROS 2 does not have


def prefix(package):
    """get_package_prefix()"""
    if package in MISSING:
        raise LookupError(package)


def launch_file(name="clearance"):
    for module, names in {
        "ament_index_python": [],
        "ament_index_python.packages": [],
        "launch": ["LaunchDescription"],
        "launch.actions": ["DeclareLaunchArgument", "ExecuteProcess", "GroupAction", "IncludeLaunchDescription", "OpaqueFunction", "Shutdown"],
        "launch.launch_description_sources": ["PythonLaunchDescriptionSource"],
        "launch.substitutions": ["LaunchConfiguration"],
        "launch_ros": [],
        "launch_ros.actions": ["Node"],
    }.items():
        sys.modules[module] = types.ModuleType(module)
        for each in names:
            setattr(sys.modules[module], each, type(each, (Named,), {}))
    sys.modules["ament_index_python.packages"].get_package_prefix = prefix
    sys.modules["launch.substitutions"].LaunchConfiguration.perform = lambda self, context: GIVEN[self.args[0]]
    spec = importlib.util.spec_from_file_location("launched", OURS / f"launch/{name}.launch.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def named_topics():
    """The type of each topic, as the pages of idl/ have it, and of the markers that show the scene."""
    rows = "".join((ROOT / "idl" / page).read_text() for page in ("README.md", "ROS.md"))
    topics = {name: f"clearance_msgs/msg/{kind}" for name, kind in re.findall(r"^\| `(clearance/\w+)` \| `(\w+)`", rows, re.MULTILINE)}
    topics.update({name: kind.replace("/", "/msg/") for name, kind in re.findall(r"^\| `rt(/[\w/]+)` \| `(\w+/\w+)`", rows, re.MULTILINE)})
    alike = re.search(r"^\| (`rt/clearance/distances`.*?) \| `clearance_msgs/Distances`, \.\.\. \| as the daemon's own topics", rows, re.MULTILINE)
    names = {name.rpartition("/")[2] for name in re.findall(r"`(.+?)`", alike[1])} - {"zones"}  # one message with all zones
    topics.update({f"/clearance/{name}": topics[f"clearance/{name}"] for name in names})
    header = (ROOT / "monitor/visual/cell_markers.hpp").read_text()
    topics.update({name: "visualization_msgs/msg/MarkerArray" for name in re.findall(r'k(?:Bodies|Closest)Topic = "(.+)"', header)})
    return topics


def message_types():
    """The fields of each message of idl/ by name: {"clearance_msgs/msg/Distances": {"minimum": Field}}."""
    spec = importlib.util.spec_from_file_location("ros_messages", ROOT / "idl/ros_messages.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    text = "".join((ROOT / "idl" / name).read_text() for name in ("ros2.idl", "clearance.idl"))
    return {name: {field.name: field for field in fields} for name, (fields, _) in module.read_types(text).items()}


def saved_layout():
    return json.loads((OURS / "foxglove/clearance.json").read_text())


def is_number(topic, fields, topics, types):
    """Whether this path through the message of the topic ends at a number. Without fields: whether the topic exists."""
    if topic not in topics:
        return False
    kind = topics[topic]
    for place, name in enumerate(fields):
        field = types.get(kind, {}).get(re.sub(r"\[[\d:]*\]$", "", name))
        if field is None or ("[" in name) != bool(field.offset):
            return False
        if place == len(fields) - 1:
            return not field.nested and field.inner != "string"
        kind = field.nested
    return True


def foxglove_paths(layout):
    """Each topic with fields that the panels of a layout name: "clearance/distances.minimum.lower"."""
    for panel in layout["configById"].values():
        for topic in [*panel.get("topics", {}), *filter(None, [panel.get("topicToRender")])]:
            yield topic, []
        for path in panel.get("paths", []):
            topic, *fields = path["value"].split(".")
            yield topic, fields


def plotjuggler_paths(topics):
    """The same of each curve of PlotJuggler's layout, which separates topic and fields by the same sign."""
    for curve in xml.parse(OURS / "plotjuggler/clearance.xml").getroot().iter("curve"):
        name = curve.get("name")
        topic = max((each for each in topics if name.startswith(f"{each}/")), key=len, default=name)
        yield topic, name[len(topic) + 1 :].split("/")


RVIZ = {"RobotModel": "std_msgs/msg/String", "MarkerArray": "visualization_msgs/msg/MarkerArray"}  # what displays read


def rviz_topics():
    """(topic, type, durability) of each display of rviz's layout that reads one."""
    text = (OURS / "rviz/clearance.rviz").read_text()
    for display in re.split(r"(?m)^    - Class: rviz_default_plugins/", text)[1:]:
        kind = display.split("\n", 1)[0]
        for topic in re.findall(r"(?m)^        Value: (\S+)\n(?:        .*\n)*?        Durability Policy: (.+)$", display):
            yield topic[0], RVIZ[kind], topic[1]


def placed_panels(place, panels):
    """The panels that a part of a layout shows, with those of the tabs in it."""
    if isinstance(place, dict):
        return [each for half in ("first", "second") for each in placed_panels(place[half], panels)]
    return [place, *(each for tab in panels[place].get("tabs", []) for each in placed_panels(tab["layout"], panels))]


# Prints the fields of each message as Debian's rosidl reads them.
ROSIDL = """import json, pathlib, sys; from rosidl_adapter.parser import parse_message_file as read
print(json.dumps({path.stem: [[str(each.type), each.name] for each in read("clearance_msgs", str(path)).fields] for path in pathlib.Path(sys.argv[1]).iterdir()}))"""
WORDS = {"double": "float64", "long": "int32", "unsigned long": "uint32", "long long": "int64", "unsigned long long": "uint64", "octet": "uint8", "boolean": "bool"}


def as_message(kind, size):
    """A type of the IDL in the words of a .msg file."""
    inner, bound = re.fullmatch(r"(?:sequence<)?(.+?)(?:(?:, (\d+))?>)?", kind).groups()
    return WORDS.get(inner, inner.replace("::msg::dds_::", "/").replace("string<", "string<=").removesuffix("_")) + (f"[<={bound}]" if bound else "[]" if kind.startswith("sequence") else f"[{size}]" if size else "")


def started(**given):
    """What the launch file starts for these arguments."""
    module = launch_file()
    GIVEN.clear()
    GIVEN.update({name: default for name, default, _ in module.ARGUMENTS}, **given)
    return module.start(None)


def command_line(**given):
    return started(**given)[-1].kwargs["cmd"]


class RosPackages(unittest.TestCase):
    def check(self, **given):
        line = command_line(cell=str(ROOT / "config/cells/mcintyre.yaml"), **given)
        return subprocess.run([BUILD / "bin" / line[0], *line[1:], "--check"], capture_output=True, text=True, timeout=120)

    def test_the_launch_file_makes_command_lines_that_the_daemon_takes(self):
        with tempfile.TemporaryDirectory() as folder:
            network = {"interface": "lo", "domain": "7", "peer": "127.0.0.1,localhost"}
            clients = {"commands": "planner,operator", "questions": "planner"}
            rest = {"priority": "80", "partner": "left", "outputs": "messages,markers", "record": f"{folder}/run.mcap"}
            done = self.check(**network, **clients, **rest)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_wrong_argument_is_refused_by_the_daemon(self):
        for wrong in ({"outputs": "marker"}, {"partner": "left and right"}, {"domain": "300"}):
            self.assertNotEqual(self.check(**wrong).returncode, 0, wrong)

    def test_an_argument_with_several_names_repeats_its_option(self):
        line = command_line(cell="cell.yaml", peer="10.0.0.1,10.0.0.2", outputs="", interface="lo")
        self.assertEqual(line, ["clearanced", "cell.yaml", "--interface", "lo", "--peer", "10.0.0.1", "--peer", "10.0.0.2"])

    def test_the_robot_description_takes_the_place_of_a_cell(self):
        robot = {"srdf": "r.srdf", "package": "arm=/opt/arm,tool=/opt/tool", "joint_states": "/arm/joints", "stamps": "sent"}
        line = command_line(outputs="markers", **robot)
        self.assertEqual(line[1:9], ["--robot-description", "/robot_description", "--srdf", "r.srdf", "--package", "arm=/opt/arm", "--package", "tool=/opt/tool"])
        self.assertEqual(line[9:], ["--joint-states", "/arm/joints", "--stamps", "sent", "--interface", "ros", "--ros2", "markers"])
        options = subprocess.run([BUILD / "bin/clearanced", "--help"], capture_output=True, text=True, check=True).stdout
        for option in (each for each in line if each.startswith("--")):
            self.assertIn(f"  {option} TEXT", options)

    def test_simulated_time_is_asked_for_by_the_name_that_ros_has_for_it(self):
        self.assertNotIn("--use-sim-time", command_line(cell="cell.yaml"))
        self.assertEqual(command_line(cell="cell.yaml", use_sim_time="True")[-1], "--use-sim-time")
        self.assertEqual(self.check(use_sim_time="true").returncode, 0)

    def test_a_keyword_that_a_class_of_launch_does_not_have_is_refused(self):
        launch_file()
        actions = sys.modules["launch.actions"]
        for wrong in ({"on_exits": print}, {"respawn_dely": 1.0}):
            with self.assertRaisesRegex(TypeError, next(iter(wrong))):
                actions.ExecuteProcess(cmd=["clearanced"], **wrong)

    def test_a_launch_file_without_rviz2_starts_nothing(self):
        self.assertEqual(len(started(cell="cell.yaml")), 1)
        with self.assertRaises(LookupError):
            started(cell="cell.yaml", rviz="true")

    def test_the_files_that_the_launch_file_names_exist(self):
        MISSING.clear()
        self.addCleanup(MISSING.add, "rviz2")
        nodes = started(cell="cell.yaml", rviz="true", aggregator="true")[:-1]
        files = [path for node in nodes for path in node.kwargs.get("arguments", []) + node.kwargs.get("parameters", []) if "/" in path]
        self.assertEqual(len(files), 2)
        for path in files:
            self.assertTrue(pathlib.Path(path).is_file(), path)

    def test_the_saved_layout_names_topics_and_fields_that_messages_have(self):
        topics, types = named_topics(), message_types()
        foxglove = list(foxglove_paths(saved_layout()))
        standard = {"/clearance/minimum_distance", "/clearance/speed_scaling", "/clearance/markers", "/diagnostics"}
        self.assertLessEqual(standard, {topic for topic, _ in foxglove})
        for topic, fields in foxglove:
            self.assertTrue(is_number(topic, fields, topics, types), f"{topic} {fields}")

    def test_the_layout_of_plotjuggler_plots_numbers_that_messages_have(self):
        topics, types = named_topics(), message_types()
        curves = list(plotjuggler_paths(topics))
        self.assertLessEqual({"/clearance/minimum_distance", "/clearance/speed_scaling"}, {topic for topic, _ in curves})
        for topic, fields in curves:
            self.assertTrue(is_number(topic, fields, topics, types), f"{topic} {fields}")

    def test_the_layout_of_rviz_reads_topics_that_are_written_and_as_they_are(self):
        topics = {**named_topics(), "/robot_description": "std_msgs/msg/String"}
        read = list(rviz_topics())
        self.assertEqual({topic for topic, _, _ in read}, {"/robot_description", "/clearance/markers"})
        for topic, kind, durability in read:
            self.assertEqual(topics.get(topic), kind, topic)
            self.assertEqual(durability, "Transient Local" if topic == "/robot_description" else "Volatile", topic)
        default = re.search(r"`world_frame` \| \| `(\w+)`", (ROOT / "config/KEYS.md").read_text())
        self.assertIn(f"    Fixed Frame: {default[1]}\n", (OURS / "rviz/clearance.rviz").read_text())

    def test_the_saved_layout_plots_the_same_figures_of_ros_and_of_our_own_topics(self):
        figures = [(topic, fields) for topic, fields in foxglove_paths(saved_layout()) if fields and fields != ["data"]]
        own = sorted((f"/{topic}", fields) for topic, fields in figures if not topic.startswith("/"))
        self.assertGreater(len(own), 10)
        self.assertEqual(own, sorted((topic, fields) for topic, fields in figures if topic.startswith("/")))

    def test_the_saved_layout_shows_each_of_its_panels_once(self):
        layout = saved_layout()
        self.assertEqual(sorted(placed_panels(layout["layout"], layout["configById"])), sorted(layout["configById"]))

    def test_a_renamed_field_or_topic_of_a_layout_is_found(self):
        topics, types = named_topics(), message_types()
        self.assertTrue(is_number("clearance/health", ["sources[:]", "age_ns"], topics, types))
        for topic, fields in (
            ("clearance/healthy", ["sources[:]", "age_ns"]),
            ("clearance/health", ["sources", "age_ns"]),
            ("clearance/health", ["sources[:]", "age"]),
            ("clearance/health", ["sources[:]", "source"]),
            ("clearance/distances", ["minimum"]),
            ("/clearance/minimum_distance", ["datum"]),
            ("/clearance/healthy", ["tick_p50_us"]),
            ("/diagnostic", []),
        ):
            self.assertFalse(is_number(topic, fields, topics, types), f"{topic} {fields}")

    def after(self, status, **given):
        """What the launch file does once clearanced has ended with this status."""
        return started(cell="cell.yaml", **given)[-1].kwargs["on_exit"](types.SimpleNamespace(returncode=status), None)

    def test_the_launch_ends_with_the_daemon_and_tells_its_error(self):
        self.assertEqual([type(each).__name__ for each in self.after(0)], ["Shutdown"])
        for status in (1, 2, 3, 4, 5, -9):
            with self.assertRaisesRegex(RuntimeError, f"status {status};"):
                self.after(status)

    def test_a_partner_is_started_again_unless_it_would_end_alike(self):
        self.assertTrue(started(cell="cell.yaml", partner="left")[-1].kwargs["respawn"])
        for status in (0, 1, 4, 5, -9):
            self.assertIsNone(self.after(status, partner="left"))
        for status in (2, 3):
            with self.assertRaises(RuntimeError):
                self.after(status, partner="left")

    def test_partners_have_names_and_recordings_of_their_own_and_one_rviz2(self):
        one = launch_file()
        actions = launch_file("partners").generate_launch_description().args[0]
        declared = {each.args[0] for each in actions if type(each).__name__ == "DeclareLaunchArgument"}
        left, right = (dict(each.args[0][0].kwargs["launch_arguments"]) for each in actions if type(each).__name__ == "GroupAction")
        self.assertEqual((left["partner"], right["partner"]), ("left", "right"))
        self.assertEqual((left["record"].args, right["record"].args), (("record_left",), ("record_right",)))
        self.assertLessEqual({left["record"].args[0], right["record"].args[0]}, declared)
        self.assertEqual((right["rviz"], right["aggregator"]), ("false", "false"))
        self.assertNotIn("rviz", left)
        self.assertLessEqual({*left, *right}, {name for name, _, _ in one.ARGUMENTS})

    def test_each_package_has_the_name_of_its_folder_and_one_version(self):
        folders = (OURS, MESSAGES, SOURCES, CONTROL, MOVEIT)
        found = [xml.parse(folder / "package.xml").getroot() for folder in folders]
        self.assertEqual([each.find("name").text for each in found], [folder.name for folder in folders])
        self.assertEqual(len({each.find("version").text for each in found}), 1)
        self.assertIn("clearance", {each.text for each in found[0].iter("exec_depend")}, "the launch files start its daemon")
        for folder in folders:
            self.assertIn(f"project({folder.name}", (folder / "CMakeLists.txt").read_text())

    def test_the_package_of_the_sources_needs_what_setup_installs(self):
        needed = re.search(r"^packages=\((.*?)\)$", (ROOT / "tools/setup").read_text(), re.MULTILINE | re.DOTALL)
        keys = {KEYS[name] for name in set(needed[1].split()) - OF_COLCON - {"cmake"}}
        package = xml.parse(SOURCES / "package.xml").getroot()
        self.assertEqual({each.text for kind in ("build_depend", "depend") for each in package.iter(kind)}, keys - {None})
        told = (SOURCES / "package.xml").read_text()
        for name in (name for name, key in KEYS.items() if key is None):
            self.assertIn(name, told)

    def test_the_package_of_the_sources_is_a_project_that_builds_them(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(["cmake", "-S", SOURCES, "-B", folder, "-DCLEARANCE_PYTHON=OFF"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            targets = subprocess.run(["cmake", "--build", folder, "--target", "help"], capture_output=True, text=True, check=True).stdout
        for target in ("clearanced", "clearance-replay", "clearance_client"):
            self.assertRegex(targets, rf"(?m)\b{target}$")
        self.assertNotIn("core_tests", targets)

    def test_the_live_tests_are_not_run_without_a_ros_2(self):
        bare = {name: text for name, text in os.environ.items() if name != "AMENT_PREFIX_PATH"}
        done = subprocess.run([ROOT / "tools/check", "--ros2"], env=bare, capture_output=True, text=True, timeout=60)
        self.assertEqual((done.returncode, done.stdout), (0, "check: no ROS 2 here\n"))

    def test_every_message_is_listed_and_every_listed_message_exists(self):
        listed = re.findall(r"msg/\w+\.msg", (MESSAGES / "CMakeLists.txt").read_text())
        self.assertEqual(sorted(listed), sorted(f"msg/{path.name}" for path in (MESSAGES / "msg").iterdir()))
        self.assertGreater(len(listed), 20)

    @unittest.skipUnless(pathlib.Path("/usr/lib/python3/dist-packages/rosidl_adapter").is_dir(), "python3-rosidl is missing: tools/setup --tests")
    def test_rosidl_of_debian_reads_the_fields_that_dds_carries(self):
        read = subprocess.run(["/usr/bin/python3", "-c", ROSIDL, MESSAGES / "msg"], capture_output=True, text=True, check=True).stdout
        structs = re.findall(r"struct (\w+)_ {(.*?)\n};", (BUILD / "idl/clearance_msgs.idl").read_text(), re.DOTALL)
        fields = {name: [[as_message(kind, size), each] for kind, each, size in re.findall(r"  (.+) (\w+?)(?:\[(\d+)\])?;", body)] for name, body in structs}
        self.assertEqual(json.loads(read), fields)


if __name__ == "__main__":
    unittest.main()

"""Starts clearanced, and on request rviz2 and the diagnostics aggregator.

ros2 launch clearance_ros clearance.launch.py cell:=cell.yaml
ros2 launch clearance_ros clearance.launch.py robot_description:=/robot_description rviz:=true

When clearanced ends by itself, the launch ends: with an error if its exit status is not 0. A partner is started again,
unless its arguments or its cell are wrong.
"""

import os

from ament_index_python.packages import get_package_prefix
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction, Shutdown
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")

# name, default, what it means
ARGUMENTS = [
    ("cell", "", "A cell file; without it, all pairs of the links of robot_description are watched"),
    ("robot_description", "/robot_description", "The topic of the URDF, where no cell is given"),
    ("srdf", "", "An SRDF with the pairs that are left out, where no cell is given"),
    ("package", "", "Folders of the URDF's packages, where no cell is given: NAME=FOLDER,NAME=FOLDER"),
    ("joint_states", "", "The topic of the joints, where no cell is given; empty: each topic joint_states"),
    ("stamps", "", "The time of a joint state that counts, where no cell is given: message or sent"),
    ("use_sim_time", "false", "Whether the time is that of a simulation, by /clock"),
    ("outputs", "all", "What is written for ROS 2, by the keys of `ros2:`, with commas between them"),
    ("interface", "ros", "The network: ros is that of ROS 2's variables; default, lo, or a card"),
    ("peer", "", "Addresses of other machines, with commas between them"),
    ("domain", "", "The DDS domain; empty: the cell's, or else that of ROS_DOMAIN_ID, or 0"),
    ("commands", "", "Clients that may change the scene, with commas between them"),
    ("questions", "", "Clients that may ask about motions, with commas between them"),
    ("partner", "", "The name of this daemon among partners of one cell; empty: it has none"),
    ("priority", "", "Real-time priority, 1 to 99; empty: none"),
    ("record", "", "An MCAP file to record to; empty: none"),
    ("rviz", "false", "Whether rviz2 is started"),
    ("aggregator", "false", "Whether the diagnostics aggregator is started"),
]

# Arguments that name several things: the option of clearanced is repeated for each.
LISTS = ("package", "peer", "commands", "questions", "outputs")
OPTIONS = ("interface", "peer", "domain", "commands", "questions", "partner", "priority", "record", "outputs")
OPTIONS_OF_ROBOT = ("srdf", "package", "joint_states", "stamps")
WRONG_ARGUMENTS, WRONG_CELL = 2, 3  # of clearanced's exit statuses: the next start ends alike


def is_true(value):
    return value.lower() in ("true", "1")


def command_line(given):
    """The command line of clearanced for arguments by name."""
    if given["cell"]:
        line, names = ["clearanced", given["cell"]], OPTIONS
    else:
        line, names = ["clearanced", "--robot-description", given["robot_description"]], OPTIONS_OF_ROBOT + OPTIONS
    for name in names:
        option = "--ros2" if name == "outputs" else "--" + name.replace("_", "-")
        for value in filter(None, given[name].split(",") if name in LISTS else [given[name]]):
            line += [option, value]
    return line + ["--use-sim-time"] * is_true(given["use_sim_time"])


def optional_nodes(given):
    """rviz2 and the aggregator as they are asked for. Raises before anything runs if one is not installed."""
    rviz = os.path.join(FOLDER, "rviz", "clearance.rviz")
    groups = os.path.join(FOLDER, "config", "diagnostics.yaml")
    nodes = []
    for name, package, executable, more in [
        ("rviz", "rviz2", "rviz2", {"arguments": ["-d", rviz]}),
        ("aggregator", "diagnostic_aggregator", "aggregator_node", {"parameters": [groups]}),
    ]:
        if is_true(given[name]):
            get_package_prefix(package)
            nodes.append(Node(package=package, executable=executable, **more))
    return nodes


def fail(event):
    raise RuntimeError(f"clearanced ended with status {event.returncode}; its last lines say why")


def daemon_ended(event, _):
    """Ends the launch, which has status 1 after an error and 0 otherwise."""
    if event.returncode != 0:
        fail(event)
    return [Shutdown(reason="clearanced has ended")]


def partner_ended(event, _):
    """Ends the launch only where the next start would end alike."""
    if event.returncode in (WRONG_ARGUMENTS, WRONG_CELL):
        fail(event)


def start(context):
    given = {name: LaunchConfiguration(name).perform(context) for name, _, _ in ARGUMENTS}
    after = {"on_exit": daemon_ended}
    if given["partner"]:
        after = {"on_exit": partner_ended, "respawn": True, "respawn_delay": 1.0}
    daemon = ExecuteProcess(cmd=command_line(given), name="clearanced", output="screen", **after)
    return [*optional_nodes(given), daemon]


def generate_launch_description():
    return LaunchDescription(
        [DeclareLaunchArgument(name, default_value=default, description=text) for name, default, text in ARGUMENTS]
        + [OpaqueFunction(function=start)]
    )

"""Starts clearanced, and on request rviz2 and the diagnostics aggregator.

ros2 launch clearance_ros clearance.launch.py cell:=cell.yaml
ros2 launch clearance_ros clearance.launch.py robot_description:=/robot_description rviz:=true
"""

import os

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")

# name, default, what it means
ARGUMENTS = [
    ("cell", "", "A cell file; without it, all pairs of the links of robot_description are watched"),
    ("robot_description", "/robot_description", "The topic of the URDF, where no cell is given"),
    ("srdf", "", "An SRDF with the pairs that are left out, where no cell is given"),
    ("outputs", "all", "What is written for ROS 2, by the keys of `ros2:`, with commas between them"),
    ("interface", "ros", "The network: ros is that of ROS 2's variables; default, lo, or a card"),
    ("domain", "", "The DDS domain; empty: the cell's, or else that of ROS_DOMAIN_ID, or 0"),
    ("priority", "", "Real-time priority, 1 to 99; empty: none"),
    ("record", "", "An MCAP file to record to; empty: none"),
    ("rviz", "false", "Whether rviz2 is started"),
    ("aggregator", "false", "Whether the diagnostics aggregator is started"),
]


def command_line(given):
    """The command line of clearanced for arguments by name."""
    line = ["clearanced"]
    if given["cell"]:
        line.append(given["cell"])
    else:
        line += ["--robot-description", given["robot_description"]]
        if given["srdf"]:
            line += ["--srdf", given["srdf"]]
    for name in ("interface", "domain", "priority", "record"):
        if given[name]:
            line += [f"--{name}", given[name]]
    for output in filter(None, given["outputs"].split(",")):
        line += ["--ros2", output]
    return line


def start(context):
    given = {name: LaunchConfiguration(name).perform(context) for name, _, _ in ARGUMENTS}
    return [ExecuteProcess(cmd=command_line(given), name="clearanced", output="screen")]


def generate_launch_description():
    return LaunchDescription(
        [DeclareLaunchArgument(name, default_value=default, description=text) for name, default, text in ARGUMENTS]
        + [
            OpaqueFunction(function=start),
            Node(
                package="rviz2",
                executable="rviz2",
                arguments=["-d", os.path.join(FOLDER, "rviz", "clearance.rviz")],
                condition=IfCondition(LaunchConfiguration("rviz")),
            ),
            Node(
                package="diagnostic_aggregator",
                executable="aggregator_node",
                parameters=[os.path.join(FOLDER, "config", "diagnostics.yaml")],
                condition=IfCondition(LaunchConfiguration("aggregator")),
            ),
        ]
    )

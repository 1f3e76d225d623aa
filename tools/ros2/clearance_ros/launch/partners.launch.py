"""Starts two daemons of one cell side by side, left and right, and starts each again when it ends.

ros2 launch clearance_ros partners.launch.py cell:=cell.yaml

Both take the arguments of clearance.launch.py; rviz2 and the aggregator are started once, and each daemon records to a
file of its own, by record_left and record_right. Two machines need none of this: start clearance.launch.py with another
partner:=NAME on each.
"""

import os

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration

ONE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "clearance.launch.py")
ARGUMENTS = [("record_left", "An MCAP file of the first daemon; empty: none"), ("record_right", "The same of the second")]


def daemon(name, **more):
    """clearance.launch.py with a partner's name. What it sets stays in its group."""
    given = {"partner": name, "record": LaunchConfiguration(f"record_{name}"), **more}
    one = PythonLaunchDescriptionSource(ONE)
    return GroupAction([IncludeLaunchDescription(one, launch_arguments=given.items())])


def generate_launch_description():
    cell = DeclareLaunchArgument("cell", description="The cell file of both")
    records = [DeclareLaunchArgument(name, default_value="", description=text) for name, text in ARGUMENTS]
    return LaunchDescription([cell, *records, daemon("left"), daemon("right", rviz="false", aggregator="false")])

"""What the tests of the Python package share: places, a daemon on loopback, robots with closed forms."""

import os
import pathlib
import subprocess
import uuid

import pytest

import clearance

# Tests state their domains, and programs that state none join domain 0.
for name in ("ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE", "ROS_LOCALHOST_ONLY", "ROS_STATIC_PEERS", "ROS_DISTRO"):
    os.environ.pop(name, None)
SOURCE = pathlib.Path(__file__).resolve().parents[2]
# Each daemon has a partition alone; the network is loopback. Domains below 100 avoid the ports that the
# kernel assigns.
DOMAIN = 1 + os.getpid() % 99

# Two links of length 1 m that turn about z in a plane; spheres of 0.1 m at the elbow and at the tip.
PLANAR_ARM = """<robot name="planar">
  <link name="base"/>
  <link name="upper">
    <collision><origin xyz="1 0 0"/><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <link name="lower">
    <collision><origin xyz="1 0 0"/><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="10" effort="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
    <origin xyz="1 0 0"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="10" effort="1"/></joint>
</robot>
"""

# The arm, a ball that is sent as poses, and a wall at x = 3 m.
PLANAR_CELL = """name: planar
units: {length: m, angle: rad}
rate_hz: 200
defaults: {age_limit_ms: 10000}
commands: {from: [python tests]}
robots:
  - {name: arm, urdf: planar.urdf}
objects:
  - {name: wall, fixed: true, box: {size: [0.2, 4, 4]}, pose: {xyz: [3.1, 0, 0]}}
  - {name: ball, sphere: {radius: 0.25}, max_speed: 100}
pairs:
  - {between: [arm, wall], publish: true}
  - {between: [lower, ball], publish: true}
  - {between: [ball, wall], publish: true}
zones:
  - {name: stop, between: [lower, wall], enter_below: 0.2, leave_above: 0.25}
"""


@pytest.fixture
def planar_file(tmp_path):
    (tmp_path / "planar.urdf").write_text(PLANAR_ARM)
    file = tmp_path / "planar.yaml"
    file.write_text(PLANAR_CELL)
    return file


@pytest.fixture
def planar(planar_file):
    return clearance.Cell(planar_file)


@pytest.fixture(scope="session")
def arm_files():
    folder = SOURCE / "config/cells/seven_joint_arm"
    return folder / "arm.urdf", folder / "arm.srdf"


@pytest.fixture(scope="session")
def arm(arm_files):
    return clearance.Cell.from_urdf(*arm_files)


class Daemon:
    def __init__(self, arguments, partition=None):
        self.partition = partition or "python-" + uuid.uuid4().hex[:12]
        program = os.path.join(os.environ["CLEARANCE_BIN"], "clearanced")
        network = ["--domain", str(DOMAIN), "--partition", self.partition]
        self.process = subprocess.Popen(
            [program, *map(str, arguments), *network],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def connection(self, **more):
        return clearance.Connection(domain=DOMAIN, partition=self.partition, **more)

    def kill(self):
        self.process.kill()
        self.process.wait(20)

    def end(self):
        self.process.terminate()
        self.process.wait(20)


@pytest.fixture
def run_daemon():
    running = []

    def run(*arguments, partition=None):
        running.append(Daemon(arguments, partition))
        return running[-1]

    yield run
    for daemon in running:
        daemon.end()

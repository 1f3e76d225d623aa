"""A hall with a daemon, and clearance-plc with Debian's pymodbus as its controller, for plc_test.py and mqtt_test.py."""

import os
import pathlib
import re
import subprocess
import sys
import time
import uuid

import clearance
from conftest import DOMAIN, SOURCE

sys.path.insert(0, str(SOURCE / "tools/plc"))
from controller import Controller, layout_of, rows_of  # noqa: E402: the one of tools/demo --plc

LIMIT_S = 60.0  # only a broken program takes longer
BIN = pathlib.Path(os.environ["CLEARANCE_BIN"])
# A period that a busy machine keeps; the tests do not depend on it.
HALL = """name: hall
units: {length: m, angle: deg}
rate_hz: 200
defaults: {age_limit_ms: 100000}
objects:
  - {name: person, sphere: {radius: 0.2}}
  - {name: robot, sphere: {radius: 0.1}}
pairs: [{between: [person, robot]}]
zones:
  - name: people
    between: [person, robot]
    enter_below: 0.3
    leave_above: 0.32
    separation: {human: person, human_speed: 1.6, robot_speed: 1, reaction_time_ms: 100, stopping_time_ms: 250,
                 stopping_distance: 0.125, intrusion_distance: 0.1}
"""
PERIOD = "plc: {period_ms: 200}\n"


def eventually(value_of):
    """The first value that is not false."""
    end = time.monotonic() + LIMIT_S
    while time.monotonic() < end:
        value = value_of()
        if value:
            return value
        time.sleep(0.005)
    raise AssertionError(f"not within {LIMIT_S} s: {value}")


class Hall:
    """A person at the origin and a robot on the x axis."""

    def __init__(self, folder, cell):
        self.folder, self.cell = folder, folder / "hall.yaml"
        self.cell.write_text(cell + PERIOD)
        self.network = ["--domain", str(DOMAIN), "--partition", "plc-" + uuid.uuid4().hex[:12]]

    def __enter__(self):
        self.connection = clearance.Connection(domain=DOMAIN, partition=self.network[-1])
        self.poses = clearance.PoseWriter("spheres", ["person", "robot"], self.connection)
        self.start_daemon()
        return self

    def __exit__(self, *_):
        self.poses.close()
        self.daemon.kill()
        self.daemon.wait()

    def start_daemon(self):
        self.daemon = subprocess.Popen([BIN / "clearanced", self.cell, *self.network],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        assert self.poses.wait_heard(LIMIT_S)

    def kill_daemon(self):
        self.daemon.kill()
        self.daemon.wait()

    def place(self, x):
        """Both stand still, with their centres x metres apart."""
        self.x = x
        self.send()

    def send(self):
        """Says it again: a daemon that was started may have missed it."""
        self.poses.write([[0, 0, 0, 0, 0, 0, 1], [self.x, 0, 0, 0, 0, 0, 1]], [[0] * 6] * 2)


class Plc:
    """clearance-plc on a free port, and a controller that reads all its registers at once."""

    def __init__(self, hall, cell=None, network=None):
        self.hall = hall
        self.command = [BIN / "clearance-plc", cell or hall.cell, *(network or hall.network)]
        self.log = hall.folder / (uuid.uuid4().hex + ".log")

    def __enter__(self):
        self.description = subprocess.run([*self.command, "--describe"], check=True, capture_output=True, text=True).stdout
        self.layout, self.rows = layout_of(self.description), rows_of(self.description)
        with self.log.open("w") as log:
            self.process = subprocess.Popen([*self.command, "--port", "0"], stdout=subprocess.PIPE, stderr=log, text=True)
        port = eventually(lambda: re.search(r"registers at 127.0.0.1:(\d+)", self.log.read_text()))[1]
        self.address = ("127.0.0.1", int(port))
        self.controller = Controller(self.address[1], self.rows, LIMIT_S)
        self.client, self.read = self.controller.client, self.controller.read
        return self

    def __exit__(self, *_):
        self.client.close()
        self.end()

    def eventually(self, is_so):
        def row():
            self.hall.send()
            found = self.read()
            return found if is_so(found) else None

        return eventually(row)

    def expect_fail_safe(self, seen):
        """All figures are at their safe ends now, and those of the first block were when `good` was seen to be 0."""
        now = self.read()
        for name, row in self.rows.items():
            if row.address >= 10:
                assert now[name] == row.safe_end, name
            if 10 <= row.address < 100:
                assert seen[name] == row.safe_end, name
        assert now["good"] == seen["good"] == 0 and now["cause"] != 0

    def told(self, code):
        eventually(lambda: f"[{code}]" in self.log.read_text())
        return True

    def end(self):
        """The last lines that it prints."""
        if self.process.poll() is None:
            self.process.terminate()
        if not self.process.stdout.closed:
            self.said = self.process.communicate(timeout=LIMIT_S)[0]
        assert self.process.returncode == 0
        return self.said

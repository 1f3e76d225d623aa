"""A program of its own that sends a source's true values, or lies as standard input tells it to: sender.py SPEC SOURCE NAME DOMAIN PARTITION."""
import json, select, sys, time

import clearance
from cells import Motion

PERIOD_NS = 5_000_000
BEHIND_NS = 500_000_000
AHEAD_NS = 2_000_000_000
LIES = ("true", "frozen", "leaping", "elsewhere", "future", "behind")


def told(lie, now, since, count):
    """The time whose values are sent, that of the rates, the stamp, and whether they are moved elsewhere."""
    if lie == "frozen":
        return since, now, now, False
    if lie == "future":
        return now, now, now + AHEAD_NS, False
    if lie == "behind":
        return now - BEHIND_NS, now - BEHIND_NS, now - BEHIND_NS, False
    return now, now, now, lie == "elsewhere" or (lie == "leaping" and count % 20 == 0)


class Joints:
    def __init__(self, motion, source, name, connection):
        self.motion, self.robot = motion, source
        # Leaps towards the middle of the range, farther than the joint gets in three age limits: no program tells shorter ones
        # from motion.
        robot = motion.spec["robots"][source]
        leaps = [max(0.01 if slides else 0.5, 3e-3 * motion.spec["age_limit_ms"] * speed)
                 for slides, speed in zip(robot["slides"], robot["speeds"])]
        self.leaps = [(leap, centre) for leap, (centre, _) in zip(leaps, robot["waves"])]
        self.writer = clearance.JointWriter(name, motion.spec["robots"][source]["joints"], connection)

    def send(self, at, rates_at, stamp, is_elsewhere):
        values, rates = self.motion.joints(self.robot, at)[0], self.motion.joints(self.robot, rates_at)[1]
        if is_elsewhere:
            values = [value + (leap if value < centre else -leap) for value, (leap, centre) in zip(values, self.leaps)]
        self.writer.write(values, rates, stamp)


class Poses:
    def __init__(self, motion, _, name, connection):
        self.motion, self.objects = motion, list(motion.spec["objects"])
        self.writer = clearance.PoseWriter(name, self.objects, connection)

    def send(self, at, rates_at, stamp, is_elsewhere):
        poses = [self.motion.pose(one, at)[0] for one in self.objects]
        if is_elsewhere:
            poses = [[pose[0] + 1.0, *pose[1:]] for pose in poses]
        self.writer.write(poses, [self.motion.pose(one, rates_at)[1] for one in self.objects], stamp)


def main():
    spec, source, name, domain, partition = sys.argv[1:]
    motion = Motion(json.load(open(spec)))
    connection = clearance.Connection(domain=int(domain), partition=partition, interface="lo")
    sending = (Poses if source == "tracker" else Joints)(motion, source, name, connection)
    lie, since, count, due = "true", 0, 0, time.monotonic_ns()
    while True:
        if select.select([sys.stdin], [], [], max(0, due - time.monotonic_ns()) * 1e-9)[0]:
            line = sys.stdin.readline().strip()
            if line not in LIES:
                return  # the end of the input, too
            lie, since = line, time.time_ns()
            continue
        count += 1
        sending.send(*told(lie, time.time_ns(), since, count))
        due = max(due + PERIOD_NS, time.monotonic_ns() - PERIOD_NS)


main()

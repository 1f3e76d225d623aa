"""Judges reports from outside: every bound against distances that are computed anew from the true motion, and the faults and leaks of a run."""
import collections, itertools, math

import numpy as np

ROUNDING = 1e-9  # m
SPREAD_SPEED = 20.0  # m/s, faster than any point of these robots: links may rest on positions of different ages
STALE, UNKNOWN = 5, 6
MOST_DESCRIPTORS, MOST_MB = 4, 32.0  # that a daemon may have more of at the end than at the beginning; see growth()
MOST_AT_ONCE_MB = 64.0  # of the largest step, which is left out

Allowance = collections.namedtuple("Allowance", "source from_ns to_ns error")  # m; a lie that no program can notice earlier


class Scene:
    """A revision of the cell: which true values its pairs rest on."""

    def __init__(self, drawn, data, cell):
        self.cell, self.data = cell, data
        place = {pair: i for i, pair in enumerate(cell.pairs)}
        self.place = place | {(b, a): i for (a, b), i in place.items()}
        self.source_of = {name: source for source, names in drawn.sources.items() for name in names}
        self.source_of = {name: source for name, source in self.source_of.items() if not name.endswith("_base")}
        self.zones = {}
        for zone in data["zones"]:
            first, second = (drawn.side(data, group) for group in zone["between"])
            self.zones[zone["name"]] = zone["enter_below"], [
                i for (a, b), i in place.items() if (a in first and b in second) or (b in first and a in second)]
        self.rows = None

    def rows_of(self, report):
        """The rows of Cell.distances that belong to the report's pairs, and the sources of both objects; None: no names yet."""
        if self.rows is None or len(self.rows[0]) != len(report.pairs):
            names = report.pair_names
            if None in names:
                return None
            self.rows = (np.array([self.place[pair] for pair in names], dtype=int),
                         [np.array([self.source_of.get(pair[side], "") for pair in names]) for side in (0, 1)])
        return self.rows


class Judge:
    """`drawn` is a RandomCell; `scenes` has a Scene by revision. Reports of a revision that is not known yet wait."""

    def __init__(self, drawn, limit_ns):
        self.drawn, self.limit_ns = drawn, limit_ns
        self.scenes, self.waiting, self.allowances = {}, collections.deque(maxlen=500), []
        self.judged, self.pairs, self.false, self.false_count, self.least_gap = 0, 0, [], 0, math.inf

    def add_scene(self, revision, scene):
        self.scenes[revision] = scene
        waiting, self.waiting = self.waiting, collections.deque(maxlen=500)
        for report in waiting:
            self.judge(report)

    def say(self, report, text):
        self.false_count += 1
        if len(self.false) < 20:
            self.false.append(f"cycle {report.cycle}, revision {report.scene_revision:x}: {text}")

    def error_of(self, source, now_ns):
        return max((one.error for one in self.allowances if one.source == source and one.from_ns <= now_ns <= one.to_ns), default=0.0)

    def judge(self, report):
        scene = self.scenes.get(report.scene_revision)
        if scene is None:
            self.waiting.append(report)
            return
        found = scene.rows_of(report)
        if found is None:
            return
        rows, sides = found
        times, error = {}, {"": 0.0}
        for source in self.drawn.sources:
            ages = np.concatenate([report.pairs[key][side == source] for key, side in zip(("age_a_ns", "age_b_ns"), sides)])
            oldest, newest = int(ages.max()), int(ages.min())
            # Bounds hold for the poses in use. Those of a late object include its motion until the tick.
            is_late = oldest < 0 or oldest > self.limit_ns
            times[source] = report.now_ns - (0 if is_late else oldest)
            # An age of 0 may hide a stamp behind the tick, if the machine was held up between both.
            ahead = max(0, report.newest_pose_ns - report.now_ns) if newest == 0 else 0
            error[source] = self.error_of(source, report.now_ns) + SPREAD_SPEED * 1e-9 * (oldest - newest + ahead)
        joints = [value for robot in self.drawn.motion.spec["robots"] for value in self.drawn.motion.joints(robot, times[robot])[0]]
        poses = {one: self.drawn.motion.pose(one, times["tracker"])[0] for one in self.drawn.groups["movers"]}
        true = scene.cell.distances([joints], poses, points=False)
        lower, upper = true.lower[0], true.upper[0]
        wide = np.array([error[a] + error[b] for a, b in zip(*(side.tolist() for side in sides))])
        self.compare(report, scene, rows, lower, upper, wide)

    def compare(self, report, scene, rows, lower, upper, wide):
        """`lower` and `upper` enclose the true distances by pair of the scene, `wide` is what is allowed by pair of the report."""
        self.judged += 1
        self.pairs += len(rows)
        above = report.pairs["lower"] - upper[rows] - wide
        below = lower[rows] - report.pairs["upper"] - wide
        for i in np.flatnonzero((above > ROUNDING) | (below > ROUNDING)):
            self.say(report, f"{report.pair_names[i]} in [{report.pairs['lower'][i]}, {report.pairs['upper'][i]}], "
                             f"status {report.pairs['status'][i]}, true {lower[rows[i]]}")
        known = report.pairs["status"] < STALE
        self.least_gap = min([self.least_gap, *(-above[known]).tolist()])
        least = float(upper[rows].min()) + float(wide.max()) + ROUNDING
        if report.lower_all > least or (report.minimum_certified and report.minimum["lower"] > least):
            self.say(report, f"all pairs are above {max(report.lower_all, report.minimum['lower'])}, true {least}")
        width = dict(zip(rows.tolist(), wide.tolist()))
        status = dict(zip(rows.tolist(), report.pairs["status"].tolist()))
        active = {report.zone_names[zone] for zone in report.active_zones}
        for name, (enter, pairs) in scene.zones.items():
            for pair in pairs if name not in active else []:
                if status.get(pair) == UNKNOWN or upper[pair] + width.get(pair, 0.0) < enter - ROUNDING:
                    self.say(report, f"zone '{name}' is not active; pair {scene.cell.pairs[pair]} is at {upper[pair]}, status {status.get(pair)}")


def growth(samples):
    """What a process has more of at the end than at the beginning: descriptors, and MB of its resident memory.

    The largest step of the memory is left out, up to a limit: some daemons grow once and then no more. A leak goes on.
    """
    if len(samples) < 6:
        return 0, 0.0
    mb = [resident for _, resident in samples]
    largest = min(MOST_AT_ONCE_MB, max(0.0, *(after - before for before, after in itertools.pairwise(mb))))
    return samples[-1][0] - samples[0][0], mb[-1] - mb[0] - largest


def verdict(run):
    """The reasons for which a run fails; none: it holds."""
    reasons = [f"false: {text}" for text in run["false"]]
    if run["reports"] and not run["judged"]:
        reasons.append("no report could be judged")
    for fault in run["faults"]:
        if not fault["detected"]:
            reasons.append(f"not detected: {fault['kind']} of {fault['of']}: {fault['lacks']}")
        elif fault["alive_s"] is None:
            reasons.append(f"not alive again after {fault['kind']} of {fault['of']}: {fault['lacks']}")
    for process in run["processes"]:
        descriptors, mb = growth(process["samples"])
        if descriptors > MOST_DESCRIPTORS or mb > MOST_MB:
            reasons.append(f"leak: {process['name']} has {descriptors} descriptors and, but for one step, {mb:.1f} MB more than at its beginning")
    return reasons + run["failures"]

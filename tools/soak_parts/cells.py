"""A random cell, and the true motion of all that moves in it: a function of the time alone, whatever is heard of it."""
import copy, json, math, pathlib, random, re

ROOT = pathlib.Path(__file__).resolve().parents[2]
ARMS = {"seven": "config/cells/seven_joint_arm/arm", "five": "config/cells/tool_changer/arm"}
CLIENT = "soak planner"  # the name that may send commands and questions
SHARE_OF_SPEED = 0.5     # the true motion has at most this part of each stated speed


def urdf_of(arm):
    """The joints of its URDF that are sent: name, limits, speed, and whether it slides; and its links."""
    text = (ROOT / f"{ARMS[arm]}.urdf").read_text()
    joints = []
    for name, kind, rest in re.findall(r'<joint name="(\w+)" type="(\w+)">(.*?)</joint>', text):
        limit = re.search(r'lower="([-\d.]+)" upper="([-\d.]+)" velocity="([-\d.]+)"', rest)
        if limit and "<mimic" not in rest:
            joints.append((name, *map(float, limit.groups()), kind == "prismatic"))
    return joints, re.findall(r'<link name="(\w+)"', text)


class Motion:
    """Sums of two sines: joints of each robot, places and turns of each object. `spec` is plain JSON."""

    def __init__(self, spec):
        self.spec = spec

    @staticmethod
    def wave(terms, t):
        """Value and rate of a centre and sines (amplitude, 1/s, phase)."""
        centre, sines = terms
        return (centre + sum(a * math.sin(w * t + p) for a, w, p in sines),
                sum(a * w * math.cos(w * t + p) for a, w, p in sines))

    def seconds(self, stamp_ns):
        return 1e-9 * (stamp_ns - self.spec["epoch_ns"])

    def joints(self, robot, stamp_ns):
        t = self.seconds(stamp_ns)
        both = [self.wave(terms, t) for terms in self.spec["robots"][robot]["waves"]]
        return [value for value, _ in both], [rate for _, rate in both]

    def pose(self, item, stamp_ns):
        t = self.seconds(stamp_ns)
        (x, vx), (y, vy), (z, vz), (turn, rate) = (self.wave(terms, t) for terms in self.spec["objects"][item])
        return [x, y, z, 0.0, 0.0, math.sin(turn / 2), math.cos(turn / 2)], [vx, vy, vz, 0.0, 0.0, rate]


def sines(rng, reach, speed):
    """Two sines that stay within the reach and below the speed."""
    found = []
    for share in (0.7, 0.3):
        rate = rng.uniform(0.4, 2.5)
        found.append((share * min(reach, speed / rate) * rng.uniform(0.5, 1.0), rate, rng.uniform(0, 2 * math.pi)))
    return found


def shape_of(rng):
    size = lambda low, high: round(rng.uniform(low, high), 3)
    return rng.choice([
        lambda: {"box": {"size": [size(0.1, 0.5), size(0.1, 0.5), size(0.1, 0.5)]}},
        lambda: {"sphere": {"radius": size(0.05, 0.2)}},
        lambda: {"capsule": {"from": [0, 0, 0], "to": [0, 0, size(0.2, 0.8)], "radius": size(0.04, 0.12)}},
        lambda: {"cylinder": {"radius": size(0.05, 0.15), "length": size(0.1, 0.5)}},
    ])()


def pose_of(rng):
    place = [round(rng.uniform(0.5, 1.2) * rng.choice([-1, 1]), 3), round(rng.uniform(-1.2, 1.2), 3), round(rng.uniform(0.1, 1.2), 3)]
    return {"xyz": place, "rpy": [round(rng.uniform(-180, 180), 1) for _ in range(3)]}


class RandomCell:
    """`cell` is the text as plain data; `sources` has the objects of each source that sends."""

    def __init__(self, seed, epoch_ns, rates=(100, 200, 400)):
        rng = random.Random(seed)
        self.age_limit_ms = rng.choice([40, 60, 100])
        self.cell = {
            "name": f"soak_{seed}", "units": {"length": "m", "angle": "deg"}, "rate_hz": rng.choice(rates),
            "defaults": {"age_limit_ms": self.age_limit_ms}, "commands": {"from": [CLIENT]}, "questions": {"from": [CLIENT]},
            "capacity": {"objects": 4, "parts": 100, "pairs": 1000, "bytes": 1000000},
            "robots": [], "objects": [], "pairs": [], "zones": []}
        spec = {"epoch_ns": epoch_ns, "age_limit_ms": self.age_limit_ms, "robots": {}, "objects": {}}
        self.groups = {"things": [], "movers": []}
        for i in range(rng.choice([1, 2, 2])):
            self.add_robot(rng, f"r{i}", spec, i)
        for i in range(rng.randint(1, 5)):
            self.cell["objects"].append({"name": f"thing{i}", "groups": ["things"], "fixed": True, **shape_of(rng), "pose": pose_of(rng)})
            self.groups["things"].append(f"thing{i}")
        for i in range(rng.randint(1, 3)):
            self.add_mover(rng, f"mover{i}", spec)
        robots = list(spec["robots"])
        of_pairs = [(r, other) for r in robots for other in ("things", "movers")] + [("movers", "things")]
        of_pairs += [(r, r) for r in robots] + ([tuple(robots)] if len(robots) == 2 else [])
        self.cell["pairs"] = [{"between": list(pair), "publish": True} for pair in of_pairs]
        for i, pair in enumerate(pair for pair in of_pairs if pair[0] != pair[1]):
            enter = round(rng.uniform(0.02, 0.4), 3)
            self.cell["zones"].append({"name": f"zone{i}", "between": list(pair), "enter_below": enter,
                                       "leave_above": round(enter + rng.uniform(0.01, 0.1), 3)})
        self.motion = Motion(spec)
        self.sources = {r: self.groups[r] for r in robots} | {"tracker": self.groups["movers"]}

    def add_robot(self, rng, name, spec, place):
        arm = rng.choice(sorted(ARMS))
        joints, links = urdf_of(arm)
        self.cell["robots"].append({
            "name": name, "urdf": str(ROOT / f"{ARMS[arm]}.urdf"), "srdf": str(ROOT / f"{ARMS[arm]}.srdf"), "prefix": f"{name}_",
            "base": {"pose": {"xyz": [round(rng.uniform(-0.3, 0.3), 3), 1.1 * place, 0.3], "rpy": [0, 0, round(rng.uniform(-90, 90), 1)]}}})
        waves = []
        for _, low, high, speed, slides in joints:
            waves.append(((low + high) / 2, sines(rng, (0.2 if slides else 0.3) * (high - low), SHARE_OF_SPEED * speed)))
        spec["robots"][name] = {"joints": [f"{name}_{joint[0]}" for joint in joints], "waves": waves,
                                "slides": [joint[4] for joint in joints], "speeds": [joint[3] for joint in joints]}
        self.groups[name] = [f"{name}_{link}" for link in links]

    def add_mover(self, rng, name, spec):
        speed = round(rng.uniform(0.5, 2.0), 2)
        # A turn of 0.3 rad/s moves no point of these shapes by more than 0.3 m/s.
        self.cell["objects"].append({"name": name, "groups": ["movers"], "max_speed": round(2 * speed + 0.6, 3), **shape_of(rng)})
        places = [rng.uniform(-1.2, 1.2), rng.uniform(-1.2, 1.2), rng.uniform(0.2, 1.2)]
        spec["objects"][name] = [(place, sines(rng, 0.4, speed / math.sqrt(3))) for place in places] + [(0.0, sines(rng, 0.5, 0.3))]
        self.groups["movers"].append(name)

    @staticmethod
    def text(cell):
        return json.dumps(cell, indent=1)  # YAML reads it

    def with_object(self, cell, entry, is_added):
        changed = copy.deepcopy(cell)
        names = [one["name"] for one in changed["objects"]]
        place = names.index(entry["name"]) if entry["name"] in names else len(names)
        changed["objects"][place:place + 1] = [entry] * is_added
        return changed

    def side(self, cell, group):
        """The names in a group of this cell."""
        return set(self.groups.get(group, [])) | {one["name"] for one in cell["objects"] if group in one.get("groups", [])}

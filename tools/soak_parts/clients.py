"""What clients do in a round: commands that are done, questions that are judged, programs that come and go."""
import signal, time

import numpy as np

import clearance
from cells import CLIENT, pose_of, shape_of

SAMPLES = 40  # of a motion, at which an answer is judged


def command(run, rng):
    """Changes, adds or removes a fixed object; the reports of the changed scene are judged by the changed cell.

    While partners exchange the lead, a command may be answered twice. So theirs have the same effect if they are repeated.
    """
    names = ["thing0"] if run.kind == "partners" else ["thing0", "added"]
    name = rng.choice(names)
    is_there = any(one["name"] == name for one in run.data["objects"])
    change = "add_object" if not is_there else rng.choice(["replace_object"] + ["remove_object"] * (name == "added"))
    entry = {"name": name, "groups": ["things"], "fixed": True, **shape_of(rng), "pose": pose_of(rng)}
    is_added = change != "remove_object"
    text = "units: {length: m, angle: deg}\nchanges: " + run.drawn.text([{change: entry if is_added else {"object": name}}])
    for _ in range(5):
        with clearance.Commands(CLIENT, run.connection) as commands:
            result = commands.send(text, 20.0)
        if result.status != clearance.CommandStatus.BUSY:
            break
    if not result.done:
        run.failures.append(f"the command {change} of {name} is refused: {result.status!r} {result.path} {result.reason}")
        return
    run.count("commands done")
    run.note_change()
    run.put(run.drawn.with_object(run.data, entry, is_added), result.revision)


def question(run, rng):
    """Asks whether a robot may move along three waypoints; samples of the same motion may not be nearer than the answer."""
    cell = clearance.Cell(run.file)
    robots = run.drawn.motion.spec["robots"]
    robot = rng.choice(sorted(robots))
    now = time.time_ns()
    path = [[centre + rng.uniform(-0.15, 0.15) * (0.01 if slides else 1.0) for (centre, _), slides in
             zip(robots[robot]["waves"], robots[robot]["slides"])] for _ in range(3)]
    held = {joint: centre for other, spec in robots.items() if other != robot for joint, (centre, _) in zip(spec["joints"], spec["waves"])}
    poses = {one: run.drawn.motion.pose(one, now)[0] for one in run.drawn.groups["movers"]}
    with clearance.Questions(CLIENT, run.connection) as questions:
        answer = questions.ask(clearance.Question(robots[robot]["joints"], [0, 1, 2], path, held=held, poses=poses, margins=[0.05]), 20.0)
    if not answer.answered:
        run.failures.append(f"the question is refused: {answer.status!r} {answer.path} {answer.reason}")
        return
    run.count("questions answered")
    instants = np.linspace(0, 2, SAMPLES)
    own = {joint: np.interp(instants, [0, 1, 2], column) for joint, column in zip(robots[robot]["joints"], zip(*path))}
    joints = np.array([own.get(joint, np.full(SAMPLES, held.get(joint, 0.0))) for joint in cell.joints]).T
    moved = set(run.drawn.sources[robot])
    pairs = [pair for pair in cell.pairs if moved & set(pair) and not all(name.endswith("_base") for name in pair)]
    least = float(cell.distances(joints, poses, points=False, pairs=pairs).upper.min())
    if answer.lower > max(least, 0.0) + 1e-9 or (answer.is_free(0.05) and least < 0.05 - 1e-9):
        run.judge.say(run.last, f"the answer about {robot} is {answer.lower}, at a sample {least}")


def program(run, rng):
    """A program that hears reports comes, and leaves: by itself, killed, or after it stood still."""
    name = f"client{run.counts.get('clients', 0)}"
    run.count("clients")
    watch = [run.bin / "clearance-watch", *run.network, "--plain", "--seconds", 2]
    record = [run.bin / "clearance-record", "-o", run.folder / f"{name}.mcap", *run.network, "--cell", run.file]
    client = run.start(name, rng.choice([watch, record]))
    end = rng.choice(["leaves", "is killed", "stands still"])
    time.sleep(0.5)
    if end == "stands still":
        client.send(signal.SIGSTOP)
        time.sleep(1.0)
    run.end(name, signal.SIGKILL if end == "is killed" else signal.SIGTERM)


def reader(run, _):
    """A second reader of this process comes, hears and leaves."""
    with clearance.Reports(run.connection, depth=4) as reports:
        if reports.next(10.0) is None:
            run.failures.append("a second reader hears no report within 10 s")
    run.count("clients")


ALL = [command, question, program, reader]

"""The kinds of rounds: what is started, and what is judged once all has ended."""
import re, signal, subprocess, time

import cells

COMPARED = "bounds compared with what cameras saw"

def bodies(run, _, daemons=("daemon",)):
    """A random cell: a daemon, and a program for each source."""
    run.use(cells.RandomCell(run.seed, time.time_ns(), [50] if run.kind == "partners" else [100, 200, 400]))
    for source in run.drawn.sources:
        run.start_sender(source, source)
    for name in daemons:
        run.start_daemon(name)


def partners(run, rng):
    bodies(run, rng, ("daemon-left", "daemon-right"))


def cameras(run, rng):
    """A shipped cell with a camera, in which a person walks whom the cell does not know; the robot compares bounds with the truth."""
    text = (cells.ROOT / "config/cells/camera.yaml").read_text().replace(" seven_joint_arm/", f" {cells.ROOT}/config/cells/seven_joint_arm/")
    run.file.write_text(text)
    near = [round(rng.uniform(1.2, 1.8), 2), round(rng.uniform(-0.4, 0.4), 2)]
    run.start_daemon("daemon")
    run.start("robot", [run.bin / "clearance-robot", run.file, *run.network, "--rate", 200, "--camera-rate", 10, "--camera-size", "160x120",
                        "--swing", round(rng.uniform(0.1, 0.4), 2), "--person", f"3.2,-0.6:{near[0]},{near[1]}", "--truth"])


def after(run):
    """What programs say once all of them have ended, and whether a replay of each whole recording makes the same reports."""
    for robot in (one for one in run.ended if one.name == "robot"):
        text = robot.log.read_text(errors="replace")
        found = re.findall(r"^truth .*: (\d+) reports?,.* (\d+) not within the bounds", text, re.MULTILINE)
        run.count(COMPARED, sum(int(count) for count, _ in found))
        if not found or any(wrong != "0" for _, wrong in found):
            run.failures.append(f"the robot says of what cameras saw: {text[-2000:]}")
    for daemon in (one for one in run.ended if one.name.startswith("daemon")):
        status = daemon.process.returncode
        if status not in (0, -signal.SIGKILL):
            run.failures.append(f"{daemon.name} ended with status {status}: {daemon.log.read_text(errors='replace')[-1000:]}")
        if status == 0 and daemon.recording:
            again = subprocess.run([run.bin / "clearance-replay", "check", daemon.recording, "--compare"], capture_output=True, text=True)
            run.count("recordings replayed to the bit", again.returncode == 0)
            if again.returncode:
                run.failures.append(f"a replay of {daemon.recording} differs: {again.stdout[-1000:]}{again.stderr[-1000:]}")

"""What runs in a round of the soak: real programs in a DDS partition of their own, and a reader that hears and judges."""
import json, os, pathlib, re, signal, subprocess, sys, tempfile, threading, time

import clearance
import judge
import rounds

HERE = pathlib.Path(__file__).resolve().parent
LIMIT_S = 20.0        # until a fault is detected, and until all is known again: a machine that is busy takes long
JUDGED_HZ = 40.0      # the queries of the judge begin from nothing, which takes a millisecond a report


class Process:
    def __init__(self, name, command, log, environment):
        self.name, self.log, self.samples, self.changes, self.recording = name, log, [], 0, None
        with log.open("a") as output:
            # Programs hear SIGHUP, also if nohup runs the soak.
            self.process = subprocess.Popen(["env", "--default-signal=HUP", *map(str, command)], stdin=subprocess.PIPE, stdout=output,
                                            stderr=subprocess.STDOUT, text=True, env=environment)

    def tell(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def send(self, which):
        if self.process.poll() is None:
            self.process.send_signal(which)

    def end(self, how=signal.SIGTERM, limit_s=LIMIT_S):
        """Its exit status; None: it had to be killed."""
        self.send(signal.SIGCONT)
        self.send(how)
        try:
            return self.process.wait(limit_s)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            return None

    def sample(self):
        """Counts descriptors and resident MB, while it runs."""
        try:
            descriptors = len(os.listdir(f"/proc/{self.process.pid}/fd"))
            resident = re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{self.process.pid}/status").read_text())
        except OSError:
            return
        if resident and self.process.poll() is None:
            self.samples.append((descriptors, int(resident[1]) / 1024))


class Run:
    def __init__(self, options, seed, kind):
        self.bin, self.seed, self.kind = options.bin, seed, kind
        self.domain, self.partition = options.domain, f"soak-{os.getpid()}-{seed}"
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix=f"clearance-soak-{seed}."))
        self.file = self.folder / "cell.yaml"
        self.network = ["--domain", self.domain, "--partition", self.partition, "--interface", "lo"]
        self.environment = dict(os.environ, PYTHONPATH=f"{options.python}:{HERE}", PYTHONDONTWRITEBYTECODE="1")
        self.connection = clearance.Connection(domain=self.domain, partition=self.partition, interface="lo")
        self.living, self.ended, self.faults, self.failures, self.counts = {}, [], [], [], {}
        self.judge, self.drawn, self.data = None, None, None
        self.reports, self.missed, self.last, self.status = 0, 0, None, {}
        # The last report in which all is known; when the last one came, and the last that no partner agrees with.
        self.alive_ns = self.heard_ns = self.apart_ns = 0
        self.fail_safe, self.partners, self.health = True, 0, {}
        self.stop = threading.Event()
        self.reader = threading.Thread(target=self.read, daemon=True)

    # ---- Programs

    def start(self, name, command):
        process = Process(name, command, self.folder / f"{name}.log", self.environment)
        self.living[name] = process
        return process

    def start_daemon(self, name):
        partner = ["--partner", name] if self.kind == "partners" else []
        recording = None if self.kind == "cameras" else self.folder / f"{name}-{len(self.ended)}.mcap"
        record = ["--record", recording, "--record-every", 20] if recording else []
        process = self.start(name, [self.bin / "clearanced", self.file, *self.network, *partner, *record])
        process.recording = recording
        return process

    def start_sender(self, source, name):
        return self.start(f"sender-{name}", [sys.executable, HERE / "sender.py", self.folder / "motion.json", source, name,
                                             self.domain, self.partition])

    def end(self, name, how=signal.SIGTERM):
        process = self.living.pop(name)
        self.ended.append(process)
        return process.end(how)

    def sample(self):
        for process in list(self.living.values()):
            process.sample()

    def note_change(self):
        """The first changes of a cell reserve memory for others: leaks are counted from then on."""
        for name in self.daemons():
            self.living[name].changes += 1
            if self.living[name].changes <= 2:
                self.living[name].samples.clear()

    def daemons(self):
        return [name for name in self.living if name.startswith("daemon")]

    def logged(self, code):
        """How often daemons have logged a line with this code."""
        return sum(log.read_text(errors="replace").count(f"[{code}]") for log in self.folder.glob("daemon*.log"))

    def refused(self):
        return sum(one["count"] for one in self.health.get("rejected", []))

    def count(self, what, by=1):
        self.counts[what] = self.counts.get(what, 0) + by

    # ---- The cell

    def use(self, drawn):
        self.drawn = drawn
        (self.folder / "motion.json").write_text(json.dumps(drawn.motion.spec))
        self.judge = judge.Judge(drawn, 1_000_000 * drawn.age_limit_ms)
        self.put(drawn.cell)

    def put(self, data, revision=None):
        """The cell is this one from now on, also for a daemon that reads its file. `revision`: what a daemon calls it."""
        self.data = data
        self.file.write_text(self.drawn.text(data))
        cell = clearance.Cell(self.file)
        for one in {cell.revision, revision or cell.revision}:
            self.judge.add_scene(one, judge.Scene(self.drawn, data, cell))

    # ---- The reader

    def read(self):
        due = 0.0
        try:
            with clearance.Reports(self.connection, error_interval_s=1e-3) as reports:
                while not self.stop.is_set():
                    report = reports.next(0.05)
                    self.fail_safe, self.partners = reports.fail_safe, reports.daemons
                    self.health = reports.health or self.health
                    if report is None:
                        continue
                    self.hear(report)
                    if self.judge and time.monotonic() >= due:
                        due = time.monotonic() + 1.0 / JUDGED_HZ
                        self.judge.judge(report)
        except Exception as error:  # the run fails by it, instead of ending without a word
            self.failures.append(f"the reader failed: {type(error).__name__}: {error}")

    def hear(self, report):
        self.reports += 1
        self.missed += report.missed
        self.heard_ns, self.last = time.time_ns(), report
        if report.partner != "agrees":
            self.apart_ns = self.heard_ns
        if len(report.pairs) and report.pairs["status"].max() < judge.STALE and report.minimum_certified:
            self.alive_ns = report.now_ns
        scene = self.judge and self.judge.scenes.get(report.scene_revision)
        rows = scene.rows_of(report) if scene else None
        if rows:
            status = report.pairs["status"]
            self.status = {source: int(max(status[rows[1][0] == source].max(initial=0), status[rows[1][1] == source].max(initial=0)))
                           for source in self.drawn.sources}
        else:
            self.status = {"": int(report.pairs["status"].max(initial=0))}

    def until(self, is_so, limit_s=LIMIT_S):
        """The seconds until it is so; None: it is not within the limit."""
        began = time.monotonic()
        while time.monotonic() < began + limit_s:
            if is_so():
                return time.monotonic() - began
            time.sleep(0.01)
        return None

    def until_alive(self):
        """The seconds until all pairs are known and certified for a quarter of a second."""
        since = [0]

        def is_alive():
            if self.alive_ns == 0 or self.last.now_ns != self.alive_ns or time.time_ns() > self.heard_ns + 500_000_000:
                since[0] = 0
            elif since[0] == 0:
                since[0] = time.monotonic()
            return since[0] and time.monotonic() > since[0] + 0.25
        return self.until(is_alive)

    def until_healthy(self):
        """The seconds until partners agree, and until a health that was written later has nothing that is late."""
        now = time.time_ns()

        def is_healthy():
            ages = [*self.health["inputs"], *self.health["joints"]] if self.health.get("now_ns", 0) > now else [{"stale": True}]
            agree = self.kind != "partners" or time.time_ns() > self.apart_ns + 500_000_000
            return agree and not any(one["stale"] for one in ages)
        return self.until(is_healthy)

    def worst(self):
        """For a person: the pairs of the last report that are not known."""
        if self.last is None:
            return "no report has come"
        names = [f"{a} - {b}" for a, b in filter(None, (name for name, row in zip(self.last.pair_names, self.last.pairs) if row["status"] >= judge.STALE))]
        return f"{len(names)} pairs are not known: {', '.join(names[:3])}; {time.time_ns() - self.heard_ns} ns since the last report"

    # ---- Results

    def close(self):
        self.stop.set()
        if self.reader.is_alive():
            self.reader.join(LIMIT_S)
        for name in list(self.living):
            self.end(name)

    def result(self):
        processes = [{"name": one.name, "samples": one.samples} for one in self.ended if one.name.startswith("daemon")]
        return {"seed": self.seed, "kind": self.kind, "reports": self.reports, "missed": self.missed, "faults": self.faults,
                "judged": self.judge.judged if self.judge else self.counts.get(rounds.COMPARED, 0),
                "pairs_judged": self.judge.pairs if self.judge else 0, "false": self.judge.false if self.judge else [],
                "false_count": self.judge.false_count if self.judge else 0, "processes": processes, "counts": self.counts,
                "failures": self.failures, "folder": str(self.folder)}

"""Faults of a round: each is injected, has to show in reports or in a log, ends, and all has to be known again."""
import signal, socket, time

import clearance
import judge

FOREVER = 2**62


class Fault:
    """A kind of fault. `code` is the line of the daemon's log that tells it; empty: health or a client does."""
    kinds = ("bodies", "partners")  # of rounds
    code = ""

    of = ""

    def __init__(self, run, rng):
        self.run, self.rng, self.before = run, rng, None

    def note(self):
        """What stood before it began."""
        self.before = (self.run.logged(self.code) if self.code else 0, self.run.refused())

    def begin(self):
        raise NotImplementedError

    def shows(self):
        """The reports show it."""
        return True

    def is_told(self):
        return not self.code or self.run.logged(self.code) > self.before[0]

    def end(self):
        """What is done against it."""


class OfSource(Fault):
    """A fault of what one source sends, by a word to its program."""
    lie, least_status, codes = "", judge.STALE, ("", "")

    def __init__(self, run, rng):
        super().__init__(run, rng)
        self.of = rng.choice(sorted(run.drawn.sources))
        self.code = self.codes[self.of == "tracker"]

    def sender(self):
        return self.run.living[f"sender-{self.of}"]

    def begin(self):
        self.sender().tell(self.lie)

    def shows(self):
        return self.run.status.get(self.of, 0) >= self.least_status

    def end(self):
        self.sender().tell("true")


class KilledSender(OfSource):
    codes = ("joints-late", "poses-late")

    def begin(self):
        self.run.end(f"sender-{self.of}", signal.SIGKILL)

    def end(self):
        self.run.start_sender(self.of, self.of)


class StoppedSender(OfSource):
    codes = ("joints-late", "poses-late")

    def begin(self):
        self.sender().send(signal.SIGSTOP)

    def end(self):
        self.sender().send(signal.SIGCONT)


class FrozenSource(OfSource):
    """Until its twists have led too far from a place that does not change, no program can notice it."""
    lie, codes = "frozen", ("joints-contradict", "poses-contradict")

    def begin(self):
        self.allowance = judge.Allowance(self.of, time.time_ns(), FOREVER, float("inf"))
        self.run.judge.allowances.append(self.allowance)
        super().begin()

    def end(self):
        super().end()
        self.run.until_alive()
        self.run.judge.allowances.remove(self.allowance)
        self.run.judge.allowances.append(self.allowance._replace(to_ns=time.time_ns()))


class LeapingSource(OfSource):
    """One value of twenty is elsewhere: it is refused, and those before and behind it are used."""
    lie, least_status = "leaping", 0

    def is_told(self):
        return self.run.refused() > self.before[1]


class FutureSource(OfSource):
    lie = "future"
    is_told = LeapingSource.is_told


class BehindSource(OfSource):
    """Stamps half a second old. They count as late, or contradict the newer ones."""
    lie, codes = "behind", ("joints-late", "poses-late")

    def note(self):
        super().note()
        self.contradicted = self.contradictions()

    def contradictions(self):
        return self.run.logged("joints-contradict") + self.run.logged("poses-contradict")

    def is_told(self):
        if super().is_told():
            return True
        if self.contradictions() > self.contradicted:
            self.code = self.code.replace("late", "contradict")
            return True
        return False


class RivalSource(OfSource):
    codes = ("two-joint-sources", "two-sources")

    def begin(self):
        self.run.count("rivals")
        self.name = f"rival{self.run.counts['rivals']}"
        self.run.start_sender(self.of, self.name).tell("elsewhere")

    def end(self):
        self.run.end(f"sender-{self.name}", signal.SIGKILL)


class KilledDaemon(Fault):
    """A client hears that no report comes; with a partner, it misses none for long."""
    kinds, code = ("bodies", "cameras"), "started"

    def begin(self):
        self.of = self.run.daemons()[0]
        self.run.until(lambda: not self.run.fail_safe)
        self.run.end(self.of, signal.SIGKILL)

    def shows(self):
        if not self.run.fail_safe or self.of in self.run.living:
            return self.of in self.run.living
        self.run.start_daemon(self.of)
        return True


class StoppedDaemon(Fault):
    """It stands still until a client says that no report comes. Health counts the ticks that it has skipped."""
    kinds = ("bodies", "cameras")

    def begin(self):
        self.of = self.run.daemons()[0]
        self.skipped = self.run.health.get("skipped_cycles", 0)
        self.run.until(lambda: not self.run.fail_safe)
        self.run.living[self.of].send(signal.SIGSTOP)
        self.is_stopped = True

    def shows(self):
        if self.is_stopped and self.run.fail_safe:
            self.end()
        return not self.is_stopped

    def is_told(self):
        return self.run.health.get("skipped_cycles", 0) > self.skipped

    def end(self):
        self.is_stopped = False
        self.run.living[self.of].send(signal.SIGCONT)


class KilledPartner(Fault):
    """Reports go on, from the other one. The one that was killed starts again, and agrees."""
    kinds, code = ("partners",), "partner-missing"

    def begin(self):
        self.of, self.began_ns = self.rng.choice(self.run.daemons()), time.time_ns()
        self.run.end(self.of, signal.SIGKILL)

    def shows(self):
        return self.run.apart_ns > self.began_ns

    def end(self):
        self.run.start_daemon(self.of)


class StoppedPartner(KilledPartner):
    def begin(self):
        self.of, self.began_ns = self.rng.choice(self.run.daemons()), time.time_ns()
        self.run.living[self.of].send(signal.SIGSTOP)

    def end(self):
        self.run.living[self.of].send(signal.SIGCONT)


class SecondDaemon(Fault):
    kinds, code, of = ("bodies", "cameras"), "other-daemon-later", "a daemon"

    def begin(self):
        self.second = self.run.start_daemon("second")

    def shows(self):
        return self.second.process.poll() == 4

    def end(self):
        self.run.end("second")


class WrongCell(Fault):
    """The file of the cell has a mistake when the daemon is told to read it again."""
    kinds, code = ("bodies",), "scene-refused"

    def begin(self):
        self.of = self.run.daemons()[0]
        self.run.file.write_text(self.run.drawn.text(self.run.data | {"objects": [{"name": "a thing without a shape"}]}))
        self.run.living[self.of].send(signal.SIGHUP)

    def end(self):
        self.run.put(self.run.data)
        self.run.living[self.of].send(signal.SIGHUP)


class StrangersCommand(Fault):
    code, of = "command-refused", "a client"

    def begin(self):
        with clearance.Commands("a stranger", self.run.connection) as commands:
            self.status = commands.send("- remove_object: {object: mover0}", 10.0).status

    def shows(self):
        return self.status == clearance.CommandStatus.NOT_NAMED


class StrangersQuestion(Fault):
    code, of = "question-refused", "a client"

    def begin(self):
        with clearance.Questions("a stranger", self.run.connection) as questions:
            robot = self.run.drawn.motion.spec["robots"]["r0"]
            answer = questions.ask(clearance.Question(robot["joints"][:1], [0, 1], [[0.0], [0.1]], margins=[0.02]), 10.0)
            self.status = answer.status

    def shows(self):
        return self.status == clearance.QuestionStatus.NOT_NAMED


class Datagrams(Fault):
    """Bytes that are no message, or a message's beginning, to every port of the domain's first participants."""
    kinds, of = ("bodies", "partners", "cameras"), "the network"

    def begin(self):
        base = 7400 + 250 * self.run.domain
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sending:
            for _ in range(400):
                length = self.rng.choice([0, 3, 20, 24, 60, 200, 1400, 60000])
                header = b"RTPS\x02\x01\x01\x10" + self.rng.randbytes(12)
                kinds = bytes([self.rng.choice([0x07, 0x08, 0x09, 0x0e, 0x15, 0x16]), self.rng.randrange(256)])
                body = (header + kinds if self.rng.random() < 0.8 else b"") + self.rng.randbytes(length)
                for index in range(8):
                    for offset in (10, 11):
                        sending.sendto(body[:65000], ("127.0.0.1", base + offset + 2 * index))
        self.heard = self.run.reports

    def shows(self):
        return self.run.reports > self.heard + 10  # nothing shows but that reports go on, and are true


class StoppedRobot(Fault):
    """Joints, poses and pictures stay away together."""
    kinds, code, of = ("cameras",), "joints-late", "the robot"

    def begin(self):
        self.run.living["robot"].send(signal.SIGSTOP)

    def shows(self):
        return max(self.run.status.values(), default=0) >= judge.STALE

    def end(self):
        self.run.living["robot"].send(signal.SIGCONT)


ALL = [KilledSender, StoppedSender, FrozenSource, LeapingSource, FutureSource, BehindSource, RivalSource, KilledDaemon, StoppedDaemon,
       KilledPartner, StoppedPartner, SecondDaemon, WrongCell, StrangersCommand, StrangersQuestion, Datagrams, StoppedRobot]


def inject(run, kind, rng, limit_s):
    """Injects a fault, waits until it is detected, ends it, and waits until all is known again, as health and log say as well."""
    run.until_healthy()
    fault = kind(run, rng)
    fault.note()
    began = time.monotonic()
    fault.begin()
    shown = run.until(fault.shows, limit_s) is not None
    shown_s = time.monotonic() - began
    told = run.until(fault.is_told, limit_s) is not None
    row = {"kind": kind.__name__, "of": fault.of, "detected": shown and told, "shown_s": shown_s if shown else None,
           "told_s": time.monotonic() - began if told else None, "code": fault.code, "lacks": ""}
    if not row["detected"]:
        row["lacks"] = f"shown: {shown}, told by [{fault.code}]: {told}"
    fault.end()
    row["alive_s"] = run.until_alive()
    if row["alive_s"] is None:
        row["lacks"] = row["lacks"] or run.worst()
    elif run.until_healthy() is None:
        row["alive_s"], row["lacks"] = None, row["lacks"] or "health names late inputs, or partners do not agree"
    run.faults.append(row)

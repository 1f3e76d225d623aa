"""Live objects where no daemon runs: waits, signals, threads, closing and wrong arguments."""

import signal
import subprocess
import sys
import threading

import pytest

import clearance

LIMIT_S = 30.0  # only a broken program takes longer
ARM = ["shoulder", "elbow"]


@pytest.fixture
def connection():
    return clearance.Connection(domain=7, partition="python-tests-without-a-daemon")


def test_ctrl_c_ends_a_program_that_waits():
    program = """
import sys, clearance
connection = clearance.Connection(domain=7, partition="python-tests-without-a-daemon")
try:
    print("waiting", flush=True)
    clearance.Reports(connection).next()
except KeyboardInterrupt:
    sys.exit(3)
"""
    running = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    assert running.stdout.readline() == "waiting\n"
    running.send_signal(signal.SIGINT)
    assert running.wait(LIMIT_S) == 3
    running.stdout.close()


def test_without_a_daemon_waits_end_with_nothing(connection):
    with clearance.Reports(connection) as reports:
        assert reports.next(0.05) is None and reports.newest(0) is None and reports.daemons == 0
    with clearance.PoseWriter("python", ["ball"], connection) as poses:
        assert not poses.wait_heard(0.05) and not poses.is_heard
        assert poses.write([[0, 0, 0, 0, 0, 0, 1]]) is False
    with clearance.Commands("python tests", connection) as commands, pytest.raises(TimeoutError):
        commands.send("- place: {object: wall, pose: {xyz: [0, 0, 0]}}", 0.1)


class Interrupted(Exception):
    pass


@pytest.mark.parametrize(
    "wait",
    [
        lambda c: clearance.Reports(c).next(),
        lambda c: clearance.Reports(c).newest(600),
        lambda c: list(clearance.Reports(c)),
        lambda c: clearance.JointWriter("python", ARM, c).wait_heard(),
        lambda c: clearance.PoseWriter("python", ["ball"], c).wait_heard(600),
        lambda c: clearance.Commands("python", c).send("- place: {object: a, pose: {xyz: [0, 0, 0]}}", 600),
    ],
)
def test_a_signal_ends_every_wait(connection, wait):
    def raise_it(*_):
        raise Interrupted

    former = signal.signal(signal.SIGALRM, raise_it)
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    try:
        with pytest.raises(Interrupted):
            wait(connection)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, former)


def test_a_wait_lets_other_threads_run(connection):
    counted = []
    with clearance.Reports(connection) as reports:
        thread = threading.Thread(target=lambda: counted.extend(range(1000)))
        thread.start()
        reports.next(0.3)
        assert len(counted) == 1000
        thread.join()


@pytest.mark.parametrize("daemon_thread", [False, True])
def test_a_program_ends_in_peace_while_objects_are_open_and_a_thread_waits(daemon_thread):
    program = f"""
import threading, time, clearance
connection = clearance.Connection(domain=7, partition="python-tests-without-a-daemon")
reports, waiting = clearance.Reports(connection), clearance.Reports(connection)
joints = clearance.JointWriter("python", ["a"], connection)
if {daemon_thread}:
    for timeout in (0.05, 0.1, 0.11, 600):
        one = clearance.Reports(connection)
        threading.Thread(target=lambda r=one, t=timeout: [r.next(t) for _ in range(9)], daemon=True).start()
    time.sleep(0.1)
"""
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
        assert (done.returncode, done.stderr) == (0, "")


def test_a_second_thread_is_refused_and_so_is_closing_under_a_wait(connection):
    reports = clearance.Reports(connection)
    waiting = threading.Thread(target=lambda: reports.next(1.0))
    waiting.start()
    refusals = []
    while waiting.is_alive():
        for call in (lambda: reports.next(0), reports.close):
            try:
                call()
            except clearance.ClosedError:
                break
            except RuntimeError as error:
                refusals.append(str(error))
    waiting.join()
    assert refusals and all("thread" in text for text in refusals)


@pytest.mark.parametrize(
    "make, calls",
    [
        (
            lambda c: clearance.Reports(c),
            [lambda r: r.next(0), lambda r: r.daemons, next, lambda r: r.zones, lambda r: r.health],
        ),
        (
            lambda c: clearance.JointWriter("a", ARM, c),
            [lambda w: w.write([0, 0]), lambda w: w.is_heard, lambda w: w.wait_heard(0)],
        ),
        (
            lambda c: clearance.PoseWriter("a", ["ball"], c),
            [lambda w: w.write([[0] * 6 + [1]]), lambda w: w.is_heard],
        ),
        (
            lambda c: clearance.Commands("a", c),
            [lambda w: w.send("- place: {object: a, pose: {xyz: [0, 0, 0]}}", 0), lambda w: w.is_heard],
        ),
    ],
)
def test_a_closed_object_says_so(connection, make, calls):
    live = make(connection)
    assert not live.closed
    live.close()
    live.close()
    assert live.closed
    for call in calls:
        with pytest.raises(clearance.ClosedError):
            call(live)


@pytest.mark.parametrize(
    "call, error",
    [
        (lambda c: clearance.JointWriter("", ARM, c), ValueError),
        (lambda c: clearance.JointWriter("a", ["x", "y", "x"], c), ValueError),
        (lambda c: clearance.JointWriter("x" * 33, ARM, c), ValueError),
        (lambda c: clearance.JointWriter("x", 5, c), TypeError),
        (lambda c: clearance.JointWriter("x", ARM, "here"), TypeError),
        (lambda c: clearance.JointWriter("x", ARM, c).write([1]), ValueError),
        (lambda c: clearance.JointWriter("x", ARM, c).write([1, float("nan")]), ValueError),
        (lambda c: clearance.JointWriter("x", ARM, c).write([1, 2], [1]), ValueError),
        (lambda c: clearance.JointWriter("x", ARM, c).write(None), TypeError),
        (lambda c: clearance.PoseWriter("", ["a"], c), ValueError),
        (lambda c: clearance.PoseWriter("x", [], c), ValueError),
        (lambda c: clearance.PoseWriter("x", ["a"], c).write([1, 2]), ValueError),
        (lambda c: clearance.PoseWriter("x", ["a"], c).write(None), TypeError),
        (lambda c: clearance.Commands("", c), ValueError),
        (lambda c: clearance.Commands("x", c).send(5), TypeError),
        (lambda c: clearance.Reports(c, old_after_s=-1), ValueError),
        (lambda c: clearance.Reports(c, depth=0), ValueError),
        (lambda c: clearance.Reports(c).next(-1), ValueError),
        (lambda c: clearance.Reports(c).next(float("nan")), ValueError),
        (lambda c: clearance.Reports(c).next("soon"), TypeError),
        (lambda c: clearance.Connection(domain=500), ValueError),
        (lambda c: clearance.Connection(domain=-1), TypeError),
        (lambda c: clearance.Connection(partition="a*"), ValueError),
        (lambda c: clearance.Connection(interface="no such card", domain=8), clearance.DdsError),
        (lambda c: clearance.Connection(5), TypeError),
    ],
)
def test_a_wrong_argument_is_an_exception(connection, call, error):
    with pytest.raises(error):
        call(connection)

"""clearance-plc and a real broker: Debian's mosquitto with TLS and passwords, and its own subscriber."""

import signal
import socket
import subprocess
import uuid

import pytest

from plc_programs import HALL, PERIOD, Hall, Plc, eventually

USER, PASSWORD = "plc", "not in the cell"


def run(*command, **options):
    subprocess.run(list(map(str, command)), check=True, capture_output=True, **options)


def certificates(folder, name):
    """An authority NAME.pem, and a certificate server.pem of it for 127.0.0.1."""
    def key(file):
        run("openssl", "ecparam", "-name", "prime256v1", "-genkey", "-noout", "-out", file, cwd=folder)

    key(name + ".key")
    run("openssl", "req", "-x509", "-new", "-key", name + ".key", "-subj", "/CN=" + name, "-days", "2", "-out", name + ".pem", cwd=folder)
    key("server.key")
    run("openssl", "req", "-new", "-key", "server.key", "-subj", "/CN=127.0.0.1", "-out", "server.csr", cwd=folder)
    (folder / "extensions").write_text("subjectAltName=IP:127.0.0.1\n")
    run("openssl", "x509", "-req", "-in", "server.csr", "-CA", name + ".pem", "-CAkey", name + ".key", "-CAcreateserial",
        "-days", "2", "-extfile", "extensions", "-out", "server.pem", cwd=folder)


class Broker:
    def __init__(self, folder):
        self.folder = folder
        certificates(folder, "other")
        certificates(folder, "ca")
        run("mosquitto_passwd", "-c", "-b", folder / "passwords", USER, PASSWORD)
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        (folder / "mosquitto.conf").write_text(
            f"user root\npersistence false\nallow_anonymous false\npassword_file {folder}/passwords\n"
            f"listener {self.port} 127.0.0.1\ncafile {folder}/ca.pem\ncertfile {folder}/server.pem\nkeyfile {folder}/server.key\n")

    def start(self):
        self.process = subprocess.Popen(["mosquitto", "-c", self.folder / "mosquitto.conf"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

        def answers():
            assert self.process.poll() is None
            try:
                socket.create_connection(("127.0.0.1", self.port), 1).close()
                return True
            except OSError:
                return False

        eventually(answers)

    def kill(self):
        self.process.kill()
        self.process.wait()

    def keys(self, **changed):
        (self.folder / "secret").write_text(PASSWORD + "\n")
        (self.folder / "wrong").write_text("guessed\n")
        keys = {"host": "127.0.0.1", "port": self.port, "topic": "hall/one", "user": USER, "password_file": self.folder / "secret",
                "ca_file": self.folder / "ca.pem", **changed}
        return ", ".join(f"{key}: {value}" for key, value in keys.items())


class Subscriber:
    """Each message as (is retained, topic below hall/one/, payload)."""

    def __init__(self, broker):
        self.file = broker.folder / (uuid.uuid4().hex + ".txt")
        with self.file.open("w") as out:
            self.process = subprocess.Popen(
                ["mosquitto_sub", "-h", "127.0.0.1", "-p", str(broker.port), "--cafile", broker.folder / "ca.pem", "-u", USER, "-P", PASSWORD,
                 "-t", "hall/one/#", "-F", "%r %t %p"], stdout=out, stderr=subprocess.STDOUT)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()

    def messages(self):
        lines = self.file.read_text().split("\n")[:-1]
        return [(line[0] == "1", *line[2:].removeprefix("hall/one/").split(" ")) for line in lines]

    def last(self):
        return {topic: payload for _, topic, payload in self.messages()}

    def is_told(self, zone):
        """The zone is so, by good figures."""
        last = self.last()
        return (last.get("state"), last.get("clear"), last.get("zone/people/clear")) == ("good", zone, zone)


@pytest.fixture(scope="module")
def hall(tmp_path_factory):
    with Hall(tmp_path_factory.mktemp("hall"), HALL) as running:
        running.place(3.3)
        yield running


@pytest.fixture(scope="module")
def broker(tmp_path_factory):
    running = Broker(tmp_path_factory.mktemp("broker"))
    running.start()
    yield running
    running.kill()


def plc_of(hall, broker, **changed):
    cell = hall.folder / (uuid.uuid4().hex + ".yaml")
    cell.write_text(HALL + PERIOD.replace("}", ", mqtt: {" + broker.keys(**changed) + "}}"))
    return Plc(hall, cell=cell)


def test_topics_say_what_the_registers_say_and_only_fail_safe_is_retained(hall, broker):
    with plc_of(hall, broker) as plc, Subscriber(broker) as early:
        hall.place(3.3)
        row = plc.eventually(lambda row: row["clear"] == 1)
        heard = eventually(lambda: early.is_told("clear") and early.last())
        assert heard["least_distance"] == str(row["least_distance"])
        assert heard["zone/people/speed_scaling"] == f"{0.1 * row['zone people: speed_scaling']:.9g}"
        beats = eventually(lambda: (lambda all: all if len(all) > 3 else None)([m[2] for m in early.messages() if m[1] == "heartbeat"]))
        assert len(set(beats)) > 2
        # Whoever comes later hears 'fail-safe' first, and nothing else from the past.
        with Subscriber(broker) as late:
            eventually(lambda: late.is_told("clear"))
            assert [message for message in late.messages() if message[0]] == [(True, "state", "fail-safe")]
            assert late.messages()[0] == (True, "state", "fail-safe")
        hall.place(0.4)
        eventually(lambda: early.is_told("active"))
        assert plc.told("mqtt-connected")
        # A silent daemon: the state changes before any figure.
        hall.place(3.3)
        eventually(lambda: early.is_told("clear"))
        hall.daemon.send_signal(signal.SIGSTOP)
        eventually(lambda: early.last()["least_distance"] == "0")
        assert early.last()["zone/people/clear"] == "active"
        state = None
        for _, topic, payload in early.messages():
            state = payload if topic == "state" else state
            assert not (state == "good" and (topic, payload) == ("least_distance", "0"))
        hall.daemon.send_signal(signal.SIGCONT)


def test_the_last_will_of_a_killed_program_is_fail_safe(hall, broker):
    hall.place(3.3)
    with Subscriber(broker) as subscriber:
        with plc_of(hall, broker) as plc:
            eventually(lambda: subscriber.last().get("state") == "good")
            plc.process.kill()
            eventually(lambda: subscriber.last()["state"] == "fail-safe")
            plc.process.wait()
            plc.process.returncode = 0  # as this test wants it
        with plc_of(hall, broker) as plc:
            eventually(lambda: subscriber.last()["state"] == "good")
            plc.end()
            eventually(lambda: subscriber.last()["state"] == "fail-safe")


@pytest.mark.parametrize("changed", [{"password_file": "wrong"}, {"ca_file": "other.pem"}])
def test_a_wrong_password_or_authority_is_told_and_costs_modbus_nothing(hall, broker, changed):
    hall.place(3.3)
    with plc_of(hall, broker, **{key: broker.folder / name for key, name in changed.items()}) as plc:
        assert plc.told("mqtt-away")
        plc.eventually(lambda row: row["clear"] == 1)


def test_a_broker_that_leaves_and_comes_back_costs_modbus_nothing(hall, broker):
    hall.place(3.3)
    with plc_of(hall, broker) as plc:
        assert plc.told("mqtt-connected")
        broker.kill()
        assert plc.told("mqtt-away")
        plc.eventually(lambda row: row["clear"] == 1)
        broker.start()
        with Subscriber(broker) as subscriber:
            eventually(lambda: subscriber.is_told("clear"))


def test_a_file_that_cannot_be_read_ends_the_program_with_its_name(hall, broker):
    cell = hall.folder / "unreadable.yaml"
    cell.write_text(HALL + PERIOD.replace("}", ", mqtt: {" + broker.keys(password_file="nowhere.secret") + "}}"))
    ended = subprocess.run([*Plc(hall, cell=cell).command, "--port", "0"], capture_output=True, text=True)
    assert ended.returncode == 1 and "password_file" in ended.stderr and "nowhere.secret" in ended.stderr

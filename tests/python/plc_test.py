"""clearance-plc as controllers meet it: Debian's pymodbus reads its registers, and hostile clients try to get in between."""

import random
import re
import signal
import socket
import struct
import threading
import time

import pytest
from pymodbus.client import ModbusTcpClient

from plc_programs import HALL, LIMIT_S, Hall, Plc, eventually

# Of the cell's rows by default, apart from what only counts.
FIGURES = ["clear", "least_distance", "speed_scaling", "stop_margin", "zone people: clear",
           "zone people: speed_scaling", "zone people: stop_margin"]
READ = struct.pack(">HHHBBHH", 7, 0, 6, 1, 4, 3, 1)  # one register, from address 3
MAPPING = """plc:
  period_ms: 200
  order: CDAB
  registers:
    - {value: heartbeat, at: 0}
    - {value: clear, zone: people, at: 20}
    - {value: least_distance, at: 7, type: int32, unit: mm, scale: 0.001}
    - {value: speed_scaling, zone: people, at: 9, type: float32, unit: ratio}
"""


def asked(raw, request, unit=1):
    """The answer to a request that begins with its function."""
    raw.sendall(struct.pack(">HHHB", 7, 0, 1 + len(request), unit) + request)
    answer = raw.recv(512)
    assert answer[:7] == struct.pack(">HHHB", 7, 0, len(answer) - 6, unit)
    return answer[7:]


@pytest.fixture(scope="module")
def hall(tmp_path_factory):
    with Hall(tmp_path_factory.mktemp("hall"), HALL) as running:
        yield running


@pytest.fixture
def plc(hall):
    with Plc(hall) as running:
        yield running


def test_figures_are_those_of_the_spheres_that_stand_there(hall, plc):
    # Radii of 0.2 and 0.1 m. S_p of both at rest: 1.6 (0.1 + 0.25) m for the person's steps, and 0.1 + 0 m.
    for gap_mm in (3000, 350, 2000):
        hall.place(0.3 + 0.001 * gap_mm)
        row = plc.eventually(lambda row: row["good"] == 1 and abs(row["least_distance"] - gap_mm) < 2)
        assert row["least_distance"] in (gap_mm, gap_mm - 1)  # never above the truth
        assert row["cause"] == 0
    row = plc.eventually(lambda row: row["clear"] == 1)
    assert row["speed_scaling"] == row["zone people: speed_scaling"]
    assert row["stop_margin"] == row["zone people: stop_margin"]
    assert 0 < row["stop_margin"] < row["least_distance"]


def test_a_zone_that_is_entered_is_not_clear_in_any_register(hall, plc):
    hall.place(3.3)
    plc.eventually(lambda row: row["clear"] == 1)
    hall.place(0.4)
    row = plc.eventually(lambda row: row["clear"] == 0)
    assert row["zone people: clear"] == 0 and row["good"] == 1


def test_the_table_that_describe_prints_is_what_is_served(hall, plc):
    rows = plc.rows
    assert [rows[name].address for name in ("heartbeat", "good", "cause", "layout", "refused_writes", "misfits")] == list(range(6))
    assert set(FIGURES) <= set(rows)
    assert plc.read()["layout"] == plc.layout != 0
    last = max(row.address for row in rows.values())
    assert f"read addresses 0 to {last}" in plc.description
    assert not plc.client.read_input_registers(last, count=1).isError()
    assert plc.client.read_input_registers(last + 1, count=1).exception_code == 2
    assert plc.client.read_input_registers(last, count=2).exception_code == 2


def test_both_functions_read_the_same_for_any_unit(hall, plc):
    with socket.create_connection(plc.address, LIMIT_S) as raw:
        for unit in (0, 1, 7, 255):
            for function in (3, 4):
                assert asked(raw, struct.pack(">BHH", function, 3, 1), unit) == struct.pack(">BBH", function, 2, plc.layout)


def test_writes_are_refused_and_counted_and_change_nothing(hall, plc):
    before = plc.read()
    client = plc.client
    writes = [
        lambda: client.write_register(11, 7).exception_code,
        lambda: client.write_registers(0, [1, 2, 3]).exception_code,
        lambda: client.write_coil(0, True).exception_code,
        lambda: client.write_coils(0, [True] * 9).exception_code,
        lambda: client.mask_write_register(address=0, and_mask=1, or_mask=2).exception_code,
        # Both read and write; versions of pymodbus differ in the names of its arguments.
        lambda: struct.unpack(">BB", asked(raw, struct.pack(">BHHHHBH", 23, 0, 1, 0, 1, 2, 5)))[1],
    ]
    with socket.create_connection(plc.address, LIMIT_S) as raw:
        for count, write in enumerate(writes, 1):
            assert write() == 1
            plc.eventually(lambda row: row["refused_writes"] == before["refused_writes"] + count)
    assert plc.told("plc-write-refused")
    assert plc.read()["layout"] == before["layout"]
    # What is no write is refused, and not counted as one.
    assert client.read_coils(0, count=1).exception_code == 1
    assert plc.end().count(f"{len(writes)} writes refused") == 1


def test_wrong_numbers_of_registers_are_refused_at_once(hall, plc):
    with socket.create_connection(plc.address, LIMIT_S) as raw:
        for count in (0, 126, 65535):
            raw.sendall(struct.pack(">HHHBBHH", 1, 0, 6, 1, 4, 0, count))
            assert raw.recv(64) == struct.pack(">HHHBBB", 1, 0, 3, 1, 0x84, 3)
        raw.sendall(struct.pack(">HHHBBH", 2, 0, 4, 1, 3, 0))  # a read that ends too early
        assert raw.recv(64) == struct.pack(">HHHBBB", 2, 0, 3, 1, 0x83, 3)


def test_figures_are_fail_safe_when_the_daemon_stops_and_good_when_it_goes_on(hall, plc):
    hall.place(3.3)
    plc.eventually(lambda row: row["clear"] == 1)
    hall.daemon.send_signal(signal.SIGSTOP)
    row = plc.eventually(lambda row: row["good"] == 0)
    assert row["cause"] == 2
    plc.expect_fail_safe(row)
    beat = row["heartbeat"]
    time.sleep(0.3)
    assert plc.read()["heartbeat"] == beat
    hall.daemon.send_signal(signal.SIGCONT)
    hall.place(3.3)
    row = plc.eventually(lambda row: row["good"] == 1 and row["clear"] == 1)
    assert row["heartbeat"] > beat


def test_a_killed_daemon_gives_at_most_what_was_on_its_path(hall, plc):
    hall.place(3.3)
    plc.eventually(lambda row: row["clear"] == 1)
    hall.kill_daemon()
    beat = plc.read()["heartbeat"]
    row = plc.eventually(lambda row: row["good"] == 0)
    # A report that was published before is good for a period.
    assert row["heartbeat"] - beat in (0, 1, 2)
    plc.expect_fail_safe(row)
    hall.start_daemon()
    hall.place(3.3)
    again = plc.eventually(lambda row: row["good"] == 1 and row["clear"] == 1)
    assert again["heartbeat"] > row["heartbeat"]


def test_while_the_program_waits_for_the_daemon_everything_is_fail_safe(hall):
    with Plc(hall, network=[*hall.network[:-1], "plc-alone"]) as alone:
        row = alone.read()
        assert row["cause"] == 1 and row["heartbeat"] == 0
        alone.expect_fail_safe(row)
        assert alone.told("plc-fail-safe")


def test_a_daemon_of_another_cell_makes_nothing_clear(hall, tmp_path):
    cell = tmp_path / "other.yaml"
    cell.write_text(HALL.replace("name: hall", "name: cellar"))
    hall.place(3.3)
    with Plc(hall, cell=cell) as plc:
        row = plc.eventually(lambda row: row["cause"] == 8)
        plc.expect_fail_safe(row)


def test_a_mapping_of_the_cell_is_what_a_controller_decodes(hall, tmp_path):
    cell = tmp_path / "mapped.yaml"
    cell.write_text(HALL + MAPPING)
    hall.place(0.3 + 1.2345)
    with Plc(hall, cell=cell) as plc:
        assert list(plc.rows) == ["heartbeat", "least_distance", "zone people: speed_scaling", "zone people: clear"]

        def decoded():
            hall.send()
            words = plc.client.read_holding_registers(7, count=4).registers
            # The order CDAB: the lower word of each pair is first.
            micrometres, share = struct.unpack(">if", struct.pack(">4H", words[1], words[0], words[3], words[2]))
            # The place that the robot jumped from counts for two periods.
            return (micrometres, share) if abs(micrometres - 1234500) < 10 and share > 0 else None

        micrometres, share = eventually(decoded)
        assert micrometres in (1234499, 1234500) and share <= 1
        assert plc.client.read_holding_registers(6, count=1).registers == [0]  # no row has it
        hall.daemon.send_signal(signal.SIGSTOP)
        lowest = struct.unpack(">HH", struct.pack(">i", -(2**31)))[::-1]
        eventually(lambda: plc.client.read_holding_registers(7, count=4).registers == [*lowest, 0, 0])
        hall.daemon.send_signal(signal.SIGCONT)


def test_a_figure_that_does_not_fit_is_the_safe_end_and_is_told(hall, plc):
    hall.place(70.0)  # more than 65.535 m
    row = plc.eventually(lambda row: row["good"] == 1 and row["misfits"] > 0)
    assert row["least_distance"] == 0 and row["clear"] == 1
    assert plc.told("plc-misfit")
    hall.place(3.3)
    plc.eventually(lambda row: row["least_distance"] in (2999, 3000))


class Hostile:
    """Connections that flood, stall and send rubbish until they are closed here."""

    def __init__(self, address):
        self.address, self.sockets, self.ended = address, [], threading.Event()
        self.threads = [threading.Thread(target=work) for work in (self.flood, self.flood_unread, self.rubbish, self.crowd)]
        for whole in range(8):  # a frame that never ends, cut at each place of its header
            stalled = self.connect()
            stalled.sendall(READ[:whole])

    def __enter__(self):
        for thread in self.threads:
            thread.start()
        return self

    def __exit__(self, *_):
        self.ended.set()
        for thread in self.threads:
            thread.join()
        for each in self.sockets:
            each.close()

    def connect(self):
        self.sockets.append(socket.create_connection(self.address, LIMIT_S))
        self.sockets[-1].settimeout(0.05)
        return self.sockets[-1]

    def again(self, act):
        one = self.connect()
        while not self.ended.is_set():
            try:
                act(one)
            except TimeoutError:
                pass
            except OSError:  # it was dropped
                one.close()
                one = self.connect()

    def flood(self):
        def act(one):
            one.sendall(READ * 200)
            one.recv(65536)
        self.again(act)

    def flood_unread(self):
        self.again(lambda one: one.sendall(READ * 200))

    def rubbish(self):
        chance = random.Random(7)
        self.again(lambda one: one.sendall(chance.randbytes(chance.randint(1, 400))))

    def crowd(self):
        self.again(lambda one: self.connect() if len(self.sockets) < 300 else time.sleep(0.01))


def test_clients_that_flood_stall_crowd_or_send_rubbish_cost_another_one_nothing(hall, plc):
    hall.place(3.3)
    before = plc.eventually(lambda row: row["clear"] == 1)
    beats, connection = {before["heartbeat"]}, plc.client.socket
    with Hostile(plc.address):
        reads = 0

        def read():
            nonlocal reads
            reads += 1
            row = plc.read()
            assert row["layout"] == plc.layout and plc.client.socket is connection
            beats.add(row["heartbeat"])
            return reads >= 300 and len(beats) >= 5

        eventually(read)
    assert plc.told("plc-client-dropped")
    plc.eventually(lambda row: row["good"] == 1)
    # Newcomers find a place as well.
    with ModbusTcpClient(plc.address[0], port=plc.address[1], timeout=LIMIT_S) as newcomer:
        assert newcomer.read_input_registers(3, count=1).registers == [plc.layout]
    assert re.search(r"[1-9][0-9]* clients dropped", plc.end())


def test_a_place_is_free_for_another_host_even_if_one_takes_all(hall, plc):
    plc.client.close()
    busy = [ModbusTcpClient(plc.address[0], port=plc.address[1], timeout=LIMIT_S) for _ in range(16)]
    for client in busy:
        assert client.connect() and not client.read_input_registers(0, count=1).isError()
    with socket.create_connection(plc.address, LIMIT_S, source_address=("127.0.0.2", 0)) as other:
        other.settimeout(LIMIT_S)
        other.sendall(READ)
        assert len(other.recv(64)) == 11
    for client in busy:
        client.close()

#!/usr/bin/python3
"""A controller that reads all registers of clearance-plc by pymodbus. With --kill it ends the daemon in the middle, and says
how soon the figures were fail-safe.

usage: controller.py PORT TABLE [--seconds N] [--kill PID] [--picture FILE.svg]
  PORT          that clearance-plc listens on, of this machine
  TABLE         a file with what `clearance-plc CELL --describe` has printed
  --seconds N   for how long it reads (10)
  --kill PID    send SIGKILL to this process after half of the time
  --picture F   draw least distance, scaling and good over the time, by gnuplot
"""

import argparse
import os
import re
import signal
import struct
import subprocess
import time
import types

from pymodbus.client import ModbusTcpClient

FORMATS = {"uint16": "H", "int16": "h", "uint32": "I", "int32": "i", "float32": "f"}
ROW = re.compile(r" *(\d+)  (u?int16|u?int32|float32) +(?:([\d.e-]+) (mm|m|percent|ratio))? +(-?[\d.e+]+)  (.*?)  ")


def rows_of(table):
    """The rows of a printed table by their names."""
    rows = {}
    for line in table.splitlines():
        if found := ROW.match(line):
            address, kind, scale, unit, safe_end, name = found.groups()
            rows[name.strip()] = types.SimpleNamespace(
                address=int(address), kind=kind, registers=struct.calcsize(FORMATS[kind]) // 2,
                scale=float(scale or 1), unit=unit or "", safe_end=float(safe_end))
    return rows


def layout_of(table):
    return int(re.search(r"layout (\d+)", table)[1])


def period_of(table):
    return float(re.search(r"period ([\d.]+) ms", table)[1])


class Controller:
    """Reads the rows in blocks of at most 100 registers, each of which is of one instant. Bytes are in the order ABCD."""

    def __init__(self, port, rows, timeout_s=5.0, host="127.0.0.1"):
        self.rows = rows
        self.client = ModbusTcpClient(host, port=port, timeout=timeout_s)
        if not self.client.connect():
            raise ConnectionError(f"nothing listens on {host} port {port}")
        ends = {}
        for row in rows.values():
            block = row.address // 100 * 100
            ends[block] = max(ends.get(block, 0), row.address + row.registers)
        self.blocks = sorted(ends.items())

    def read(self, blocks=None):
        """The counts of all rows by their names, or of the rows in the first few blocks."""
        words = {}
        for begin, end in self.blocks[:blocks]:
            answer = self.client.read_input_registers(begin, count=end - begin)
            if answer.isError():
                raise ConnectionError(str(answer))
            words.update(enumerate(answer.registers, begin))
        counts = {}
        for name, row in self.rows.items():
            if row.address not in words:
                continue
            found = [words[row.address + i] for i in range(row.registers)]
            counts[name] = struct.unpack(">" + FORMATS[row.kind], struct.pack(f">{len(found)}H", *found))[0]
        return counts


def text_of(row, count):
    return f"{count * row.scale:.9g} {row.unit}".strip()


def print_table(rows, counts):
    for name, row in rows.items():
        print(f"  {row.address:>5}  {name:<34} {counts[name]:>6}  {text_of(row, counts[name])}")


def watch(controller, seconds, pid):
    """Reads the first block as fast as it can. Returns (time, counts) of each reading, and when the daemon was killed."""
    readings, killed_s, begin_s = [], None, time.monotonic()
    shown_s = begin_s
    while (now_s := time.monotonic()) < begin_s + seconds:
        if pid is not None and killed_s is None and now_s > begin_s + 0.5 * seconds:
            print("controller: the daemon is killed")
            killed_s = time.monotonic()
            os.kill(pid, signal.SIGKILL)
        counts = controller.read(1)
        readings.append((time.monotonic(), counts))
        if now_s >= shown_s:
            shown_s += 1.0
            figures = ", ".join(f"{name} {text_of(controller.rows[name], counts[name])}" for name in counts
                                if name in ("heartbeat", "good", "least_distance", "speed_scaling"))
            print(f"{now_s - begin_s:5.1f} s  {figures}", flush=True)
        time.sleep(0.001)
    return readings, killed_s


def summary(rows, readings, killed_s, last, period_ms):
    print_table(rows, last)
    good = [counts["good"] for _, counts in readings]
    print(f"{len(readings)} readings; good in {sum(good)} of them, {len({c['heartbeat'] for _, c in readings})} heartbeats")
    if killed_s is None:
        return 0
    after = [(at, counts) for at, counts in readings if at > killed_s and not counts["good"]]
    if not after:
        print("controller: THE FIGURES ARE NOT FAIL-SAFE")
        return 1
    first_s = after[0][0]
    print(f"the daemon was killed: figures were fail-safe {1e3 * (first_s - killed_s):.1f} ms later; the period is {period_ms:g} ms")
    unsafe = {name for seen in [last, *(seen for _, seen in after)] for name, count in seen.items()
              if rows[name].address >= 10 and count != rows[name].safe_end}
    print(f"rows that were not at their safe ends from then on: {', '.join(sorted(unsafe)) or 'none'}")
    return 1 if unsafe else 0


def draw(file, rows, readings, killed_s):
    begin_s = readings[0][0]
    named = [name for name in ("least_distance", "speed_scaling", "good") if name in rows]
    lines = "\n".join(f"{at - begin_s:.4f} " + " ".join(str(counts[name] * rows[name].scale) for name in named) for at, counts in readings)
    curves = ", ".join(f"$figures using 1:{i + 2} with steps lw 2 axes x1{'y1' if rows[name].unit == 'mm' else 'y2'} title '{name.replace('_', ' ')} {rows[name].unit}'"
                       for i, name in enumerate(named))
    script = (f"$figures << EOD\n{lines}\nEOD\nset terminal svg size 900,360 background 'white'\nset output '{file}'\nset xlabel 's'\nset ylabel 'mm'\n"
              f"set y2label 'percent, good'\nset y2tics\nset y2range [-5:110]\nset key below\n")
    if killed_s is not None:
        script += f"set arrow from {killed_s - begin_s},graph 0 to {killed_s - begin_s},graph 1 nohead dt 2\n"
    subprocess.run(["gnuplot"], input=script + f"plot {curves}\n", text=True, check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("port", type=int)
    parser.add_argument("table")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--kill", type=int, metavar="PID")
    parser.add_argument("--picture", metavar="FILE.svg")
    arguments = parser.parse_args()
    with open(arguments.table, encoding="utf-8") as file:
        table = file.read()
    controller = Controller(arguments.port, rows_of(table))
    if controller.read()["layout"] != layout_of(table):
        print("controller: the registers are those of another table")
        return 1
    end_s = time.monotonic() + 30.0  # the daemon may still split meshes
    while not controller.read(1)["good"] and time.monotonic() < end_s:
        time.sleep(0.05)
    readings, killed_s = watch(controller, arguments.seconds, arguments.kill)
    print("--- the registers at the end:")
    status = summary(controller.rows, readings, killed_s, controller.read(), period_of(table))
    if arguments.picture:
        draw(arguments.picture, controller.rows, readings, killed_s)
    return status


if __name__ == "__main__":
    raise SystemExit(main())

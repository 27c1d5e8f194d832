#!/usr/bin/python3
"""The emulators of a T7 and an FT300, spoken to by a program of others: Debian's pymodbus.

    modbus_clients_test.py KERF-EMULATE EXAMPLE.calibration.toml
"""

import csv
import re
import socket
import struct
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest
from pathlib import Path

try:
    import serial
    from pymodbus.client import ModbusSerialClient, ModbusTcpClient
    from pymodbus.utilities import computeCRC
except ImportError as missing:
    print(f"{missing.name} is not installed")
    sys.exit(77)

KERF_EMULATE, CALIBRATION = sys.argv[1], Path(sys.argv[2])
ILLEGAL_FUNCTION, DEVICE_FAILURE = 1, 4


class Emulator:
    """Runs until it is stopped; then `truth` has the wrenches that it measured, `taken_ns` when."""

    def __init__(self, device: str):
        self.folder = tempfile.TemporaryDirectory()
        self.trace = Path(self.folder.name) / "trace.csv"
        joint = "&" if "?" in device else "?"
        self.process = subprocess.Popen(
            [KERF_EMULATE, f"{device}{joint}trace={self.trace}"], stderr=subprocess.PIPE, text=True)
        self.said = self.process.stderr.readline()

    def stop(self):
        if self.process.poll() is not None:
            return
        self.process.terminate()
        self.process.communicate()
        with self.trace.open() as lines:
            rows = list(csv.reader(lines))[1:]
        self.taken_ns = [int(row[1]) for row in rows]
        self.truth = [[float(cell) for cell in row[2:8]] for row in rows]
        self.folder.cleanup()


def is_among(truth, wrench, force_n, torque_n_m):
    most = [force_n] * 3 + [torque_n_m] * 3
    return any(all(abs(a - b) <= m for a, b, m in zip(one, wrench, most)) for one in truth)


def halves(kind: str, value) -> list[int]:
    return list(struct.unpack(">HH", struct.pack(f">{kind}", value)))


class T7(unittest.TestCase):
    def setUp(self):
        self.emulator = Emulator("t7?port=0&stream_port=0")
        self.addCleanup(self.emulator.stop)
        port, self.stream_port = map(int, re.findall(r"port (\d+)", self.emulator.said))
        self.client = ModbusTcpClient("127.0.0.1", port=port)
        self.assertTrue(self.client.connect())
        self.addCleanup(self.client.close)
        example = tomllib.loads(CALIBRATION.read_text())
        self.matrix, self.bias = example["matrix"], example["bias"]

    def read(self, kind: str, address: int, count: int = 1):
        answer = self.client.read_input_registers(address, 2 * count)
        self.assertFalse(answer.isError(), answer)
        self.assertEqual(self.client.read_holding_registers(55100, 2).registers, [0x0011, 0x2233])
        return struct.unpack(f">{count}{kind}", struct.pack(f">{2 * count}H", *answer.registers))

    def write(self, kind: str, address: int, value):
        answer = self.client.write_registers(address, halves(kind, value))
        self.assertFalse(answer.isError(), answer)

    def wrench_of(self, volts):
        above = [volt - bias for volt, bias in zip(volts, self.bias)]
        return [sum(a * b for a, b in zip(row, above)) for row in self.matrix]

    def test_says_what_it_is(self):
        self.assertEqual(self.read("I", 55100), (0x00112233,))
        self.assertEqual(self.read("f", 60000), (7.0,))
        self.assertEqual(self.read("I", 60028), (470000001,))

    def test_keeps_what_is_written_by_one_register_or_two(self):
        self.assertFalse(self.client.write_register(55110, 1234).isError())
        self.assertEqual(self.client.read_input_registers(55110, 1).registers, [1234])
        self.write("i", 55122, -1234)
        self.assertEqual(self.read("i", 55122), (-1234,))

    def test_refuses_as_modbus_does(self):
        self.assertEqual(self.client.read_coils(0, 1).exception_code, ILLEGAL_FUNCTION)
        stop = self.client.write_registers(4990, [0, 0])
        self.assertEqual(stop.exception_code, DEVICE_FAILURE, "no stream runs")

    def test_has_the_transducer_at_its_inputs(self):
        pairs = self.read("f", 0, 12)
        self.assertEqual(pairs[1::2], (0.0,) * 6)
        for volt, bias in zip(pairs[::2], self.bias):
            self.assertAlmostEqual(volt, bias, places=6)  # nothing acts before the first stream

    def test_streams_what_acts_and_keeps_the_inputs_for_that(self):
        self.write("I", 61810, 0x3C4000)
        positive, negative, centre = self.read("f", 61812, 3)
        order = [10, 8, 6, 4, 2, 0]
        for address, value in {4004: 6, 4006: 6, 4016: 1}.items():
            self.write("I", address, value)
        for i, channel in enumerate(order):
            self.write("I", 4100 + 2 * i, 2 * channel)
        self.write("f", 4002, 1000.0)
        with socket.create_connection(("127.0.0.1", self.stream_port), timeout=10) as stream:
            self.write("I", 4990, 1)
            packets = b""
            while len(packets) < 28 * 200:
                packets += stream.recv(4096)
            self.assertEqual(self.client.read_input_registers(0, 2).exception_code, DEVICE_FAILURE)
            self.assertEqual(self.client.write_registers(4990, [0, 1]).exception_code, DEVICE_FAILURE)
            self.write("I", 4990, 0)
        acting = self.wrench_of(self.read("f", 0, 12)[::2])
        self.assertTrue(all(abs(one) < most for one, most in zip(acting, [8.001] * 3 + [0.4001] * 3)), acting)
        self.assertTrue(any(abs(one) > 0.01 for one in acting), "the world goes on without a stream")
        self.emulator.stop()
        for scan in range(200):
            packet = struct.unpack_from(">HHHBBHHHH6H", packets, 28 * scan)
            self.assertEqual(packet[:6], (scan + 1, 0, 22, 1, 76, 16))
            volts = [0.0] * 6
            for channel, code in zip(order, packet[9:]):
                volts[channel // 2] = (code - centre) * (positive if code > centre else -negative)
            # Half a code of 0.32 mV on each input, through the rows of the example's matrix.
            self.assertTrue(is_among(self.emulator.truth, self.wrench_of(volts), 2.2e-3, 3.6e-5), (scan, volts))


class Ft300(unittest.TestCase):
    def setUp(self):
        self.emulator = Emulator("ft300")
        self.addCleanup(self.emulator.stop)
        self.path = self.emulator.said.split()[-1]
        self.client = ModbusSerialClient(self.path, baudrate=19200, timeout=2)
        self.assertTrue(self.client.connect())
        self.addCleanup(self.client.close)

    def read(self, address: int, count: int) -> bytes:
        answer = self.client.read_holding_registers(address, count, slave=9)
        self.assertFalse(answer.isError(), answer)
        return struct.pack(f">{count}H", *answer.registers)

    def wrench(self, bytes_: bytes, order: str):
        counts = struct.unpack(order + "6h", bytes_)
        return [count / (100.0 if i < 3 else 1000.0) for i, count in enumerate(counts)]

    def test_says_what_it_is(self):
        self.assertTrue(self.read(500, 4).startswith(b"F"))
        self.assertEqual(self.read(510, 4), b"EMU00001")
        self.assertGreater(struct.unpack(">H", self.read(514, 1))[0], 2000)
        self.assertEqual(self.client.read_coils(0, 1, slave=9).exception_code, ILLEGAL_FUNCTION)

    def test_tells_what_acts_where_it_is_asked_and_where_it_streams(self):
        told = [self.wrench(self.read(180, 6), ">") for _ in range(10)]
        self.assertFalse(self.client.write_registers(410, [0x0200], slave=9).isError())
        self.client.close()
        with serial.Serial(self.path, 19200, timeout=5) as line:
            line.read_until(b"\x20\x4e")
            line.read(14)
            for _ in range(10):
                frame = line.read(16)
                self.assertEqual(frame[:2], b"\x20\x4e")
                self.assertEqual(computeCRC(frame[:14]), struct.unpack(">H", frame[14:])[0])
                told.append(self.wrench(frame[2:14], "<"))
            line.write(b"\xff" * 50)  # and closed at once, as clients do
        closed_ns = time.monotonic_ns()
        time.sleep(0.5)
        opened_ns = time.monotonic_ns()
        self.client.connect()
        told.append(self.wrench(self.read(180, 6), ">"))
        self.assertTrue(any(abs(one) > 0.1 for one in told[0] + told[-1]))
        self.emulator.stop()
        after = [taken for taken in self.emulator.taken_ns if closed_ns < taken < opened_ns]
        self.assertLess(len(after), 10, "of the 50 frames that there would be, had it not stopped")
        for wrench in told:
            self.assertTrue(is_among(self.emulator.truth, wrench, 0.0051, 0.00051), wrench)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

# SPDX-License-Identifier: MIT
"""adapters/ros_to_csv.py on bags that the test writes itself, and `tribench loop` on what comes out."""
import math
import os
import pathlib
import sqlite3
import struct
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "adapters" / "ros_to_csv.py"
PROGRAM = os.environ.get("TRIBENCH_PROGRAM", "")
START = 1_750_000_000_000_000_000


def cdr_message(stamp, names, columns, order="<"):
    """sensor_msgs/JointState as CDR writes it."""
    data = b""

    def put(kind, *values):
        nonlocal data
        size = struct.calcsize(kind)
        data += b"\0" * (-len(data) % size)
        data += struct.pack(f"{order}{len(values)}{kind}", *values)

    def put_text(text):
        nonlocal data
        put("I", len(text) + 1)
        data += text.encode() + b"\0"

    put("i", stamp // 10**9)
    put("I", stamp % 10**9)
    put_text("base_link")
    put("I", len(names))
    for name in names:
        put_text(name)
    for column in columns:
        put("I", len(column))
        if column:
            put("d", *column)
    return (b"\0\1\0\0" if order == "<" else b"\0\0\0\0") + data


def samples(order="<", effort=True):
    for i in range(400):
        t = 0.01 * i
        stamp = START + 10_000_000 * i
        positions, speeds = [math.sin(t), 0.5], [math.cos(t), 0.25 * t]
        names = ["shoulder_pan", "elbow"]
        if i % 2 == 1:  # the order may change from message to message
            names, positions, speeds = names[::-1], positions[::-1], speeds[::-1]
        torques = [3 * math.cos(t) if name == "shoulder_pan" else 1.0 for name in names]
        yield stamp, cdr_message(stamp, names, [positions, speeds, torques if effort else []],
                                 order)


def text(value):
    return struct.pack("<I", len(value)) + value.encode()


def record(code, content):
    return struct.pack("<BQ", code, len(content)) + content


def write_mcap(file, messages, chunked):
    body = record(0x03, struct.pack("<H", 1) + text("sensor_msgs/msg/JointState") +
                  text("ros2msg") + struct.pack("<I", 0))
    body += record(0x04, struct.pack("<HH", 7, 1) + text("/joint_states") + text("cdr") +
                   struct.pack("<I", 0))
    for number, (stamp, data) in enumerate(messages):
        body += record(0x05, struct.pack("<HIQQ", 7, number, stamp, stamp) + data)
    if chunked:
        body = record(0x06, struct.pack("<QQQI", 0, 0, len(body), 0) + text("") +
                      struct.pack("<Q", len(body)) + body)
    magic = b"\x89MCAP0\r\n"
    header = record(0x01, text("ros2") + text("test"))
    file.write_bytes(magic + header + body + record(0x0F, b"\0" * 4) + record(0x02, b"\0" * 20) +
                     magic)


def write_sqlite(file, messages):
    database = sqlite3.connect(file)
    database.execute("CREATE TABLE topics(id INTEGER, name TEXT, type TEXT,"
                     " serialization_format TEXT)")
    database.execute("CREATE TABLE messages(id INTEGER, topic_id INTEGER, timestamp INTEGER,"
                     " data BLOB)")
    database.execute("INSERT INTO topics VALUES(1, '/joint_states', 'sensor_msgs/msg/JointState',"
                     " 'cdr')")
    database.execute("INSERT INTO topics VALUES(2, '/rosout', 'rcl_interfaces/msg/Log', 'cdr')")
    database.execute("INSERT INTO messages VALUES(0, 2, 0, x'00')")
    for number, (stamp, data) in enumerate(messages):
        database.execute("INSERT INTO messages VALUES(?, 1, ?, ?)", (number + 1, stamp, data))
    database.commit()
    database.close()


class RosToCsv(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def convert(self, bag, *options, status=0):
        run = subprocess.run([sys.executable, SCRIPT, bag, *options], capture_output=True,
                             text=True, check=False)
        self.assertEqual(run.returncode, status, run.stderr)
        return run.stdout if status == 0 else run.stderr

    def check_rows(self, csv):
        lines = csv.splitlines()
        self.assertEqual(lines[1], "stamp [ns],position [rad],velocity [rad/s],torque [N m],"
                                   "other_velocity [rad/s]")
        self.assertEqual(len(lines), 402)
        for i, line in enumerate(lines[2:]):
            stamp, q, v, tau, other = line.split(",")
            self.assertEqual(int(stamp), START + 10_000_000 * i)
            self.assertEqual((float(q), float(v), float(tau), float(other)),
                             (math.sin(0.01 * i), math.cos(0.01 * i), 3 * math.cos(0.01 * i),
                              0.25 * 0.01 * i))

    def test_every_format_gives_the_same_rows(self):
        write_mcap(self.folder / "plain.mcap", samples(), chunked=False)
        write_mcap(self.folder / "chunked.mcap", samples(">"), chunked=True)
        write_sqlite(self.folder / "bag.db3", samples())
        for name in ("plain.mcap", "chunked.mcap", "bag.db3"):
            with self.subTest(name):
                self.check_rows(self.convert(self.folder / name, "--joint", "shoulder_pan"))

    def test_a_folder_of_pieces_is_one_recording(self):
        rows = list(samples())
        bag = self.folder / "bag"
        bag.mkdir()
        write_mcap(bag / "bag_0.mcap", rows[:150], chunked=True)
        write_mcap(bag / "bag_1.mcap", rows[150:], chunked=True)
        self.check_rows(self.convert(bag, "--joint", "shoulder_pan"))

    def test_what_is_not_recorded_is_no_column(self):
        write_mcap(self.folder / "a.mcap", samples(effort=False), chunked=True)
        csv = self.convert(self.folder / "a.mcap", "--joint", "elbow", "--slide")
        self.assertEqual(csv.splitlines()[1],
                         "stamp [ns],position [m],velocity [m/s],other_velocity [rad/s]")

    def test_bad_input_names_the_mend(self):
        write_mcap(self.folder / "a.mcap", samples(), chunked=True)
        write_sqlite(self.folder / "d.db3", samples())
        (self.folder / "b.mcap").write_bytes(b"no bag")
        (self.folder / "c.db3").write_bytes(b"no bag" * 1000)
        for name, options, said in (
            ("a.mcap", [], "--joint shoulder_pan | elbow"),
            ("a.mcap", ["--joint", "wrist"], "no joint 'wrist'"),
            ("a.mcap", ["--topic", "/other", "--joint", "elbow"], "/joint_states"),
            ("d.db3", ["--topic", "/rosout"], "no joint states in /rosout"),
            ("b.mcap", [], "no MCAP file"),
            ("c.db3", [], "no ROS 2 bag"),
            ("missing.mcap", [], "does not exist"),
        ):
            with self.subTest(name=name, options=options):
                self.assertIn(said, self.convert(self.folder / name, *options, status=2))

    def test_the_program_reads_what_comes_out(self):
        if not PROGRAM:
            self.skipTest("no program")
        write_mcap(self.folder / "a.mcap", samples(), chunked=True)
        file = self.folder / "log.csv"
        self.convert(self.folder / "a.mcap", "--joint", "shoulder_pan", "-o", file)
        run = subprocess.run([PROGRAM, "loop", file, "--explain"], capture_output=True, text=True,
                             check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("400 rows", run.stdout)
        self.assertIn("since 1970", run.stdout)


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Joint states of a ROS 2 bag as CSV for `tribench loop`: MCAP or SQLite, no ROS needed.

    ros_to_csv.py BAG [--topic /joint_states] [--joint elbow] [--slide] [--effort A] [-o log.csv]

BAG is a .mcap or .db3 file, or the folder that `ros2 bag record` wrote. Of several joints --joint
names one; its neighbour in the message (the one before it, else the one after) gives the column
`other_velocity`. Units are those of sensor_msgs/JointState: rad, rad/s, N m, with --slide m, m/s, N;
drivers that put a current into `effort` are told by --effort A. The stamp is the header's, in
nanoseconds; where a driver leaves it at 0, the time at which the message was recorded.

Formats: mcap.dev/spec; rosbag2's SQLite schema; CDR (OMG DDS-XTypes, plain, both byte orders).
Chunks compressed with zstd or lz4 need the program `zstd` or `lz4` (Debian packages of that name).
Exit status: 0 done, 2 bad input.
"""
import argparse
import contextlib
import math
import pathlib
import sqlite3
import struct
import subprocess
import sys

JOINT_STATE = ("sensor_msgs/msg/JointState", "sensor_msgs/JointState")
MCAP_MAGIC = b"\x89MCAP0\r\n"
SCHEMA, CHANNEL, MESSAGE, CHUNK = 0x03, 0x04, 0x05, 0x06


class BadInput(Exception):
    """Something that the user can mend."""


class Cdr:
    """Reads one serialized message from its begin."""

    def __init__(self, data):
        if len(data) < 4 or data[0] != 0 or data[1] not in (0, 1):
            raise BadInput("a message is not in plain CDR")
        self.data, self.at = data, 4
        self.order = "<" if data[1] == 1 else ">"

    def numbers(self, kind, size, count=1):
        self.at += (4 - self.at) % size  # aligned from the end of the first four bytes
        if self.at + count * size > len(self.data):
            raise BadInput("a message ends too early")
        values = struct.unpack_from(f"{self.order}{count}{kind}", self.data, self.at)
        self.at += count * size
        return values

    def text(self):
        (length,) = self.numbers("I", 4)
        value = self.data[self.at : self.at + length]
        self.at += length
        return value.rstrip(b"\0").decode("utf-8", "replace")

    def texts(self):
        (count,) = self.numbers("I", 4)
        return [self.text() for _ in range(count)]

    def doubles(self):
        (count,) = self.numbers("I", 4)
        return self.numbers("d", 8, count) if count > 0 else ()


def joint_state(data):
    """Stamp in ns, and by joint its position, velocity and effort (None where there is none)."""
    cdr = Cdr(data)
    seconds, nanoseconds = *cdr.numbers("i", 4), *cdr.numbers("I", 4)
    cdr.text()  # the frame
    names = cdr.texts()
    columns = [cdr.doubles() for _ in range(3)]
    joints = {
        name: tuple(column[i] if i < len(column) else None for column in columns)
        for i, name in enumerate(names)
    }
    return seconds * 10**9 + nanoseconds, joints


def decompressed(kind, data):
    if kind == "":
        return data
    if kind not in ("zstd", "lz4"):
        raise BadInput(f"chunks are compressed with '{kind}', which is not known")
    try:
        return subprocess.run([kind, "-dc"], input=data, capture_output=True, check=True).stdout
    except FileNotFoundError:
        raise BadInput(f"chunks are compressed with {kind}: install the program `{kind}`") from None
    except subprocess.CalledProcessError as error:
        raise BadInput(f"a chunk is broken: {error.stderr.decode(errors='replace')}") from None


class McapFields:
    """Fields of an MCAP record, in order."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def number(self, kind):
        (value,) = struct.unpack_from("<" + kind, self.data, self.at)
        self.at += struct.calcsize(kind)
        return value

    def bytes(self, kind):
        length = self.number(kind)
        self.at += length
        return self.data[self.at - length : self.at]

    def text(self):
        return self.bytes("I").decode("utf-8", "replace")


def mcap_records(data):
    at = 0
    while at + 9 <= len(data):
        code, length = data[at], struct.unpack_from("<Q", data, at + 1)[0]
        if at + 9 + length > len(data):
            return  # cut off while it was written: what is whole is taken
        yield code, data[at + 9 : at + 9 + length]
        at += 9 + length


def mcap_messages(file):
    """(topic, type, recorded at in ns, data) of all messages."""
    data = file.read_bytes()
    if not data.startswith(MCAP_MAGIC):
        raise BadInput(f"{file} is no MCAP file")
    schemas, channels = {}, {}

    def read(records):
        for code, content in mcap_records(records):
            fields = McapFields(content)
            if code == SCHEMA:
                number = fields.number("H")
                schemas[number] = fields.text()
            elif code == CHANNEL:
                number, schema = fields.number("H"), fields.number("H")
                channels[number] = (fields.text(), schemas.get(schema, ""))
            elif code == MESSAGE:
                number = fields.number("H")
                fields.number("I")
                logged = fields.number("Q")
                fields.number("Q")
                topic, kind = channels.get(number, ("", ""))
                yield topic, kind, logged, content[fields.at :]
            elif code == CHUNK:
                for kind in "QQQI":
                    fields.number(kind)
                compression = fields.text()
                yield from read(decompressed(compression, fields.bytes("Q")))

    yield from read(data[len(MCAP_MAGIC) :])


def sqlite_messages(file):
    with contextlib.closing(sqlite3.connect(f"file:{file}?mode=ro", uri=True)) as database:
        try:
            yield from database.execute(
                "SELECT topics.name, topics.type, messages.timestamp, messages.data FROM messages"
                " JOIN topics ON topics.id = messages.topic_id ORDER BY messages.timestamp"
            )
        except sqlite3.DatabaseError as error:
            raise BadInput(f"{file} is no ROS 2 bag: {error}") from None


def bag_files(bag):
    bag = pathlib.Path(bag)
    if not bag.exists():
        raise BadInput(f"{bag} does not exist")
    files = [bag] if bag.is_file() else sorted(bag.glob("*.mcap")) + sorted(bag.glob("*.db3"))
    if not files:
        raise BadInput(f"{bag} holds no .mcap or .db3 file; decompress others (unzstd FILE.zstd)")
    return files


def joint_states(bag, topic):
    """(stamp, joints) of the topic's messages; of any topic of joint states where it is None."""
    seen, chosen, is_there = set(), topic, False
    for file in bag_files(bag):
        messages = mcap_messages(file) if file.suffix == ".mcap" else sqlite_messages(file)
        for name, kind, recorded, data in messages:
            seen.add(f"{name} ({kind})")
            if kind not in JOINT_STATE or (chosen is not None and name != chosen):
                if kind in JOINT_STATE and topic is None:
                    raise BadInput(f"several topics have joint states: --topic {chosen} or {name}")
                continue
            chosen, is_there = name, True
            stamp, joints = joint_state(data)
            yield (stamp if stamp > 0 else recorded), joints
    if not is_there:
        where = "" if topic is None else f" in {topic}"
        raise BadInput(f"there are no joint states{where}; topics: {', '.join(sorted(seen)) or 'none'}")


def chosen_joint(names, wanted):
    if wanted is None and len(names) == 1:
        return names[0]
    if wanted not in names:
        what = "several joints" if wanted is None else f"no joint '{wanted}'"
        raise BadInput(f"there is {what}: --joint {' | '.join(names)}")
    return wanted


def cell(value):
    return "" if value is None or not math.isfinite(value) else repr(value)


def convert(bag, topic, joint, slide, effort, out):
    position, per_second = ("m", "m/s") if slide else ("rad", "rad/s")
    effort = effort or ("N" if slide else "N m")
    effort_name = "current" if effort in ("A", "mA") else "torque"
    rows, names, other = [], [], None
    for stamp, joints in joint_states(bag, topic):
        if not names:
            names = list(joints)
            joint = chosen_joint(names, joint)
            at = names.index(joint)
            other = names[at - 1] if at > 0 else names[1] if len(names) > 1 else None
        if joint in joints:  # messages may tell of some joints only
            rows.append((stamp, *joints[joint], joints.get(other, (None,) * 3)[1]))
    headers = [f"position [{position}]", f"velocity [{per_second}]", f"{effort_name} [{effort}]",
               "other_velocity [rad/s]"]
    told = [k for k in range(4) if any(row[k + 1] is not None for row in rows)]
    out.write(f"# joint {joint} of {bag}\n")
    out.write(",".join(["stamp [ns]"] + [headers[k] for k in told]) + "\n")
    for row in rows:
        out.write(",".join([str(row[0])] + [cell(row[k + 1]) for k in told]) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bag", help=".mcap, .db3 or the bag's folder")
    parser.add_argument("--topic", help="of several with joint states")
    parser.add_argument("--joint", help="name in the messages, of several")
    parser.add_argument("--slide", action="store_true", help="a prismatic joint: m, m/s, N")
    parser.add_argument("--effort", choices=["N m", "N", "A", "mA"], help="unit of the effort")
    parser.add_argument("-o", "--out", help="file; without it standard output")
    arguments = parser.parse_args()
    try:
        with contextlib.ExitStack() as stack:
            out = sys.stdout
            if arguments.out:
                out = stack.enter_context(open(arguments.out, "w", encoding="utf-8"))
            convert(arguments.bag, arguments.topic, arguments.joint, arguments.slide,
                    arguments.effort, out)
    except BadInput as error:
        print(f"ros_to_csv: {error}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()

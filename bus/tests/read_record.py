"""Reads a record of Shoal with Python's `mcap`, every checksum verified and every JSON message held against its schema, and prints
what it found as one JSON line.

    pip install mcap zstandard jsonschema && python3 read_record.py run.mcap
"""

import json
import struct
import sys

from jsonschema import Draft202012Validator
from mcap.reader import NonSeekingReader, SeekingReader


def told(data):
    """The rows of one `shoal.Sensed/1` message: (true time, AUV, tick, local time, events)."""
    place = 0

    def take(layout):
        nonlocal place
        values = struct.unpack_from("<" + layout, data, place)
        place += struct.calcsize("<" + layout)
        return values[0] if len(values) == 1 else values

    assert take("H") == 1
    rows = []
    for _ in range(take("Q")):
        at, auv, tick, local, count = take("qIQqQ")
        events = []
        for _ in range(count):
            stamp, kind = take("qI")
            if kind == 4:
                fields = bytes(take(f"{take('Q')}s"))
            elif kind == 6:
                fields = [take("I2d"), take("2d") if take("B") else None, take("2d")]
            else:
                fields = take(("6d", "6d", "2d", "8d", "", "")[kind])
            events.append((stamp, kind, fields))
        rows.append((at, auv, tick, local, events))
    assert place == len(data)
    return rows


def born(data):
    """How many AUVs one `shoal.Born/1` message tells of, and number and name of the first."""
    version, count, auv, _group, length = struct.unpack_from("<HQIHQ", data)
    assert version == 1
    start = struct.calcsize("<HQIHQ")
    return count, auv, data[start : start + length].decode()


# What Foxglove's own schemas need (https://docs.foxglove.dev/docs/sdk/schemas).
NEEDED = {
    "/truth": {"timestamp", "frame_id", "poses"},
    "/log": {"timestamp", "level", "message", "name", "file", "line"},
}


def closed(schema):
    """The schema without a place for what it does not name."""
    if isinstance(schema, list):
        return [closed(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    schema = {key: closed(part) for key, part in schema.items()}
    return {**schema, "additionalProperties": False} if "properties" in schema else schema


def read(reader):
    """Messages of each topic, and what they sum up to."""
    topics, found = {}, {"ticks": 0, "reports": 0, "pings": 0, "told": 0, "heard_bytes": 0}
    validators, names = {}, []
    for schema, channel, message in reader.iter_messages(log_time_order=False):
        topics[channel.topic] = topics.get(channel.topic, 0) + 1
        if channel.topic == "/born":
            assert born(message.data) == (len(names), 0, names[0])
            continue
        if channel.message_encoding == "application/x-shoal-bincode":
            rows = told(message.data)
            found["told"] += len(rows)
            found["heard_bytes"] += sum(len(fields) for row in rows for _, kind, fields in row[4] if kind == 4)
            continue
        content = json.loads(message.data)
        if channel.topic not in validators:
            validators[channel.topic] = Draft202012Validator(closed(json.loads(schema.data)))
        for error in validators[channel.topic].iter_errors(content):
            raise AssertionError(f"{channel.topic} {error.json_path}: {error.message}")
        assert NEEDED.get(channel.topic, set()) <= content.keys(), f"{channel.topic}: {content.keys()}"
        if channel.topic == "/auvs":
            names = [told["name"] for told in content["auvs"]]
        if channel.topic == "/truth":
            assert content["frame_id"] == "water" and len(content["poses"]) <= len(names)
            lengths = [sum(part * part for part in pose["orientation"].values()) for pose in content["poses"]]
            assert all(abs(length - 1) < 1e-5 for length in lengths)
            assert all({"x", "y", "z"} == pose["position"].keys() for pose in content["poses"])
        rows = channel.topic.removeprefix("/")
        if rows in ("ticks", "reports", "pings"):
            found[rows] += len(content[rows])
    return topics, found


def main(path):
    with open(path, "rb") as file:
        reader = SeekingReader(file, validate_crcs=True)
        topics, found = read(reader)
        metadata = {record.name: record.metadata for record in reader.iter_metadata()}
        attached = {record.name: record.data.decode() for record in reader.iter_attachments()}
        counts = reader.get_summary().statistics.channel_message_counts
        names = {channel.id: channel.topic for channel in reader.get_summary().channels.values()}
    assert {names[channel]: count for channel, count in counts.items()} == topics
    with open(path, "rb") as file:
        assert read(NonSeekingReader(file, validate_crcs=True)) == (topics, found)
    print(json.dumps({"topics": topics, **found, "metadata": metadata, "attached": attached}))


main(sys.argv[1])

"""Reads a record of Shoal with Python's `mcap`, every checksum verified, and prints what it found as one JSON line.

    pip install mcap && python3 read_record.py run.mcap
"""

import json
import struct
import sys

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
            else:
                fields = take(("6d", "6d", "2d", "8d", "", "")[kind])
            events.append((stamp, kind, fields))
        rows.append((at, auv, tick, local, events))
    assert place == len(data)
    return rows


def read(reader):
    """Messages of each topic, and what they sum up to."""
    topics, found = {}, {"ticks": 0, "reports": 0, "pings": 0, "told": 0, "heard_bytes": 0}
    for schema, channel, message in reader.iter_messages(log_time_order=False):
        topics[channel.topic] = topics.get(channel.topic, 0) + 1
        if channel.topic == "/born":
            continue
        if channel.message_encoding == "application/x-shoal-bincode":
            rows = told(message.data)
            found["told"] += len(rows)
            found["heard_bytes"] += sum(len(fields) for row in rows for _, kind, fields in row[4] if kind == 4)
            continue
        content = json.loads(message.data)
        described = json.loads(schema.data)
        missing = [key for key in described.get("required", []) if key not in content]
        unknown = [key for key in content if key not in described["properties"]]
        assert not missing and not unknown, (channel.topic, missing, unknown)
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

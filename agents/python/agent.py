#!/usr/bin/env python3
"""An AUV's mind in Python: it encloses where and when it is, visits its waypoints, and pings.

`shoal run polyglot.toml` starts it: the group has `command = ["python3", "agent.py"]`. It needs `eclipse-zenoh`
(`pip install -r requirements.txt`).

    link.py       the protocol, over zenoh
    frame.py      the bytes of a ping
    interval.py   arithmetic that rounds outwards
    enclosure.py  where and when the AUV is, as a set
"""

import math

import frame
from enclosure import Enclosure
from link import Link


class Agent:
    """One AUV. `born` and `sensed` are as documented in `shoal_bus::protocol`, and so is what `step` returns."""

    def __init__(self, born):
        self.born, self.enclosure = born, Enclosure(born)
        self.route = born["orders"]["controller"]["Waypoints"]
        self.waypoints = self.route["points_m"]
        self.schedule = born["orders"]["access"]["Periodic"]
        self.next_ping, self.sequence = self.schedule["first"], 0

    def step(self, sensed):
        """Takes in one tick and answers it."""
        events = [(event["stamp"], event["sense"]) for event in sensed["events"] if event["sense"] != "Held"]
        inertial = next(sense["Inertial"] for _, sense in events if "Inertial" in sense)
        on_the_way = self.enclosure.move(sensed["stamp"], inertial)
        for stamp, sense in events:
            match sense:
                case {"Depth": depth}:
                    self.enclosure.depth(depth["depth_m"])
                case {"Gnss": fix}:
                    self.enclosure.fix(stamp, fix["position_m"], fix["time_s"])
                case {"Heard": heard}:
                    # Bytes that are no ping say nothing.
                    if ping := frame.decode(bytes.fromhex(heard["frame"])):
                        self.enclosure.ping(stamp, ping)
        now = self.enclosure.position_m, self.enclosure.offset_s
        return {
            "tick": sensed["tick"],
            "setpoint": {"velocity_m_s": self.steer()},
            "pings": [{"at": at, "frame": self.payload(at).hex()} for at in self.due()],
            "report": self.told(*now) | {"slice": self.told(*on_the_way)},
        }

    def told(self, position_m, offset_s):
        # Clock offsets are compared against stamps, which may be off by their tolerance.
        offset_s = offset_s.widened(self.enclosure.stamp_s)
        return {"position_m": [side._asdict() for side in position_m], "clock_offset_s": offset_s._asdict()}

    def due(self):
        """Local times of the pings that this tick is the last to book."""
        wake = self.born["wake"]
        earliest = self.enclosure.stamp + wake["reaction_ns"]
        while self.next_ping < earliest + wake["period_ns"]:
            if self.next_ping >= earliest:
                yield self.next_ping
            self.next_ping += self.schedule["period_ns"]

    def payload(self, at):
        """What a ping says that leaves at this local time."""
        self.sequence += 1
        return frame.encode(frame.Ping(self.born["auv"], self.sequence, *self.enclosure.at(at)))

    def steer(self):
        """The velocity through the water that leads to the next waypoint."""
        gap_m, length_m = self.gap()
        if length_m <= self.route["reach_m"]:
            self.waypoints = self.waypoints[1:] + self.waypoints[:1]
            gap_m, length_m = self.gap()
        pace = self.route["speed_m_s"] / (length_m or 1.0)
        return [pace * gap - drift.mid for gap, drift in zip(gap_m, self.enclosure.drift_m_s)]

    def gap(self):
        """From the middle of the box to the next waypoint, and how far that is."""
        gap_m = [target - side.mid for target, side in zip(self.waypoints[0], self.enclosure.position_m)]
        x, y, z = gap_m
        return gap_m, math.sqrt(x * x + y * y + z * z)


if __name__ == "__main__":
    Link().live(Agent)

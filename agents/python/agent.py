#!/usr/bin/env python3
"""An AUV's mind in Python: it encloses where and when it is, visits its waypoints, and pings.

`shoal run` starts it for each AUV of a `[[group]]` with `command = ["python3", "agent.py"]`. It needs `eclipse-zenoh`.
"""

import math

from frame import Ping, decode, encode
from interval import Interval, above, contract_by_distance, cos_sin
from link import Link


class Agent:
    def __init__(self, born):
        self.born, orders, clock, body = born, born["orders"], born["clock"], born["body"]
        self.stamp = born["birth"]
        self.stamp_s = 1e-9 * clock["stamp_ns"]
        # True time less local time, and position: the state. It holds the truth, always.
        self.offset_s = Interval.of(clock["offset_s"])
        self.position_m = [Interval.of(side) for side in born["prior_position_m"]]
        # What the own clock gains on true time per local second, the other way round: dt/ds - 1.
        drift, one = Interval(-clock["drift"], clock["drift"]), Interval(1.0, 1.0)
        self.gain = one / (one + drift) - one
        self.fastest = above(1 + self.gain.upper)
        # What water and noise add to the velocity through the water, in m/s.
        sides = zip(body["current_m_s"], body["disturbance_m_s"])
        self.drift_m_s = [Interval.of(current) + Interval.of(noise) for current, noise in sides]
        self.speed_m_s = Interval(-body["speed_m_s"], body["speed_m_s"])
        self.velocity_m_s = None
        self.sequence = 0
        self.next_ping = orders["access"]["Periodic"]["first"]
        self.waypoints = orders["controller"]["Waypoints"]["points_m"]

    def elapsed_s(self, ns):
        """Local seconds between two stamps that are so many nanoseconds apart."""
        return Interval.around(1e-9 * ns, 2 * self.stamp_s + 1e-15 * abs(ns) * 1e-9)

    def ahead(self, length_s, reached_m_s):
        """Displacement and gain of the clock over so much local time, at velocities through the water in this box."""
        true_s = length_s * (self.gain + Interval(1.0, 1.0))
        moved_m = [(v + drift) * true_s for v, drift in zip(reached_m_s, self.drift_m_s)]
        return moved_m, self.gain * length_s

    def near(self, velocity_m_s, length_s):
        """Velocities through the water within so much local time of a moment with this one."""
        change_m_s = above(self.born["body"]["acceleration_m_s2"] * above(length_s.upper * self.fastest))
        return [v.widened(change_m_s) & self.speed_m_s for v in velocity_m_s]

    def step(self, sensed):
        """Takes in one tick and answers it."""
        senses = [(event["stamp"], event["sense"]) for event in sensed["events"] if event["sense"] != "Held"]
        inertial = next(sense["Inertial"] for _, sense in senses if "Inertial" in sense)
        slice_m, slice_s = self.move(sensed["stamp"], inertial)
        for stamp, sense in senses:
            if "Depth" in sense:
                depth = sense["Depth"]["depth_m"]
                self.position_m[2] &= -Interval.around(depth["value"], depth["error"])
            elif "Gnss" in sense:
                fix = sense["Gnss"]
                self.position_m = [p & Interval.of(side) for p, side in zip(self.position_m, fix["position_m"])]
                self.offset_s &= Interval.of(fix["time_s"]) - self.local_s(stamp)
            elif "Heard" in sense and (ping := decode(bytes.fromhex(sense["Heard"]["frame"]))):
                self.hear(ping, stamp)
        report = {
            "position_m": [side._asdict() for side in self.position_m],
            # A stamp may be off by its tolerance, and so may what is told against it.
            "clock_offset_s": self.offset_s.widened(self.stamp_s)._asdict(),
            "slice": {
                "position_m": [side._asdict() for side in slice_m],
                "clock_offset_s": slice_s.widened(self.stamp_s)._asdict(),
            },
        }
        setpoint = {"velocity_m_s": self.steer()}
        return {"tick": sensed["tick"], "setpoint": setpoint, "pings": self.pings(), "report": report}

    def move(self, stamp, inertial):
        """Carries the state on to the tick, and returns what holds it on the way there."""
        heading, pitch, speed = (
            Interval.around(inertial[name]["value"], inertial[name]["error"])
            for name in ("heading_rad", "pitch_rad", "speed_m_s")
        )
        (cos_heading, sin_heading), (cos_pitch, sin_pitch) = cos_sin(heading), cos_sin(pitch)
        level = speed * cos_pitch
        velocity_m_s = [level * cos_heading, level * sin_heading, speed * sin_pitch]
        length_s = self.elapsed_s(stamp - self.stamp)
        # Every moment in between is within half the time of one end: the velocity has changed no more than that allows.
        half_s = Interval(0.0, 0.5 * length_s.upper)
        reached_m_s = self.near(velocity_m_s, length_s)
        if self.velocity_m_s is not None:
            ends = zip(self.near(self.velocity_m_s, half_s), self.near(velocity_m_s, half_s))
            reached_m_s = [then | now for then, now in ends]
        so_far_m, so_far_s = self.ahead(Interval(0.0, length_s.upper), reached_m_s)
        moved_m, gained_s = self.ahead(length_s, reached_m_s)
        slice_m = [p + moved for p, moved in zip(self.position_m, so_far_m)]
        slice_s = self.offset_s + so_far_s
        self.position_m = [p + moved for p, moved in zip(self.position_m, moved_m)]
        self.offset_s = self.offset_s + gained_s
        self.stamp, self.velocity_m_s = stamp, velocity_m_s
        return slice_m, slice_s

    def hear(self, ping, stamp):
        """Contracts position and clock by a ping: it came as far as sound goes from its emission to its arrival."""
        modem = self.born["modem"]
        sound_m_s = Interval.of(modem["sound_speed_m_s"])
        # Arrival and tick are this far apart, in either order.
        apart_s = self.elapsed_s(abs(self.stamp - stamp)).widened(modem["timestamp_s"]).upper
        moved_m, gained_s = self.ahead(Interval(-apart_s, apart_s), [self.speed_m_s] * 3)
        arrival_s = self.offset_s + gained_s + self.local_s(stamp).widened(modem["timestamp_s"])
        distance_m = sound_m_s * (arrival_s - ping.emission_s)
        centre_m = [p + moved for p, moved in zip(ping.position_m, moved_m)]
        self.position_m, distance_m = contract_by_distance(self.position_m, centre_m, distance_m)
        self.offset_s &= ping.emission_s + distance_m / sound_m_s - self.local_s(stamp).widened(modem["timestamp_s"]) + gained_s

    def pings(self):
        """The pings that this tick is the last to book."""
        wake, booked = self.born["wake"], []
        earliest = self.stamp + wake["reaction_ns"]
        while self.next_ping < earliest + wake["period_ns"]:
            if self.next_ping >= earliest:
                booked.append({"at": self.next_ping, "frame": self.frame(self.next_ping).hex()})
            self.next_ping += self.born["orders"]["access"]["Periodic"]["period_ns"]
        return booked

    def frame(self, at):
        """What a ping will say that leaves at this local time."""
        length_s = self.elapsed_s(at - self.stamp)
        reached_m_s = self.near(self.velocity_m_s, length_s)
        moved_m, gained_s = self.ahead(length_s, reached_m_s)
        ping = Ping(
            self.born["auv"],
            self.sequence,
            self.offset_s + gained_s + self.local_s(at),
            [p + moved for p, moved in zip(self.position_m, moved_m)],
            [v + drift for v, drift in zip(reached_m_s, self.drift_m_s)],
        )
        self.sequence += 1
        return encode(ping)

    def local_s(self, stamp):
        """Exact local time of what is stamped so."""
        return Interval.around(1e-9 * stamp, self.stamp_s + 1e-15 * abs(1e-9 * stamp))

    def steer(self):
        """The velocity through the water that leads to the next waypoint."""
        orders = self.born["orders"]["controller"]["Waypoints"]
        gap_m = self.gap_m()
        if sum(g * g for g in gap_m) <= orders["reach_m"] * orders["reach_m"]:
            self.waypoints = self.waypoints[1:] + self.waypoints[:1]
            gap_m = self.gap_m()
        length_m = math.sqrt(sum(g * g for g in gap_m)) or 1.0
        return [orders["speed_m_s"] * g / length_m - d.mid for g, d in zip(gap_m, self.drift_m_s)]

    def gap_m(self):
        return [target - p.mid for target, p in zip(self.waypoints[0], self.position_m)]


if __name__ == "__main__":
    Link().live(Agent)

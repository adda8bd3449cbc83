"""Where and when an AUV is, as a set: the true time is one more coordinate, told as its difference from the own clock."""

from interval import Interval, above, contract_by_distance, cos_sin

ONE = Interval(1.0, 1.0)


class Enclosure:
    """Position and clock offset at the last tick. They hold the truth as long as the stated bounds do."""

    def __init__(self, born):
        clock, self.body, self.modem = born["clock"], born["body"], born["modem"]
        self.stamp, self.stamp_s = born["birth"], 1e-9 * clock["stamp_ns"]
        self.offset_s = Interval.of(clock["offset_s"])
        self.position_m = [Interval.of(side) for side in born["prior_position_m"]]
        # Velocity through the water at the last tick; at birth nobody knows.
        self.velocity_m_s = None
        # True seconds gained per local second: dt/ds - 1, where ds/dt is within the drift of 1.
        self.gain = ONE / (ONE + Interval(-clock["drift"], clock["drift"])) - ONE
        # What current and disturbance add to the velocity through the water.
        sides = zip(self.body["current_m_s"], self.body["disturbance_m_s"])
        self.drift_m_s = [Interval.of(current) + Interval.of(noise) for current, noise in sides]
        self.speed_m_s = Interval(-self.body["speed_m_s"], self.body["speed_m_s"])

    def elapsed_s(self, ns):
        """Local seconds between two stamps that are so many nanoseconds apart."""
        return Interval.around(1e-9 * ns, 2 * self.stamp_s + 1e-15 * abs(1e-9 * ns))

    def local_s(self, stamp):
        """Exact local time of what is stamped so, in seconds."""
        return Interval.around(1e-9 * stamp, self.stamp_s + 1e-15 * abs(1e-9 * stamp))

    def moved(self, length_s, velocity_m_s):
        """Displacement and gain of the clock within so much local time, at velocities through the water in this box."""
        true_s = length_s * (ONE + self.gain)
        return [(v + drift) * true_s for v, drift in zip(velocity_m_s, self.drift_m_s)], self.gain * length_s

    def near(self, velocity_m_s, length_s):
        """Velocities through the water within so much local time of a moment with one of these."""
        true_s = (Interval(0.0, length_s) * (ONE + self.gain)).upper
        change_m_s = above(self.body["acceleration_m_s2"] * true_s)
        return [v.widened(change_m_s) & self.speed_m_s for v in velocity_m_s]

    def move(self, stamp, inertial):
        """Goes on to a tick, and returns position and clock offset everywhere on the way."""
        heading, pitch, speed = (
            Interval.around(inertial[name]["value"], inertial[name]["error"])
            for name in ("heading_rad", "pitch_rad", "speed_m_s")
        )
        (cos_heading, sin_heading), (cos_pitch, sin_pitch) = cos_sin(heading), cos_sin(pitch)
        level = speed * cos_pitch
        now_m_s = [level * cos_heading, level * sin_heading, speed * sin_pitch]
        length_s = self.elapsed_s(stamp - self.stamp)
        if self.velocity_m_s is None:
            reached_m_s = self.near(now_m_s, length_s.upper)
        else:
            # Every moment on the way is at most half of it from one end.
            ends = self.near(self.velocity_m_s, 0.5 * length_s.upper), self.near(now_m_s, 0.5 * length_s.upper)
            reached_m_s = [then | now for then, now in zip(*ends)]
        part_m, part_s = self.moved(Interval(0.0, length_s.upper), reached_m_s)
        on_the_way = [p + moved for p, moved in zip(self.position_m, part_m)], self.offset_s + part_s
        whole_m, whole_s = self.moved(length_s, reached_m_s)
        self.position_m = [p + moved for p, moved in zip(self.position_m, whole_m)]
        self.offset_s = self.offset_s + whole_s
        self.stamp, self.velocity_m_s = stamp, now_m_s
        return on_the_way

    def at(self, stamp):
        """True time, position and velocity over ground at a local time to come."""
        length_s = self.elapsed_s(stamp - self.stamp)
        reached_m_s = self.near(self.velocity_m_s, length_s.upper)
        moved_m, gained_s = self.moved(length_s, reached_m_s)
        time_s = self.offset_s + gained_s + self.local_s(stamp)
        position_m = [p + moved for p, moved in zip(self.position_m, moved_m)]
        return time_s, position_m, [v + drift for v, drift in zip(reached_m_s, self.drift_m_s)]

    def depth(self, depth_m):
        self.position_m[2] &= -Interval.around(depth_m["value"], depth_m["error"])

    def fix(self, stamp, position_m, time_s):
        self.position_m = [p & Interval.of(side) for p, side in zip(self.position_m, position_m)]
        self.offset_s &= Interval.of(time_s) - self.local_s(stamp)

    def ping(self, stamp, ping):
        """Whoever hears a ping is as far from where it was emitted as sound goes from emission to arrival."""
        sound_m_s = Interval.of(self.modem["sound_speed_m_s"])
        # Arrival and tick are so far apart, in either order, and the body has moved in between.
        apart_s = self.elapsed_s(abs(self.stamp - stamp)).widened(self.modem["timestamp_s"]).upper
        moved_m, gained_s = self.moved(Interval(-apart_s, apart_s), [self.speed_m_s] * 3)
        centre_m = [p + moved for p, moved in zip(ping.position_m, moved_m)]
        local_s = self.local_s(stamp).widened(self.modem["timestamp_s"]) + gained_s
        distance_m = sound_m_s * (self.offset_s + local_s - ping.emission_s)
        self.position_m, distance_m = contract_by_distance(self.position_m, centre_m, distance_m)
        self.offset_s &= ping.emission_s + distance_m / sound_m_s - local_s

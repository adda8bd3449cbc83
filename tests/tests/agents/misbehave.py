"""An agent that does one thing wrong, named by its first argument, at tick 20 or before."""

import json
import struct
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[3] / "agents/python"))

import link
from agent import Agent

FAULT = sys.argv[1]


class Faulty(Agent):
    def step(self, sensed):
        acted = super().step(sensed)
        if sensed["tick"] == 20:
            if FAULT == "exception":
                raise ValueError("the sonar fell off")
            if FAULT == "misspelt":
                acted["setpont"] = acted.pop("setpoint")
            if FAULT == "text":
                acted["setpoint"]["velocity_m_s"][1] = "fast"
            if FAULT == "huge":
                acted["setpoint"]["velocity_m_s"][2] = 1e300
            if FAULT == "another tick":
                acted["tick"] = 7
            if FAULT == "long ping":
                acted["pings"] = [{"at": self.enclosure.stamp + 200_000_000, "frame": "00" * 65}]
        return acted


class Line(link.Link):
    def send(self, kind, sequence, message=None):
        if kind == link.HELLO and FAULT == "version":
            message = {"protocol": 99, "dialect": "json"}
        if kind == link.HELLO and FAULT == "no hello":
            return self.up.put(struct.pack("<BQ", kind, sequence) + b"hi there")
        if kind == link.ANSWER and message["Acted"][-1]["tick"] >= 20:
            if FAULT == "nothing":
                message = {"Acted": []}
            if FAULT == "nan":
                message["Acted"][-1]["setpoint"]["velocity_m_s"][0] = float("nan")
                return self.up.put(struct.pack("<BQ", kind, sequence) + json.dumps(message).encode())
            if FAULT == "garbage":
                return self.up.put(b"\xff\xfe")
            if FAULT == "number":
                sequence += 5
            if FAULT == "hello again":
                kind, sequence, message = link.HELLO, 0, {"protocol": 1, "dialect": "json"}
        super().send(kind, sequence, message)


Line().live(Faulty)

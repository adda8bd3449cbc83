"""An agent's end of the line: the protocol of `shoal_bus::protocol` over zenoh, in its JSON dialect."""

import json
import os
import queue
import struct

import zenoh

PROTOCOL = 1
HELLO, RECEIVED, ANSWER = 0, 1, 2


class Link:
    """Joins the run that this process was started for."""

    def __init__(self):
        run, auv = os.environ["SHOAL_RUN"], os.environ["SHOAL_AUV"]
        config = zenoh.Config()
        config.insert_json5("mode", '"client"')
        config.insert_json5("connect/endpoints", json.dumps([os.environ["SHOAL_ENDPOINT"]]))
        config.insert_json5("connect/timeout_ms", "60000")
        config.insert_json5("scouting/multicast/enabled", "false")
        # It would leave a file behind that nobody needs.
        config.insert_json5("transport/shared_memory/enabled", "false")
        self.session = zenoh.open(config)
        self.inbox = queue.SimpleQueue()
        self.down = self.session.declare_subscriber(
            f"shoal/{run}/down/{auv}", lambda sample: self.inbox.put(sample.payload.to_bytes())
        )
        self.up = self.session.declare_publisher(
            f"shoal/{run}/up/{auv}", congestion_control=zenoh.CongestionControl.BLOCK, express=True
        )

    def live(self, be_born):
        """Lives one life: `be_born(born)` makes a mind, whose `step(sensed)` answers each tick, until the run ends."""
        try:
            self.answer(be_born)
        finally:
            # An open session keeps the process from ending, even after an exception.
            self.session.close()

    def answer(self, be_born):
        mind, last = None, None
        while True:
            sequence, message = self.receive(says_hello=last is None)
            if sequence == last:
                continue  # Several hellos were on their way, and each was answered.
            if last is not None and sequence != last + 1:
                raise ConnectionError(f"frame {sequence} came after frame {last}")
            last = sequence
            if "Sensed" in message:
                self.send(ANSWER, sequence, {"Acted": [mind.step(sensed) for sensed in message["Sensed"]]})
                continue
            self.send(RECEIVED, sequence)
            if message == "End":
                return
            mind = be_born(message["Born"])

    def receive(self, says_hello: bool):
        """The next frame down: its number and its message. Says hello until there is one, if asked to."""
        while True:
            if says_hello:
                self.send(HELLO, 0, {"protocol": PROTOCOL, "dialect": "json"})
            try:
                frame = self.inbox.get(timeout=0.1 if says_hello else 1.0)
                return struct.unpack("<Q", frame[:8])[0], json.loads(frame[8:])
            except queue.Empty:
                if not self.session.info.routers_zid():
                    raise ConnectionError("the connection to the channel has ended") from None

    def send(self, kind: int, sequence: int, message=None):
        body = b"" if message is None else json.dumps(message, allow_nan=False).encode()
        self.up.put(struct.pack("<BQ", kind, sequence) + body)

"""Shows a run of Shoal in Rerun: where the AUVs are, and the boxes that they believe to be in, over true time.

Rerun opens a record as it is, too, and then shows what its messages say: it draws poses only where they are encoded as Protobuf.

    pip install mcap zstandard rerun-sdk
    shoal run six-circles --record circles.mcap
    python3 rerun_run.py circles.mcap --save circles.rrd && rerun circles.rrd
"""

import argparse
import json

import rerun as rr
from mcap.reader import make_reader

# Okabe and Ito's, a colour for each group.
COLOURS = [(0, 114, 178), (213, 94, 0), (0, 158, 115), (230, 159, 0), (204, 121, 167), (86, 180, 233)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("record")
    parser.add_argument("--save", required=True, help="the Rerun recording to write")
    arguments = parser.parse_args()
    rr.init("shoal")
    rr.save(arguments.save)
    rr.log("water", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    names, colours = [], []
    with open(arguments.record, "rb") as file:
        reader = make_reader(file, validate_crcs=True)
        for _, channel, message in reader.iter_messages(topics=["/auvs", "/ticks", "/reports"]):
            content = json.loads(message.data)
            if channel.topic == "/auvs":
                names = [told["name"] for told in content["auvs"]]
                colours = [COLOURS[told["group"] % len(COLOURS)] for told in content["auvs"]]
                continue
            rr.set_time("true_time", duration=message.log_time * 1e-9)
            rows = list({row["auv"]: row for row in content[channel.topic[1:]]}.values())
            if not rows:
                continue
            of = [row["auv"] for row in rows]
            look = {"colors": [colours[auv] for auv in of], "labels": [names[auv] for auv in of], "show_labels": False}
            if channel.topic == "/ticks":
                rr.log("water/auvs", rr.Points3D([row["position_m"] for row in rows], radii=1.0, **look))
            else:
                sides = [row["position_m"] for row in rows]
                centres = [[(lower + upper) / 2 for lower, upper in box] for box in sides]
                halves = [[(upper - lower) / 2 for lower, upper in box] for box in sides]
                rr.log("water/boxes", rr.Boxes3D(centers=centres, half_sizes=halves, **look))
                widest = max(max(upper - lower for lower, upper in box) for box in sides)
                rr.log("widest_box_m", rr.Scalars(widest))


if __name__ == "__main__":
    main()

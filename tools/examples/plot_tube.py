"""Plots what one AUV knew of its position and of the time, from a record of Shoal, with Python's `mcap` and `matplotlib`.

    pip install mcap zstandard matplotlib
    shoal run six-circles --record circles.mcap
    python3 plot_tube.py circles.mcap --auv 3 --out tube.png
"""

import argparse
import json

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from mcap.reader import make_reader

LABELS = ["x, east (m)", "y, north (m)", "z, up (m)", "true − local time (s)"]


def read(path, auv):
    """The rows of one AUV's truth and reports, and what it is called."""
    truth, reports, name = [], [], ""
    with open(path, "rb") as file:
        reader = make_reader(file, validate_crcs=True)
        for _, channel, message in reader.iter_messages(topics=["/auvs", "/ticks", "/reports"]):
            content = json.loads(message.data)
            if channel.topic == "/auvs":
                name = content["auvs"][auv]["name"]
            elif channel.topic == "/ticks":
                truth += [row for row in content["ticks"] if row["auv"] == auv]
            else:
                reports += [row for row in content["reports"] if row["auv"] == auv]
    return name, truth, reports


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("record")
    parser.add_argument("--auv", type=int, default=0, help="counted from 0")
    parser.add_argument("--out", default="tube.png")
    arguments = parser.parse_args()
    name, truth, reports = read(arguments.record, arguments.auv)

    # True time, in seconds; each quantity with its bounds and its truth.
    at_truth = [row["t_ns"] * 1e-9 for row in truth]
    true = [row["position_m"] + [(row["t_ns"] - row["local_ns"]) * 1e-9] for row in truth]
    at_report = [row["t_ns"] * 1e-9 for row in reports]
    bounds = [row["position_m"] + [row["clock_offset_s"]] for row in reports]

    figure, panels = plt.subplots(len(LABELS), sharex=True, figsize=(8, 10))
    for index, (panel, label) in enumerate(zip(panels, LABELS)):
        lower = [row[index][0] for row in bounds]
        upper = [row[index][1] for row in bounds]
        panel.fill_between(at_report, lower, upper, color="#56b4e9", label="tube")
        panel.plot(at_truth, [row[index] for row in true], color="black", linewidth=0.8, label="truth")
        panel.set_ylabel(label)
    panels[0].legend(loc="upper left")
    panels[0].set_title(f"What {name} (AUV {arguments.auv}) knows")
    panels[-1].set_xlabel("true time (s)")
    figure.savefig(arguments.out, bbox_inches="tight")

    inside = sum(
        all(low <= value <= high for (low, high), value in zip(row, value_row))
        for row, value_row in zip(bounds, true)
    )
    print(json.dumps({"auv": name, "ticks": len(truth), "reports": len(reports), "truth_inside": inside}))


if __name__ == "__main__":
    main()

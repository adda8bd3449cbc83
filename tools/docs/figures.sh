#!/usr/bin/env bash
# Makes the figures of the README again, and a picture of a report: tools/docs/figures.sh [FOLDER], this one unless given.
# The picture needs Chromium; without one it is left as it is.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"
out="$(realpath -m "${1:-$here}")"
shoal=${SHOAL:-"cargo run --quiet --release --manifest-path $here/../../Cargo.toml --"}
mkdir -p "$out"
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT

$shoal run swarm-300 --duration 6 --bus local --quiet --record "$scratch/flock.mcap" >/dev/null
$shoal plot "$scratch/flock.mcap" map --at-s 5.05 -o "$out/map.svg"
$shoal plot "$scratch/flock.mcap" paving --auv 7 --at-s 2 -o "$out/paving.svg"
$shoal report "$scratch/flock.mcap" -o "$scratch/flock.html"

chromium="$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)"
if [ -n "$chromium" ]; then
    "$chromium" --headless --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="$scratch/browser" \
        --window-size=900,1100 --screenshot="$scratch/report.png" "file://$scratch/flock.html" >/dev/null 2>&1
    mv "$scratch/report.png" "$out/report.png"
else
    echo "skipped: no Chromium, so no picture of the report"
fi

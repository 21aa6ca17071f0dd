"""The two sizes of `python3 -m bench all`: which steps run, each with the words of its command line."""
from __future__ import annotations

from bench import targets

SCENES = ["driving_day:20+8", "driving_night:20+8", "bumps:3+8", "stop_and_go:14+9", "turns:2+8", "traffic:6",
          "highway:4+6", "handheld_boxes:4+6", "slider"]
TEN_SEEDS = ",".join(str(seed) for seed in range(1, 11))
CONFIGURATIONS = ["--config", "ours", "--config", "paper", "--set", targets.MORE_FEATURES, "--set", targets.BASELINE]
# 122 and 390 asked make about 100 and 300 features live by day.
FEATURES = "122,390"

# About 20 simulated seconds for each seed.
QUICK_SEEDS = "1,2"
QUICK_SCENES = ["driving_day:20+5", "driving_night:20+5", "stop_and_go:14+5", "handheld_boxes:4+4", "slider"]
QUICK_ABLATION_SCENES = ["driving_day:20+5"]

Step = tuple[str, list[str]]

FULL: list[Step] = [
    ("tracking", ["--seeds", "1,2,3", "--features", FEATURES, *targets.TRACKING_SCENES]),
    ("scaling", ["--methods", "em", "--features", "100", "--long"]),
    ("scenes", ["--seeds", "1,2,3", *SCENES]),
    ("odometry", ["--seeds", TEN_SEEDS, *CONFIGURATIONS, *targets.ODOMETRY_SCENES]),
    ("ablation", ["--seeds", "1,2,3", *targets.ABLATION_SCENES]),
    ("worlds", ["--seeds", "1001-1100"]),
    ("evaluation", []),
]
QUICK: list[Step] = [
    ("tracking", ["--seeds", QUICK_SEEDS, "--features", FEATURES, "--repeats", "2", *QUICK_SCENES]),
    ("scenes", ["--seeds", QUICK_SEEDS, *QUICK_SCENES]),
    ("odometry", ["--seeds", QUICK_SEEDS, *CONFIGURATIONS, *QUICK_SCENES]),
    ("ablation", ["--seeds", QUICK_SEEDS, *QUICK_ABLATION_SCENES]),
    ("worlds", ["--seeds", "1-4", "--duration", "5"]),
    ("evaluation", []),
]

"""The commands whose outputs two builds are compared by.

{configs} is the configs folder of the binary's source tree, {data} the bundled samples, {out} the command's own output
folder. Commands run one after the other in the same folder, so later ones read what earlier ones wrote.
"""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

SAMPLES = {
    "street": ("street_gt.hdf5", "camchain-imucam-street.yaml"),
    "night": ("night_gt.hdf5", "camchain-imucam-night.yaml"),
    "handheld": ("depth_gt.hdf5", "calib.txt"),
}
# Parameters that are renamed in version 1.0 are called by their old names, which both builds know.
VARIANTS = {
    "klt": "tracker.method=klt",
    "features": "tracker.features=300",
    "window_curvature": "tracker.window_bend_px=1000",
    "rotation_correction": "tracker.follow_jolts=false",
    "rotation_spline": "tracker.restore_shake=false",
    "uninformative": "tracker.uninformative_share=0.2",
    "odd": "tracker.odd_share=0",
    "events": "tracker.fewest_events=40",
    "spacing": "tracker.corner_closest_px=4",
    "motion": "odometry.final.motion=0",
    "drift": "odometry.final.drift=0.01",
    "noise": "odometry.final.own_noise=false",
    "variance_inflation": "odometry.covariance.alike=1",
    "turn": "odometry.covariance.turn=0",
    "metric": "odometry.ground.camera_height_m=1.5",
}
SCENES = {
    "driving_day": ("mvsec", "52"),
    "driving_night": ("mvsec", "20"),
    "handheld_boxes": ("uzh", "4"),
    "slider": ("uzh", "0.5"),
}


@dataclass(frozen=True)
class Command:
    """A call of evo-run."""

    name: str  # of its output folder
    words: tuple[str, ...]
    cost: float = 1.0


def out(name: str, *words: str, cost: float = 1.0) -> Command:
    """A command with --out of its own; --force, since what it prints is kept there, too."""
    return Command(name, (*words, "--out", "{out}", "--force"), cost)


def sample_commands() -> list[Command]:
    """Every command on the bundled samples."""
    found = []
    for name, (truth, calibration) in SAMPLES.items():
        events = f"{{data}}/{name}"
        for threads in ("1", "2"):
            found.append(out(f"run_{name}_{threads}", "run", "--events", events, "--threads", threads))
        found += [
            out(f"track_{name}", "track", "--events", events, "--threads", "2", "--draw-every", "0.25"),
            out(f"paper_{name}", "run", "--config", "{configs}/paper.yaml", "--events", events, "--no-plots"),
            out(f"klt_{name}", "track", "--set", VARIANTS["klt"], "--events", events, "--no-plots"),
            out(f"odometry_{name}", "odometry", "--tracks", f"track_{name}/tracks.txt",
                "--calibration", f"{events}/{calibration}", "--threads", "1"),
            out(f"tracks_{name}", "evaluate", "--tracks", f"track_{name}/tracks.txt",
                "--ground-truth", f"{events}/{truth}", "--calibration", f"{events}/{calibration}"),
            out(f"evaluate_{name}", "evaluate", "--estimate", f"odometry_{name}/trajectory.txt",
                "--ground-truth", f"{events}/{truth}", "--align", "none,origin,origin-scale,se3,posyaw,sim3:5s",
                "--rpe", "1f,0.2s", "--covariances", f"odometry_{name}/pose_covariance.csv"),
            Command(f"info_{name}", ("info", events)),
        ]
    return found


def variant_commands() -> list[Command]:
    """One parameter changed at a time, on the street."""
    return [out(f"set_{name}", "run", "--events", "{data}/street", "--set", value, "--no-plots", "--threads", "2")
            for name, value in VARIANTS.items()]


def scene_commands() -> list[Command]:
    """Simulated scenes in both formats, and the pipeline on one."""
    found = []
    for name, (layout, start) in SCENES.items():
        for threads in ("1", "2") if name == "driving_day" else ("2",):
            found.append(out(f"simulate_{name}_{threads}", "simulate", f"{{configs}}/scenes/{name}.yaml",
                             "--from", start, "--duration", "0.4", "--format", layout, "--threads", threads, cost=5))
    found += [
        out("simulate_day", "simulate", "{configs}/scenes/driving_day.yaml", "--from", "52", "--duration", "1.2",
            "--seed", "3", cost=10),
        out("run_simulated", "run", "--events", "simulate_day", "--threads", "2"),
        Command("simulate_print", ("simulate", "{configs}/scenes/driving_day.yaml", "--print")),
    ]
    return found


def street_commands(street: Path) -> list[Command]:
    """The pipeline on a further recording."""
    events = str(street.resolve())
    return [
        *(out(f"run_recording_{threads}", "run", "--events", events, "--threads", threads, "--no-plots", cost=5)
          for threads in ("1", "2")),
        out("klt_recording", "run", "--events", events, "--set", VARIANTS["klt"], "--no-plots", cost=5),
        out("paper_recording", "run", "--events", events, "--config", "{configs}/paper.yaml", "--no-plots", cost=5),
    ]


def commands(street: Path | None) -> list[Command]:
    """All commands, in an order in which each finds what it reads."""
    return [
        *sample_commands(), *variant_commands(), *scene_commands(), *(street_commands(street) if street else []),
        out("report", "report", "run_street_1", "run_night_1", "run_handheld_1"),
        Command("config_print", ("config", "--print")),
        Command("config_paper", ("config", "--print", "--config", "{configs}/paper.yaml")),
    ]

#!/usr/bin/env python3
"""Cuts a small sample out of a sequence in MVSEC's HDF5 layout. For maintainers; evo-run itself needs no Python.

    scripts/cut_sample.py --events street_data.hdf5 --ground-truth street_gt.hdf5 --from 10 --to 11.5 --out DIR

Writes DIR/<name>_data.hdf5 and DIR/<name>_gt.hdf5, named as the inputs are. Needs python3-h5py and python3-numpy.
"""

import argparse
import pathlib

import h5py
import numpy as np

EVENTS = "davis/left/events"
TRAJECTORIES = ("davis/left/odometry", "davis/left/pose")
CHUNK_ROWS = 262144
TICK_S = 2.0**-19  # 1.9 us; on this grid the low bits of the stamps are zero, which deflate well


def first_at_or_after(events, target):
    """Row of the first stamp >= target, by bisection: the column is not read whole."""
    low, high = 0, len(events)
    while low < high:
        middle = (low + high) // 2
        if events[middle, 2] < target:
            low = middle + 1
        else:
            high = middle
    return low


def cut_events(source, target, begin_s, end_s):
    """Copies the events of [begin, end) seconds after the first one; returns their first and last stamp."""
    with h5py.File(source, "r") as file:
        events = file[EVENTS]
        start = events[0, 2]
        rows = events[first_at_or_after(events, start + begin_s):first_at_or_after(events, start + end_s)]
    if len(rows) == 0:
        raise SystemExit(f"{source}: no events from {begin_s} s to {end_s} s")
    rows[:, 2] = np.rint(rows[:, 2] / TICK_S) * TICK_S  # rounding keeps the order
    with h5py.File(target, "w", libver=("earliest", "v108")) as file:
        # One column a chunk: like bytes lie together.
        file.create_dataset(EVENTS, data=rows, chunks=(min(CHUNK_ROWS, len(rows)), 1), shuffle=True,
                            compression="gzip", compression_opts=9)
    return rows[0, 2], rows[-1, 2], len(rows)


def cut_poses(source, target, first, last):
    """Copies the poses from the last one before the events to the first one after them."""
    with h5py.File(source, "r") as file, h5py.File(target, "w", libver=("earliest", "v108")) as out:
        for name in TRAJECTORIES:
            stamps = file[name + "_ts"][:]
            begin = max(int(np.searchsorted(stamps, first, side="right")) - 1, 0)
            end = int(np.searchsorted(stamps, last, side="left")) + 1
            out.create_dataset(name, data=file[name][begin:end])
            out.create_dataset(name + "_ts", data=stamps[begin:end])


def main():
    parser = argparse.ArgumentParser(description="Cut a small sample out of a sequence in MVSEC's HDF5 layout.")
    parser.add_argument("--events", type=pathlib.Path, required=True, help="*_data.hdf5 to cut from")
    parser.add_argument("--ground-truth", type=pathlib.Path, required=True, help="*_gt.hdf5 to cut from")
    parser.add_argument("--from", type=float, required=True, dest="begin", help="seconds after the first event")
    parser.add_argument("--to", type=float, required=True, dest="end", help="seconds after the first event")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder for the sample")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    first, last, count = cut_events(arguments.events, arguments.out / arguments.events.name, arguments.begin,
                                    arguments.end)
    cut_poses(arguments.ground_truth, arguments.out / arguments.ground_truth.name, first, last)
    print(f"{count} events, {last - first:.3f} s")


if __name__ == "__main__":
    main()

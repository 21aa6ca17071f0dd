"""Recordings and folders of given tracks, and the files in them."""
from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from bench.errors import BenchError
from bench.scenes import Part, parse_part


def ground_truth_of(folder: Path) -> Path | None:
    """The ground truth of a sequence or recording."""
    found = sorted(folder.glob("*_gt.hdf5")) or sorted(folder.glob("groundtruth.txt"))
    return found[0] if found else None


def calibration_of(folder: Path) -> Path | None:
    """The calibration of a sequence or recording."""
    found = sorted(folder.glob("camchain*.yaml")) or sorted(folder.glob("calib.txt"))
    return found[0] if found else None


def holds_tracks_only(folder: Path) -> bool:
    """Whether a folder holds given tracks instead of events."""
    has_events = any(folder.glob("*_data.hdf5")) or (folder / "events.txt").exists()
    return (folder / "tracks.txt").exists() and not has_events


@dataclass(frozen=True)
class Recording:
    """A recording, or a part of it."""

    folder: Path
    part: Part | None

    @property
    def name(self) -> str:
        """FOLDER's name and the part, as a folder's name."""
        return self.folder.resolve().name + (f"_{self.part}" if self.part else "")

    @property
    def label(self) -> str:
        """FOLDER's name:PART."""
        return self.folder.resolve().name + (f":{self.part}" if self.part else "")

    @property
    def interval(self) -> list[str]:
        """The options for the part."""
        if self.part is None:
            return []
        return ["--from", f"{self.part.start_s:.9g}", "--to", f"{self.part.end_s:.9g}"]


def parse_recording(text: str) -> Recording:
    """FOLDER[:[FROM+]SECONDS]."""
    if Path(text).is_dir():
        return Recording(Path(text), None)
    folder, colon, part = text.rpartition(":")
    if not colon or not Path(folder).is_dir():
        raise BenchError(f"there is no folder {text}")
    return Recording(Path(folder), parse_part(part))

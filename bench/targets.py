"""Everything that is measured against: parameter names, scenes, ablated ingredients, targets, published figures."""
from __future__ import annotations

from dataclasses import dataclass

# Parameters that a benchmark varies itself.
METHOD = "tracker.method"
FEATURES = "tracker.features"
CORNER_SPACING = "tracker.corner_spacing_px"
THRESHOLDS = [f"sensor.threshold_{name}" for name in ("on", "off", "spread")]
BUMPS_AT = "motion.vehicle.bumps_at_s"
MOTION_KIND = "motion.kind"
RPE_PAIRS_FROM = "evaluation.rpe_pairs_from"

CAMERA_HEIGHT = "odometry.ground.camera_height_m"  # of the odometry
TRUE_CAMERA_HEIGHT = "motion.vehicle.camera_height_m"  # of the scene

# A drive of few events, 10 minutes of which need little disk.
SLOW_DRIVE = [
    "scene.calibration=davis240c",
    "motion.vehicle.speed_m_s=1",
    "motion.vehicle.duration_s=600",
    "sensor.threshold_on=0.35",
    "sensor.threshold_off=0.12",
    "simulation.samples=1",
    "simulation.max_step_s=0.01",
    "simulation.image_hz=0",
    "simulation.depth_hz=0",
    "output.pose_hz=20",
]

# Scenes that are measured unless others are named, [FROM+]SECONDS behind the colon.
TRACKING_SCENES = ["driving_day:20+8", "driving_night:20+8", "bumps:3+8", "stop_and_go:14+9", "handheld_boxes:4+6"]
ODOMETRY_SCENES = ["driving_day:60", "driving_day:20+8", "driving_night:20+8", "bumps:3+8", "stop_and_go:14+9",
                   "turns:2+8", "traffic:6", "highway:4+6", "handheld_boxes:4+6", "slider"]
ABLATION_SCENES = ["driving_day:60", "bumps:3+8", "driving_night:20+8"]

# Variants of the default configuration.
MORE_FEATURES = f"{FEATURES}=300"
BASELINE = f"{METHOD}=klt"

# Each switches one ingredient off.
ABLATIONS = [
    "odometry.ground.hold_height=false",
    "odometry.final.velocity_change_scale=0",
    "odometry.final.drift_variance_ratio=0",
    "odometry.final.track_noise=false",
    "odometry.final_refinement=false",
    "odometry.backward_tracking=false",
    "odometry.window_refinement=false",
    "odometry.bootstrap.refine=false",
    "odometry.key_frame.every_frames=5",
    "odometry.depth_filter.old_key_frames=0",
    "odometry.max_outliers=1000",
    "tracker.ego_motion=false",
    "tracker.epipolar_filter=false",
    "tracker.window_curvature_px=1000",
    "tracker.rotation_correction=false",
    "tracker.rotation_spline=false",
    "tracker.uninformative_ratio=0",
    "tracker.rejection_ratio=0",
    "tracker.template_gain=1",
    "tracker.use_polarity=false",
    "tracker.predict_polarity=false",
    "tracker.min_log_likelihood_ratio=-10",
    "tracker.innovation_gate=1000",
    "events.hot_pixels.detect=false",
    "events.flicker.remove=false",
]


@dataclass(frozen=True)
class Target:
    """A limit that a measured quantity of a scene is to keep."""

    scene: str  # a scene's name, or with its part: only that part
    quantity: str  # column of the table, or a ratio of two scenes or methods
    comparison: str
    limit: float
    of: str = "median"  # or worst: over the seeds
    factor: float = 1.0  # from the column's unit to the limit's
    features: int = 0  # only with about so many features; 0: any number (tracking), the default number (odometry)
    stretch: float | None = None  # a limit to aim at beyond


# Of the EM tracker; quantities ending in _over_klts are EM's value over KLT's.
TRACKING_TARGETS = [
    Target("driving_day", "real_time_factor_median", ">=", 8, features=100),
    Target("driving_day", "real_time_factor_median", ">=", 3, features=300),
    Target("driving_day", "track_error_median_px", "<=", 0.35),
    Target("driving_night", "track_error_median_px", "<=", 0.5),
    Target("driving_day", "expected_age_at_5_px_share", ">=", 0.75),
    Target("driving_night", "expected_age_at_5_px_share", ">=", 0.65),
    Target("driving_day", "age_share_over_klts", ">=", 1.5),
    Target("driving_night", "age_share_over_klts", ">=", 1.5),
    Target("driving_day", "age_s_over_klts", ">=", 1.5),
    Target("driving_night", "age_s_over_klts", ">=", 1.5),
    Target("driving_day", "lifetime_frames", ">", 33),
    Target("driving_night", "lifetime_frames", ">", 29),
    Target("driving_day", "tracks_over_3_px_share", "<", 2, factor=100),
    Target("driving_night", "tracks_over_3_px_share", "<", 4, factor=100),
    Target("driving_day", "tracks_mostly_over_3_px_share", "<", 2, factor=100),
    Target("driving_night", "tracks_mostly_over_3_px_share", "<", 4, factor=100),
    Target("driving_day", "tracks_astray_over_3_px_share", "<", 2, factor=100),
    Target("driving_night", "tracks_astray_over_3_px_share", "<", 4, factor=100),
    Target("driving_day", "positions_past_3_px_share", "<", 2, factor=100),
    Target("driving_night", "positions_past_3_px_share", "<", 4, factor=100),
]


def _follows(scene: str, error: str, limit: float) -> list[Target]:
    """The targets of a scene that is followed throughout, with a limit of one of its errors."""
    return [
        Target(scene, "coverage_since_start_share", ">=", 0.98, of="worst"),
        Target(scene, "rebootstraps", "<=", 0, of="worst"),
        Target(scene, error, "<=", limit),
    ]


# Of the default configuration; error_over_that_of_* is the mean planar error over that of another scene's same part.
ODOMETRY_TARGETS = [
    Target("driving_day:60", "mean_planar_percent", "<=", 0.13, stretch=0.065),
    Target("driving_day:60", "max_planar_percent", "<=", 0.4, stretch=0.2),
    Target("driving_day:60", "bump_growth", "<=", 1.5),
    Target("driving_day:60", "own_scale_bump_growth", "<=", 1.5),
    Target("driving_day:60", "nees_pose", ">=", 0.5),
    Target("driving_day:60", "nees_pose", "<=", 2),
    Target("bumps", "nees_pose", "<=", 2),
    Target("driving_night", "nees_pose", "<=", 2),
    Target("handheld_boxes", "nees_pose", "<=", 2),
    Target("bumps", "rebootstraps", "<=", 0, of="worst"),
    Target("bumps", "frames_lost", "<=", 0, of="worst"),
    Target("bumps", "error_over_that_of_level", "<=", 1.5),
    Target("driving_night", "error_over_that_of_day", "<=", 2),
    *_follows("stop_and_go", "mean_planar_percent", 0.5),
    *_follows("turns", "mean_planar_percent", 0.5),
    *_follows("traffic", "mean_planar_percent", 0.5),
    *_follows("highway", "mean_planar_percent", 0.5),
    *_follows("handheld_boxes", "sim3_mean_planar_percent", 0.5),
    *_follows("slider", "mean_planar_percent", 0.5),
    Target("uzh_boxes_6dof_tracks", "sim3_ape_rmse_percent", "<=", 0.7),
    Target("street_12s", "mean_planar_percent", "<=", 0.2),
    Target("street_12s", "max_planar_percent", "<=", 0.5),
    Target("driving_day", "odometry_x_real_time", ">=", 10),
    Target("driving_day", "run_x_real_time", ">=", 2.5, features=300),
]

# Quantities of a target that compare two scenes: the other scene.
OTHER_SCENE = {"error_over_that_of_day": "driving_day", "error_over_that_of_level": "bumps_level"}

# Table 3 of the paper, origin-scale, on the 439 m of MVSEC outdoor_day2 between 12 s and 72 s.
PUBLISHED_ODOMETRY = {
    "mean_longitudinal_m": 0.488,
    "mean_lateral_m": 0.275,
    "mean_planar_m": 0.581,
    "mean_planar_percent": 0.132,
    "max_planar_percent": 0.558,
}
PUBLISHED_COMPARES_WITH = "driving_day:60"


# Of random drives, over all of them.
WORLD_TARGETS = [
    Target("random", "mean_planar_percent", "<=", 0.08),
    Target("random", "mean_planar_percent", "<=", 0.25, of="90 %"),
    Target("random", "mean_planar_percent", "<=", 1.0, of="worst"),
    Target("random", "lost", "<=", 0, of="sum"),
    Target("random", "kitti_translation_percent", "<=", 0.3),
    Target("random", "kitti_rotation_deg_per_m", "<=", 0.001),
    Target("random", "metric_scale_error_percent", "<=", 0.5),
    Target("random", "metric_scale_error_percent", "<=", 1.5, of="worst"),
    Target("random", "nees_pose", ">=", 0.7),
    Target("random", "nees_pose", "<=", 1.4),
    Target("random", "nees_pose", "<=", 4, of="90 %"),
]


def verdict(value: float | None, comparison: str, limit: float) -> str:
    """Whether a value keeps a limit: met, missed or not measured."""
    if value is None:
        return "not measured"
    kept = {"<": value < limit, "<=": value <= limit, ">": value > limit, ">=": value >= limit}[comparison]
    return "met" if kept else "missed"


def scene_name(label: str) -> str:
    """The scene of a label such as driving_day:20+8."""
    return label.partition(":")[0]

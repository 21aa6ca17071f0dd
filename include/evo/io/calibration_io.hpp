#pragma once

#include <filesystem>
#include <optional>

#include "evo/geometry/camera.hpp"

namespace evo::io {

struct ImageSize {
  int width = 0;   ///< px
  int height = 0;  ///< px
};

/// Reads `cam0` of a Kalibr camchain YAML (pinhole; equidistant or radtan) or a UZH calib.txt, one line
/// `fx fy cx cy k1 k2 p1 p2 k3` (radtan), told by content. A calib.txt does not say how large the sensor is: `size`
/// does, or it is the 240 x 180 px of the DAVIS240C that recorded the UZH sequences. A camchain's own resolution
/// counts; a differing `size` is refused. Throws Error (kInput) with line and key on what is missing, not finite,
/// unsupported or impossible.
geometry::Calibration ReadCalibration(const std::filesystem::path& path, std::optional<ImageSize> size = std::nullopt);

/// Writes a camchain YAML with `cam0` alone, or a calib.txt, that ReadCalibration reads back exactly. A lone camera
/// needs no turning to be rectified: the camchain's rectification is the identity, its projection the intrinsics, as in
/// Rectified(). Throws Error:
/// kConfiguration for what the format has no place for (a fifth coefficient in a camchain, equidistant distortion in a
/// calib.txt), kOutput.
void WriteCamchain(const std::filesystem::path& path, const geometry::Calibration& calibration);
void WriteUzhCalibration(const std::filesystem::path& path, const geometry::Calibration& calibration);

}  // namespace evo::io

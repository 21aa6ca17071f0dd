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
/// `fx fy cx cy k1 k2 p1 p2 k3` (radtan). The content tells the format. A calib.txt holds no sensor size: `size` gives
/// it, by default the 240 x 180 px of the UZH sequences' DAVIS240C. A camchain holds one, and another `size` is
/// refused. Throws Error (kInput) with line and key for a value that is missing, not finite, unsupported or impossible.
geometry::Calibration ReadCalibration(const std::filesystem::path& path, std::optional<ImageSize> size = std::nullopt);

/// Writes a camchain YAML with `cam0`, or a calib.txt, that ReadCalibration reads back exactly. The camchain's
/// rectification is the identity and its projection the intrinsics, as in Rectified(). Throws Error: kConfiguration for
/// a value without a place in the format (a fifth coefficient in a camchain, equidistant distortion in a calib.txt),
/// kOutput.
void WriteCamchain(const std::filesystem::path& path, const geometry::Calibration& calibration);
void WriteUzhCalibration(const std::filesystem::path& path, const geometry::Calibration& calibration);

}  // namespace evo::io

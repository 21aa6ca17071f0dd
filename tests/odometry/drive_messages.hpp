#pragma once

#include <stdexcept>
#include <utility>
#include <vector>

#include "odometry/frontend/bootstrap.hpp"
#include "odometry/frontend/frame_builder.hpp"
#include "odometry/mapping/mapper.hpp"
#include "odometry/synthetic_drive.hpp"

namespace evo::odometry::testing {

/// The first map of a drive.
inline Bootstrap FirstMapOfDrive(const std::vector<Frame>& frames, const BootstrapOptions& options = {}) {
  Bootstrapper bootstrapper(options, frames, DriveCamera().focal_px());
  for (int i = 0; i < static_cast<int>(frames.size()); ++i) {
    if (auto bootstrap = bootstrapper.Add(i)) return *bootstrap;
  }
  throw std::runtime_error(bootstrapper.failure_reason());
}

/// The messages of the pose thread for a drive with its true poses.
inline std::vector<FrameMessage> DriveMessages(int count) {
  const auto drive = MakeDrive({.seconds = 3.0, .stop = false, .seed = 3});
  const auto frames = BuildFrames(drive.tracks, DriveCamera());
  const Bootstrap bootstrap = FirstMapOfDrive(frames);
  std::vector<FrameMessage> messages;
  int key_frame = -1;
  geometry::SE3 T_key_world;
  for (int i = bootstrap.first; i < bootstrap.first + count; ++i) {
    const auto place = static_cast<std::size_t>(i - bootstrap.first);
    const double scale =
        bootstrap.T_cam_world.back().translation().norm() /
        (drive.truth[bootstrap.last].T_world_cam.translation() - drive.truth[bootstrap.first].T_world_cam.translation())
            .norm();
    const geometry::SE3 relative = drive.truth[i].T_world_cam.Inverse() * drive.truth[bootstrap.first].T_world_cam;
    const geometry::SE3 pose(relative.rotation(), scale * relative.translation());
    FrameMessage message;
    message.index = i;
    message.frame = frames[i];
    message.pose = {key_frame, pose * T_key_world.Inverse()};
    message.is_key_frame = place % 5 == 0;
    if (place == 0) message.new_map = bootstrap.points;
    if (message.is_key_frame) {
      ++key_frame;
      T_key_world = pose;
    }
    messages.push_back(std::move(message));
  }
  return messages;
}

}  // namespace evo::odometry::testing

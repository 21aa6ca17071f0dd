#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "odometry/mapping/mapper.hpp"

namespace evo::odometry {

/// Runs a mapper beside the pose thread (D. Zhu, section "Parallel tracking and mapping"): a first-in-first-out queue
/// of frames to it and one of map updates back. Nothing is dropped and everything is copied. The result of Collect()
/// depends only on the posted messages, never on timing.
class MappingThread {
 public:
  /// Without `threaded`, Post() does the work. The mapper belongs to this object until its destruction.
  MappingThread(Mapper* mapper, bool threaded);
  ~MappingThread();
  MappingThread(const MappingThread&) = delete;
  MappingThread& operator=(const MappingThread&) = delete;

  /// Messages are posted in order of their frames' indices.
  void Post(FrameMessage message);
  /// Waits for the updates of all posted frames up to `index` and returns those not yet collected.
  /// Rethrows the mapper's exceptions.
  std::vector<MapUpdate> Collect(int index);

 private:
  void Run();

  Mapper* mapper_;
  std::mutex mutex_;
  std::condition_variable posted_;
  std::condition_variable done_;
  std::deque<FrameMessage> messages_;  // guarded by mutex_, as all below
  std::deque<MapUpdate> updates_;
  std::deque<int> outstanding_;  // indices of the frames posted and not collected
  std::exception_ptr error_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace evo::odometry

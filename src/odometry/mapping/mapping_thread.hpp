#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "odometry/mapping/mapper.hpp"

namespace evo::odometry {

/// Runs a mapper beside the pose thread: a queue of frames in, a queue of updates out, first in first out, nothing ever
/// dropped. Everything crosses by value. What Collect() returns depends only on what was posted, never on timing.
class MappingThread {
 public:
  /// Without `threaded` the work is done inside Post(). The mapper belongs to this object until it is destroyed.
  MappingThread(Mapper* mapper, bool threaded);
  ~MappingThread();
  MappingThread(const MappingThread&) = delete;
  MappingThread& operator=(const MappingThread&) = delete;

  /// Messages come in order of their frames' indices.
  void Post(FrameMessage message);
  /// Waits for the updates of all posted frames up to `index` and hands over those not yet collected.
  /// Rethrows what the mapper has thrown.
  std::vector<MapUpdate> Collect(int index);

 private:
  void Run();

  Mapper* mapper_;
  std::mutex mutex_;
  std::condition_variable posted_;
  std::condition_variable done_;
  std::deque<FrameMessage> messages_;  // guarded by mutex_, like all below
  std::deque<MapUpdate> updates_;
  std::deque<int> outstanding_;  // indices of frames posted and not collected
  std::exception_ptr error_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace evo::odometry

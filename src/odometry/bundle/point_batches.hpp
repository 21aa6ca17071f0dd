#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "evo/core/parallel.hpp"
#include "odometry/bundle/bundle_problem.hpp"

namespace evo::odometry {

/// Calls work(i) for every i in [0, count), `chunk` at a time on all threads of `pool`, or on this one if it is null.
void ForEachIndex(ThreadPool* pool, std::size_t count, std::size_t chunk, const std::function<void(std::size_t)>& work);

/// A problem's points cut into batches of consecutive ones, such that a batch shares no pose with the next but one. So
/// every other batch may be processed at once, and every pose gets its terms in the same order for any number of
/// threads.
class PointBatches {
 public:
  /// `first_observations` as FirstObservations returns them; `pool` may be null.
  PointBatches(const BundleProblem& problem, const std::vector<std::size_t>& first_observations, ThreadPool* pool);

  /// Calls work(p) for all points; no two threads process points of the same pose at once.
  void ForEachPoint(const std::function<void(std::size_t)>& work) const;

 private:
  std::vector<std::size_t> begins_;  // first point of every batch; the number of points at the end
  ThreadPool* pool_;
};

}  // namespace evo::odometry

#include "odometry/bundle/point_batches.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace evo::odometry {

namespace {

constexpr std::size_t kMinBatch = 64;  // points: fewer cost less than to hand them to a thread

}  // namespace

void ForEachIndex(ThreadPool* pool, std::size_t count, std::size_t chunk,
                  const std::function<void(std::size_t)>& work) {
  if (pool) {
    pool->ForEach(count, work, chunk);
  } else {
    for (std::size_t i = 0; i < count; ++i) work(i);
  }
}

PointBatches::PointBatches(const BundleProblem& problem, const std::vector<std::size_t>& first_observations,
                           ThreadPool* pool)
    : begins_({0}), pool_(pool) {
  const auto& begin = first_observations;
  const std::size_t count = problem.points.size();
  std::vector<int> earliest(count + 1, std::numeric_limits<int>::max());  // frame of this point and all after it
  for (std::size_t p = count; p-- > 0;) {
    earliest[p] = earliest[p + 1];
    if (begin[p] < begin[p + 1]) earliest[p] = std::min(earliest[p], problem.observations[begin[p]].frame);
  }
  int previous_last = -1;  // frame of the batch before the present one
  int last = -1;           // frame of the present batch
  for (std::size_t p = 0; p < count; ++p) {
    if (p - begins_.back() >= kMinBatch && earliest[p] > previous_last) {
      begins_.push_back(p);
      previous_last = std::exchange(last, -1);
    }
    if (begin[p] < begin[p + 1]) last = std::max(last, problem.observations[begin[p + 1] - 1].frame);
  }
  begins_.push_back(count);
}

void PointBatches::ForEachPoint(const std::function<void(std::size_t)>& work) const {
  const std::size_t batches = begins_.size() - 1;
  for (std::size_t parity = 0; parity < 2; ++parity) {
    ForEachIndex(pool_, (batches + 1 - parity) / 2, 1, [&](std::size_t i) {
      for (std::size_t p = begins_[parity + 2 * i]; p < begins_[parity + 2 * i + 1]; ++p) work(p);
    });
  }
}

}  // namespace evo::odometry

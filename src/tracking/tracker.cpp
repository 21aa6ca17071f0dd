#include "tracking/tracker.hpp"

#include "tracking/baseline/klt_tracker.hpp"
#include "tracking/feature_tracker.hpp"

namespace evo::tracking {

std::unique_ptr<Tracker> MakeTracker(const geometry::Camera& camera, const TrackerOptions& options, ThreadPool* pool) {
  if (options.method == "klt") return std::make_unique<KltTracker>(camera.width(), camera.height(), options, pool);
  return std::make_unique<FeatureTracker>(camera, options, pool);
}

}  // namespace evo::tracking

#include "evo/tracking/tracker.hpp"

#include "evo/core/format.hpp"
#include "evo/tracking/feature_tracker.hpp"
#include "evo/tracking/klt_tracker.hpp"

namespace evo {

std::unique_ptr<Tracker> MakeTracker(const Camera& camera, const TrackerOptions& options, ThreadPool* pool) {
  if (options.method == "klt") return std::make_unique<KltTracker>(camera.width(), camera.height(), options, pool);
  return std::make_unique<FeatureTracker>(camera, options, pool);
}

std::string DescribePositions(const TrackerOptions& options) {
  if (options.method != "klt") return "pixels of the raw sensor, each at the very instant of its stamp";
  return Format(
      "pixels of the raw sensor, in the image of the newest %d events, so late by half the time that these take",
      options.klt.events);
}

}  // namespace evo

#include "tracking/detection/corner_detector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "tracking/detection/harris.hpp"

namespace evo::tracking {

namespace {

constexpr double kStrongCorner = 0.95;  // quantile
constexpr int kBucketPx = 48;
constexpr float kSmallestResponse = std::numeric_limits<float>::min();

constexpr std::size_t kStripes = 2;  // of an image: more would cost more than they save

/// The flow within a tile: bilinear between its corners.
struct TileFlow {
  Eigen::Array2f origin, along_x, along_y, along_xy;  // px/s, for x and y in tiles
  float slowest;                                      // of the tile, roughly

  TileFlow(const FlowField& flow, double x, double y) {
    constexpr double kSide = events::EventHistory::kTilePx;
    const auto at = [&](double dx, double dy) -> Eigen::Array2f {
      return flow.At(x + dx * kSide, y + dy * kSide).cast<float>();
    };
    origin = at(0, 0);
    along_x = at(1, 0) - origin;
    along_y = at(0, 1) - origin;
    along_xy = at(1, 1) - origin - along_x - along_y;
    const Eigen::Array2f centre = origin + 0.5f * (along_x + along_y) + 0.25f * along_xy;
    const Eigen::Array2f change = 0.5f * (along_x.abs() + along_y.abs()) + 0.25f * along_xy.abs();
    slowest = centre.matrix().norm() - change.matrix().norm();
  }

  Eigen::Array2f At(float x, float y) const { return origin + x * along_x + y * (along_y + x * along_xy); }
};

/// Half of the window in which a flow moves an event by twice `motion_px`, within limits.
struct HalfWindowLimits {
  double motion_px, shortest_s, longest_s;

  double Of(double speed) const { return std::min(std::max(motion_px / std::max(speed, 1e-3), shortest_s), longest_s); }
};

void Vote(float x, float y, cv::Mat* image) {
  if (!(x >= 0.0f && y >= 0.0f)) return;
  const int c = static_cast<int>(x);
  const int r = static_cast<int>(y);
  if (c + 1 >= image->cols || r + 1 >= image->rows) return;
  const float fx = x - static_cast<float>(c);
  const float fy = y - static_cast<float>(r);
  float* const row = image->ptr<float>(r) + c;
  float* const below = image->ptr<float>(r + 1) + c;
  row[0] += (1 - fx) * (1 - fy);
  row[1] += fx * (1 - fy);
  below[0] += (1 - fx) * fy;
  below[1] += fx * fy;
}

void AddCorrectedTile(const events::EventHistory& history, std::size_t row, std::size_t column, TimeNs t,
                      const FlowField& flow, const HalfWindowLimits& limits, cv::Mat* image) {
  const int left = static_cast<int>(column) * events::EventHistory::kTilePx;
  const int top = static_cast<int>(row) * events::EventHistory::kTilePx;
  const TileFlow tile(flow, left, top);
  // No event of the tile has a longer window than its slowest; each is then asked for its own, without root and
  // quotient.
  const TimeNs longest = FromSeconds(limits.Of(tile.slowest));
  const auto shortest = static_cast<float>(limits.shortest_s);
  const auto motion2 = static_cast<float>(limits.motion_px * limits.motion_px);
  constexpr float kPerTile = 1.0f / events::EventHistory::kTilePx;
  history.ForEachInTile(row * history.tile_columns() + column, t - longest, t + longest,
                        [&](int x, int y, TimeNs event_t, std::int8_t) {
                          const Eigen::Array2f v =
                              tile.At(kPerTile * static_cast<float>(x - left), kPerTile * static_cast<float>(y - top));
                          const float dt = 1e-9f * static_cast<float>(event_t - t);
                          const Eigen::Array2f moved = dt * v;
                          if (std::abs(dt) > shortest && moved.matrix().squaredNorm() > motion2) return;
                          Vote(static_cast<float>(x) - moved.x(), static_cast<float>(y) - moved.y(), image);
                        });
}

struct Corner {
  float strength;
  int x, y;
};

/// Whether the positive values of a row are at least as large as their eight neighbours, at x in [begin, end).
void MarkMaxima(const float* above, const float* row, const float* below, int begin, int end, int* __restrict marks) {
  for (int x = begin; x < end; ++x) {
    const float upper = std::max(std::max(above[x - 1], above[x]), above[x + 1]);
    const float lower = std::max(std::max(below[x - 1], below[x]), below[x + 1]);
    const float beside = std::max(row[x - 1], row[x + 1]);
    marks[x] = row[x] >= std::max(std::max(upper, lower), std::max(beside, kSmallestResponse)) ? 1 : 0;
  }
}

struct Corners {
  std::vector<Corner> all;  ///< strongest first
  std::size_t strong = 0;   ///< so many reach the usual share of a strong one, the rest the smaller share
};

Corners FindCorners(const Harris& harris, int width, int height, const TrackerOptions& options, ThreadPool* pool) {
  const int border = static_cast<int>(std::ceil(options.border_px)) + 2;
  const int rows = std::max(0, height - 2 * border);
  std::array<std::vector<Corner>, kStripes> stripes;
  pool->ForEach(kStripes, [&](std::size_t i) {
    std::vector<int> marks(static_cast<std::size_t>(width));
    const int begin = border + static_cast<int>(i) * rows / static_cast<int>(kStripes);
    const int end = border + static_cast<int>(i + 1) * rows / static_cast<int>(kStripes);
    for (int y = begin; y < end; ++y) {
      MarkMaxima(harris.row(y - 1), harris.row(y), harris.row(y + 1), border, width - border, marks.data());
      for (int x = border; x < width - border; ++x) {
        if (marks[static_cast<std::size_t>(x)]) stripes[i].push_back({harris.row(y)[x], x, y});
      }
    }
  });
  std::vector<Corner> corners;
  for (const auto& stripe : stripes) corners.insert(corners.end(), stripe.begin(), stripe.end());
  if (corners.empty()) return {};
  const auto strong =
      corners.begin() + static_cast<std::ptrdiff_t>((1.0 - kStrongCorner) * static_cast<double>(corners.size()));
  std::ranges::nth_element(corners, strong, std::ranges::greater(), &Corner::strength);
  const auto usual = static_cast<float>(options.corner_quality_ratio * strong->strength);
  const auto weakest = std::min(usual, static_cast<float>(options.corner_min_quality_ratio * strong->strength));
  std::erase_if(corners, [&](const Corner& corner) { return corner.strength < weakest; });
  // A total order, so that equal responses do not depend on the sort.
  std::ranges::sort(corners, [](const Corner& a, const Corner& b) {
    return std::tuple(-a.strength, a.y, a.x) < std::tuple(-b.strength, b.y, b.x);
  });
  const auto end = std::ranges::find_if(corners, [&](const Corner& corner) { return corner.strength < usual; });
  const auto strong_ones = static_cast<std::size_t>(end - corners.begin());
  return {std::move(corners), strong_ones};
}

/// Events within `radius` px of (x, y), in x and in y.
double EventsAround(const cv::Mat& image, int x, int y, int radius) {
  const int left = std::max(0, x - radius);
  const int right = std::min(image.cols - 1, x + radius);
  double sum = 0.0;
  for (int r = std::max(0, y - radius); r <= std::min(image.rows - 1, y + radius); ++r) {
    const float* const row = image.ptr<float>(r);
    sum += std::accumulate(row + left, row + right + 1, 0.0f);
  }
  return sum;
}

/// Corners spread over the image.
class CornerSelection {
 public:
  CornerSelection(int width, int height, const std::vector<Eigen::Vector2d>& taken)
      : columns_((width + kBucketPx - 1) / kBucketPx),
        filled_(static_cast<std::size_t>(columns_ * ((height + kBucketPx - 1) / kBucketPx)), 0),
        occupied_(taken) {
    for (const auto& point : taken) ++Bucket(point.x(), point.y());
  }

  const std::vector<Eigen::Vector2d>& found() const { return found_; }

  /// Adds those of `corners`, strongest first, that are no nearer than `spacing_px` to others and that `fits` allows,
  /// until `count` are found. Fills the emptiest buckets first: round n accepts only corners whose bucket holds fewer
  /// than n features.
  template <typename Fits>
  void Add(std::span<const Corner> corners, std::size_t count, double spacing_px, const Fits& fits) {
    const double spacing2 = spacing_px * spacing_px;
    const int most = kBucketPx * kBucketPx / std::max(1, static_cast<int>(spacing2)) + 1;
    std::vector<char> used(corners.size(), 0);
    for (int round = 1; round <= most; ++round) {
      for (std::size_t i = 0; i < corners.size(); ++i) {
        if (found_.size() >= count) return;
        const Corner& corner = corners[i];
        if (used[i] || Bucket(corner.x, corner.y) >= round) continue;
        used[i] = 1;
        const Eigen::Vector2d point(corner.x, corner.y);
        if (std::ranges::any_of(occupied_, [&](const auto& o) { return (o - point).squaredNorm() < spacing2; })) {
          continue;
        }
        if (!fits(corner)) continue;
        ++Bucket(corner.x, corner.y);
        occupied_.push_back(point);
        found_.push_back(point);
      }
    }
  }

 private:
  int& Bucket(double x, double y) {
    return filled_[static_cast<std::size_t>(static_cast<int>(y) / kBucketPx * columns_ +
                                            static_cast<int>(x) / kBucketPx)];
  }

  int columns_;
  std::vector<int> filled_;  // features in each bucket
  std::vector<Eigen::Vector2d> occupied_;
  std::vector<Eigen::Vector2d> found_;
};

}  // namespace

cv::Mat CorrectedEventImage(const events::EventHistory& history, TimeNs t, const FlowField& flow, double motion_px,
                            const TrackerOptions& options, ThreadPool* pool) {
  // Events leave their tile, so each stripe of tiles has an image of its own. The stripes do not depend on the pool.
  std::array<cv::Mat, kStripes> stripes;
  const std::size_t rows = history.tile_rows();
  const HalfWindowLimits limits{0.5 * motion_px, 0.5 * options.min_window_s, 0.5 * options.max_window_s};
  pool->ForEach(kStripes, [&](std::size_t i) {
    stripes[i] = cv::Mat::zeros(history.height(), history.width(), CV_32F);
    for (std::size_t row = i * rows / kStripes; row < (i + 1) * rows / kStripes; ++row) {
      for (std::size_t column = 0; column < history.tile_columns(); ++column) {
        AddCorrectedTile(history, row, column, t, flow, limits, &stripes[i]);
      }
    }
  });
  for (std::size_t i = 1; i < kStripes; ++i) stripes[0] += stripes[i];
  return stripes[0];
}

std::vector<Eigen::Vector2d> DetectCorners(const cv::Mat& image, const std::vector<Eigen::Vector2d>& taken, int count,
                                           double min_events, const TrackerOptions& options, ThreadPool* pool,
                                           const std::function<bool(const Eigen::Vector2d&)>& is_wanted) {
  thread_local Harris harris;
  harris.Respond(image, pool);
  const Corners corners = FindCorners(harris, image.cols, image.rows, options, pool);
  // Asked only of corners that are tried: most never are.
  const auto fits = [&](const Corner& corner) {
    return is_wanted({corner.x, corner.y}) &&
           EventsAround(image, corner.x, corner.y, options.patch_radius_px) >= min_events;
  };
  CornerSelection selection(image.cols, image.rows, taken);
  const std::span<const Corner> all(corners.all), strong = all.first(corners.strong);
  const auto wanted = static_cast<std::size_t>(std::max(count, 0));
  selection.Add(strong, wanted, options.corner_spacing_px, fits);
  selection.Add(strong, wanted, options.corner_min_spacing_px, fits);
  selection.Add(all, wanted, options.corner_min_spacing_px, fits);
  return selection.found();
}

}  // namespace evo::tracking

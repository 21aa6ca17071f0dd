#include "tracking/detection/corner_detector.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "tracking/detection/harris.hpp"

namespace evo::tracking {

namespace {

constexpr double kStrongQuantile = 0.95;  // of all local maxima: the strongest one may be a single lamp
constexpr int kBucketPx = 48;             // corners are spread evenly over squares of this side
constexpr float kMinResponse = std::numeric_limits<float>::min();
constexpr std::size_t kStripes = 2;  // of the image, in parallel; more cost more than they save
constexpr int kBorderMarginPx = 2;   // a corner closer than this to the border would soon be lost

struct Corner {
  float response;
  int x, y;
};

struct Corners {
  std::vector<Corner> all;  ///< by descending response
  std::size_t strong = 0;   ///< number of those that reach the quality ratio; the rest reach the minimum quality ratio
};

/// Marks the positive values of a row, at x in [begin, end), that are at least as large as their eight neighbours.
void MarkMaxima(const float* above, const float* row, const float* below, int begin, int end, int* __restrict marks) {
  for (int x = begin; x < end; ++x) {
    const float upper = std::max(std::max(above[x - 1], above[x]), above[x + 1]);
    const float lower = std::max(std::max(below[x - 1], below[x]), below[x + 1]);
    const float beside = std::max(row[x - 1], row[x + 1]);
    marks[x] = row[x] >= std::max(std::max(upper, lower), std::max(beside, kMinResponse)) ? 1 : 0;
  }
}

/// Local maxima of the response, row by row.
std::vector<Corner> FindMaxima(const Harris& harris, int width, int height, int border, ThreadPool* pool) {
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
  std::vector<Corner> maxima;
  for (const auto& stripe : stripes) maxima.insert(maxima.end(), stripe.begin(), stripe.end());
  return maxima;
}

Corners FindCorners(const Harris& harris, int width, int height, const TrackerOptions& options, ThreadPool* pool) {
  const int border = static_cast<int>(std::ceil(options.border_px)) + kBorderMarginPx;
  std::vector<Corner> corners = FindMaxima(harris, width, height, border, pool);
  if (corners.empty()) return {};
  const auto quantile =
      corners.begin() + static_cast<std::ptrdiff_t>((1.0 - kStrongQuantile) * static_cast<double>(corners.size()));
  std::ranges::nth_element(corners, quantile, std::ranges::greater(), &Corner::response);
  const auto strong = static_cast<float>(options.corner_quality_ratio * quantile->response);
  const auto weak = std::min(strong, static_cast<float>(options.corner_min_quality_ratio * quantile->response));
  std::erase_if(corners, [&](const Corner& corner) { return corner.response < weak; });
  // A total order: the result does not depend on how a sort treats equal responses.
  std::ranges::sort(corners, [](const Corner& a, const Corner& b) {
    return std::tuple(-a.response, a.y, a.x) < std::tuple(-b.response, b.y, b.x);
  });
  const auto end = std::ranges::find_if(corners, [&](const Corner& corner) { return corner.response < strong; });
  const auto strong_count = static_cast<std::size_t>(end - corners.begin());
  return {std::move(corners), strong_count};
}

/// Number of events within `radius` px of the corner, in x and in y.
double CountEvents(const cv::Mat& image, const Corner& corner, int radius) {
  const int left = std::max(0, corner.x - radius);
  const int right = std::min(image.cols - 1, corner.x + radius);
  double sum = 0.0;
  for (int y = std::max(0, corner.y - radius); y <= std::min(image.rows - 1, corner.y + radius); ++y) {
    const float* const row = image.ptr<float>(y);
    sum += std::accumulate(row + left, row + right + 1, 0.0f);
  }
  return sum;
}

/// Selects corners that are spread over the image.
class CornerSelection {
 public:
  CornerSelection(int width, int height, const std::vector<Eigen::Vector2d>& taken)
      : columns_((width + kBucketPx - 1) / kBucketPx),
        counts_(static_cast<std::size_t>(columns_ * ((height + kBucketPx - 1) / kBucketPx)), 0),
        occupied_(taken) {
    for (const auto& point : taken) ++BucketCount(point.x(), point.y());
  }

  const std::vector<Eigen::Vector2d>& selected() const { return selected_; }

  /// Selects from `corners`, by descending response, those at least `spacing_px` from all others and with `is_valid`,
  /// until there are `count`. Round n accepts only corners whose bucket holds fewer than n features, so that the
  /// emptiest buckets fill first.
  template <typename IsValid>
  void Add(std::span<const Corner> corners, std::size_t count, double spacing_px, const IsValid& is_valid) {
    const double squared_spacing = spacing_px * spacing_px;
    const int rounds = kBucketPx * kBucketPx / std::max(1, static_cast<int>(squared_spacing)) + 1;
    std::vector<char> used(corners.size(), 0);
    for (int round = 1; round <= rounds; ++round) {
      for (std::size_t i = 0; i < corners.size(); ++i) {
        if (selected_.size() >= count) return;
        const Corner& corner = corners[i];
        if (used[i] || BucketCount(corner.x, corner.y) >= round) continue;
        used[i] = 1;
        const Eigen::Vector2d point(corner.x, corner.y);
        const auto is_close = [&](const auto& other) { return (other - point).squaredNorm() < squared_spacing; };
        if (std::ranges::any_of(occupied_, is_close) || !is_valid(corner)) continue;
        ++BucketCount(corner.x, corner.y);
        occupied_.push_back(point);
        selected_.push_back(point);
      }
    }
  }

 private:
  int& BucketCount(double x, double y) {
    return counts_[static_cast<std::size_t>(static_cast<int>(y) / kBucketPx * columns_ +
                                            static_cast<int>(x) / kBucketPx)];
  }

  int columns_;              // of buckets
  std::vector<int> counts_;  // features in each bucket
  std::vector<Eigen::Vector2d> occupied_;
  std::vector<Eigen::Vector2d> selected_;
};

}  // namespace

std::vector<Eigen::Vector2d> DetectCorners(const cv::Mat& image, const std::vector<Eigen::Vector2d>& taken, int count,
                                           double min_events, const TrackerOptions& options, ThreadPool* pool,
                                           const std::function<bool(const Eigen::Vector2d&)>& is_wanted) {
  thread_local Harris harris;
  harris.Respond(image, pool);
  const Corners corners = FindCorners(harris, image.cols, image.rows, options, pool);
  // Evaluated only for corners that are about to be selected, which most are not.
  const auto is_valid = [&](const Corner& corner) {
    return is_wanted({corner.x, corner.y}) && CountEvents(image, corner, options.patch_radius_px) >= min_events;
  };
  CornerSelection selection(image.cols, image.rows, taken);
  const std::span<const Corner> all(corners.all), strong = all.first(corners.strong);
  const auto wanted = static_cast<std::size_t>(std::max(count, 0));
  selection.Add(strong, wanted, options.corner_spacing_px, is_valid);
  selection.Add(strong, wanted, options.corner_min_spacing_px, is_valid);
  selection.Add(all, wanted, options.corner_min_spacing_px, is_valid);
  return selection.selected();
}

}  // namespace evo::tracking

#include "events/auto_mask/structure_flow.hpp"

#include <algorithm>
#include <limits>

namespace evo::events {

namespace {

constexpr TimeNs kMaxFarLag = 30'000'000;   // structure of 100 px/s passes kReach within it
constexpr TimeNs kMaxNearLag = 20'000'000;  // structure of 50 px/s passes a pixel within it
constexpr TimeNs kMinNearLag = 700'000;     // events at the same time have no order but that of the readout

}  // namespace

double StructureFlow::Pairs::Covariance() const {
  return count == 0 ? 0.0 : products - static_cast<double>(later) * static_cast<double>(earlier) / count;
}

StructureFlow::StructureFlow(int width, int height)
    : width_(width),
      height_(height),
      column_blocks_(std::max(1, width / kBlock)),
      row_blocks_(std::max(1, height / kBlock)) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  last_.assign(pixels, std::numeric_limits<TimeNs>::min() / 2);
  polarities_.assign(pixels, 0);
  for (Part& part : parts_) {
    part.columns.resize(static_cast<std::size_t>(column_blocks_ * height));
    part.rows.resize(static_cast<std::size_t>(row_blocks_ * width));
  }
}

void StructureFlow::Add(const EventColumns& events, int part) {
  Part& sums = parts_.at(static_cast<std::size_t>(part));
  for (std::size_t i = 0; i < events.size(); ++i) {
    const int x = events.x[i];
    const int y = events.y[i];
    const TimeNs t = events.t[i];
    const std::int8_t polarity = events.polarity[i];
    const auto pixel = static_cast<std::size_t>(y * width_ + x);
    Link* const column = &sums.columns[static_cast<std::size_t>(std::min(x / kBlock, column_blocks_ - 1) * height_)];
    Link* const row = &sums.rows[static_cast<std::size_t>(std::min(y / kBlock, row_blocks_ - 1) * width_)];
    const auto add = [&](std::size_t other, TimeNs min_lag, TimeNs max_lag, Pairs* pairs) {
      const TimeNs lag = t - last_[other];
      if (lag >= min_lag && lag < max_lag) pairs->Add(polarity, polarities_[other]);
    };
    const auto far = [&](std::size_t other, Link* link) { add(other, 0, kMaxFarLag, &link->far); };
    const auto stride = static_cast<std::size_t>(width_);
    if (y >= kReach) far(pixel - kReach * stride, &column[y - kReach]);
    if (y + kReach < height_) far(pixel + kReach * stride, &column[y]);
    if (x >= kReach) far(pixel - kReach, &row[x - kReach]);
    if (x + kReach < width_) far(pixel + kReach, &row[x]);
    const auto near = [&](std::size_t other, Pairs* pairs) { add(other, kMinNearLag, kMaxNearLag, pairs); };
    if (y >= 1) near(pixel - stride, &column[y - 1].ascending);
    if (y + 1 < height_) near(pixel + stride, &column[y].descending);
    if (x >= 1) near(pixel - 1, &row[x - 1].ascending);
    if (x + 1 < width_) near(pixel + 1, &row[x].descending);
    last_[pixel] = t;
    polarities_[pixel] = polarity;
  }
}

SideView StructureFlow::From(ImageSide side, int part) const {
  const Part& sums = parts_.at(static_cast<std::size_t>(part));
  const bool is_horizontal = side == ImageSide::kBottom || side == ImageSide::kTop;
  const bool is_ascending = side == ImageSide::kBottom || side == ImageSide::kRight;
  SideView view{.blocks = is_horizontal ? column_blocks_ : row_blocks_,
                .length = is_horizontal ? width_ : height_,
                .depth = is_horizontal ? height_ : width_,
                .links = {}};
  const std::vector<Link>& links = is_horizontal ? sums.columns : sums.rows;
  view.links.resize(links.size());
  for (int block = 0; block < view.blocks; ++block) {
    const auto at = [&](int d) { return static_cast<std::size_t>(block * view.depth + d); };
    for (int d = 0; d + kReach < view.depth; ++d) {
      const Pairs& far = links[at(is_ascending ? d : view.depth - 1 - d - kReach)].far;
      const Link& near = links[at(is_ascending ? d : view.depth - 2 - d)];
      const double ascending = near.ascending.Covariance() - near.descending.Covariance();
      view.links[at(d)] = {far.Covariance(), static_cast<double>(far.count), is_ascending ? ascending : -ascending,
                           static_cast<double>(near.ascending.count) + static_cast<double>(near.descending.count)};
    }
  }
  return view;
}

SideView StructureFlow::From(ImageSide side) const {
  SideView sum = From(side, 0);
  for (int part = 1; part < kParts; ++part) {
    const SideView view = From(side, part);
    for (std::size_t i = 0; i < sum.links.size(); ++i) sum.links[i].Add(view.links[i]);
  }
  return sum;
}

}  // namespace evo::events

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"

namespace evo::events {

enum class ImageSide { kBottom, kTop, kLeft, kRight };

/// What the events at neighbouring pixels say, summed over a block of such pairs of pixels. An edge that moves makes
/// them fire one after the other with the same polarity.
struct LinkFlow {
  double agreement = 0.0;      ///< covariance of the polarities `kReach` px apart, summed over pairs of events
  double pairs = 0.0;          ///< their number, which is the variance of the sum if the polarities are independent
  double outward = 0.0;        ///< as agreement, 1 px apart: pairs whose outer event is the later one minus the others
  double outward_pairs = 0.0;  ///< their number

  void Add(const LinkFlow& other) {
    agreement += other.agreement;
    pairs += other.pairs;
    outward += other.outward;
    outward_pairs += other.outward_pairs;
  }
};

/// The links seen from one side of the image: `depth` grows towards the side, `along` runs along it.
struct SideView {
  int blocks = 0;               ///< of `StructureFlow::kBlock` px along the side; the last one takes the rest
  int length = 0;               ///< px along the side
  int depth = 0;                ///< px
  std::vector<LinkFlow> links;  ///< blocks x depth: from the pixels at `d` to those farther out

  const LinkFlow& Link(int block, int d) const { return links[static_cast<std::size_t>(block * depth + d)]; }
  /// The block of a pixel along the side.
  std::size_t BlockAt(int along) const;
};

/// Measures where the structure in the image goes: an edge that moves makes neighbours fire one after the other with
/// the same polarity. Sums are kept for several parts of the recording, so that they can be compared.
class StructureFlow {
 public:
  static constexpr int kReach = 3;  // px: beyond the blur of an edge
  static constexpr int kBlock = 4;  // px
  static constexpr int kParts = 4;

  StructureFlow(int width, int height);

  /// Adds events later than those before to the sums of `part`.
  void Add(const EventColumns& events, int part);

  int width() const { return width_; }
  int height() const { return height_; }
  /// The sums of one part.
  SideView From(ImageSide side, int part) const;
  /// The sums of all parts.
  SideView From(ImageSide side) const;

 private:
  /// Polarities of pairs of events.
  struct Pairs {
    std::int32_t count = 0;
    std::int32_t products = 0;
    std::int32_t later = 0;
    std::int32_t earlier = 0;

    void Add(std::int8_t later_polarity, std::int8_t earlier_polarity) {
      ++count;
      products += later_polarity * earlier_polarity;
      later += later_polarity;
      earlier += earlier_polarity;
    }
    double Covariance() const;
  };
  struct Link {
    Pairs far;         // kReach px apart
    Pairs ascending;   // 1 px apart, the pixel with the higher coordinate fires later
    Pairs descending;  // 1 px apart, it fires first
  };
  struct Part {
    std::vector<Link> columns;  ///< blocks of columns x height: links between y and y + kReach
    std::vector<Link> rows;     ///< blocks of rows x width: links between x and x + kReach
  };

  int width_;
  int height_;
  int column_blocks_;
  int row_blocks_;
  std::vector<TimeNs> last_;             // by pixel: stamp of its last event
  std::vector<std::int8_t> polarities_;  // by pixel: of its last event
  std::array<Part, kParts> parts_;
};

inline std::size_t SideView::BlockAt(int along) const {
  return static_cast<std::size_t>(std::min(along / StructureFlow::kBlock, blocks - 1));
}

}  // namespace evo::events

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "simulation/world/street.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kStream = 0x7375726661636500;
constexpr double kZebra = 3.6;           // m along the road
constexpr double kLongestPiece = 8.0;    // m
constexpr double kLargestTurn = 0.03;    // rad from piece to piece
constexpr double kLayer = 0.0005;        // overlapping pieces in bends lie so far above one another, m
constexpr int kLaneTexels = 2048;        // length of the lanes' texture
constexpr double kTexelsPerMetre = 100;  // of pavements and kerbs

struct Piece {
  double from = 0.0;
  double to = 0.0;
  bool crossing = false;
  bool zebra = false;
};

class RoadPaver {
 public:
  explicit RoadPaver(const StreetTask& task) : plan_(task.plan), builder_(task.builder), random_(task.seed, kStream) {
    for (int& lanes : lanes_) lanes = builder_.Add(PaintLanes(random_, plan_.layout(), kLaneTexels));
    asphalt_ = builder_.Add(PaintAsphalt(random_, 1024));
    zebra_ = builder_.Add(PaintZebra(random_, plan_.layout(), 512));
    pavement_ = builder_.Add(PaintPavement(random_));
    kerb_ = builder_.Add(PaintKerb(random_));
    ground_ = builder_.Add(PaintGround(random_));
  }

  void Pave() {
    const std::vector<Piece> pieces = CutIntoPieces();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      PaveCarriageway(pieces[i], static_cast<int>(i));
      if (pieces[i].crossing) continue;
      for (const int side : {-1, 1}) PavePavement(pieces[i], side, static_cast<int>(i));
    }
    int index = 0;
    for (double s = plan_.begin(); s < plan_.end(); s += 10.0) PaveGround(s, std::min(s + 10.0, plan_.end()), index++);
  }

 private:
  double lane_period() const { return kLaneTexels * plan_.layout().width() / kRoadWidthTexels; }

  std::vector<Piece> CutIntoPieces() const {
    std::vector<double> cuts = {plan_.begin(), plan_.end()};
    for (double s = plan_.begin(); s < plan_.end(); s += lane_period()) cuts.push_back(s);
    for (const StreetPlan::Crossing& crossing : plan_.crossings()) {
      for (const double s : {crossing.from - kZebra, crossing.from, crossing.to, crossing.to + kZebra}) {
        cuts.push_back(s);
      }
    }
    std::sort(cuts.begin(), cuts.end());
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      for (double from = cuts[i]; cuts[i + 1] - from > 1e-6;) {
        const double sharpest = std::max(std::abs(plan_.Curvature(from)), std::abs(plan_.Curvature(from + 2.0)));
        const double to = from + std::clamp(kLargestTurn / std::max(sharpest, 1e-9), 0.25, kLongestPiece);
        Piece piece{from, cuts[i + 1] - to < 0.25 ? cuts[i + 1] : to};
        const double middle = 0.5 * (piece.from + piece.to);
        piece.crossing = !plan_.IsClearOfCrossings(middle, middle, 0.0);
        piece.zebra = !piece.crossing && !plan_.IsClearOfCrossings(middle, middle, kZebra);
        pieces.push_back(piece);
        from = piece.to;
      }
    }
    return pieces;
  }

  // A strip along the straight line from the road's point at `from` to that at `to`. In bends it is prolonged so that
  // no wedge stays open, and laid a little lower than its neighbours so that one of the two is clearly on top.
  // `texels_per_m` and `first`: texture coordinates.
  void AddStrip(double from, double to, double left, double right, double up, int layer, Look look) {
    const Eigen::Vector3d a = plan_.At(from, 0.0, up);
    const Eigen::Vector3d b = plan_.At(to, 0.0, up);
    const Eigen::Vector3d along = b - a;
    const double heading = std::atan2(along.x(), along.z());
    const Eigen::Vector3d across(std::cos(heading), 0.0, -std::sin(heading));
    const double widest = std::max(std::abs(left), std::abs(right));
    const double before = widest * std::abs(std::tan(heading - plan_.Heading(from)));
    const double after = widest * std::abs(std::tan(heading - plan_.Heading(to)));
    Eigen::Vector3d origin = a + left * across;
    Eigen::Vector3d edge = along;
    if (before + after > 1e-7) {
      const double length = along.norm();
      const double texels_per_m = look.texels.y() / length;
      origin += -before / length * along + Eigen::Vector3d(0.0, kLayer * (1 + layer % 2), 0.0);
      edge *= (length + before + after) / length;
      look.texel_origin.y() -= before * texels_per_m;
      look.texels.y() += (before + after) * texels_per_m;
    }
    builder_.Add(origin, (right - left) * across, edge, look, -Eigen::Vector3d::UnitY());
  }

  void PaveCarriageway(const Piece& piece, int layer) {
    const double texels_per_m = kRoadWidthTexels / plan_.layout().width();
    Look look;
    look.texels = {kRoadWidthTexels, (piece.to - piece.from) * texels_per_m};
    if (piece.zebra) {
      look.texture = zebra_;
      look.texel_origin.y() = 0.0;
      for (const StreetPlan::Crossing& crossing : plan_.crossings()) {
        for (const double start : {crossing.from - kZebra, crossing.to}) {
          const double along = piece.from - start;
          if (along > -1e-6 && along < kZebra) look.texel_origin.y() = along * texels_per_m;
        }
      }
    } else if (piece.crossing) {
      look.texture = asphalt_;
      look.texel_origin.y() = piece.from * texels_per_m;
    } else {
      // Each length of the texture another one, at times mirrored.
      const int block = static_cast<int>(std::floor((piece.from + 1e-6 - plan_.begin()) / lane_period()));
      look.texture = lanes_[block % 2];
      look.texel_origin.y() = (piece.from - plan_.begin()) * texels_per_m;
      if (block % 4 >= 2) {
        look.texel_origin.x() = kRoadWidthTexels;
        look.texels.x() = -kRoadWidthTexels;
      }
    }
    AddStrip(piece.from, piece.to, plan_.kerb(-1), plan_.kerb(1), 0.0, layer, look);
  }

  void PavePavement(const Piece& piece, int side, int layer) {
    const double length = piece.to - piece.from;
    Look look;
    look.texture = pavement_;
    look.texel_origin = {0.0, piece.from * kTexelsPerMetre};
    look.texels = {plan_.pavement() * kTexelsPerMetre, length * kTexelsPerMetre};
    const double inner = plan_.kerb(side);
    const double outer = plan_.house_line(side);
    AddStrip(piece.from, piece.to, std::min(inner, outer), std::max(inner, outer), kKerbHeight, layer, look);
    look.texture = kerb_;
    look.texel_origin = {piece.from * kTexelsPerMetre, 0.0};
    look.texels = {length * kTexelsPerMetre, 16.0};
    const Eigen::Vector3d a = plan_.At(piece.from, inner, kKerbHeight);
    const Eigen::Vector3d b = plan_.At(piece.to, inner, kKerbHeight);
    // A little deeper than the road, for bends.
    const Eigen::Vector3d down(0.0, kKerbHeight + 0.02, 0.0);
    builder_.Add(a, b - a, down, look, -side * plan_.Right(piece.from));
    look.texels.x() = plan_.pavement() * kTexelsPerMetre;
    for (const StreetPlan::Crossing& crossing : plan_.crossings()) {
      // The end of the pavement towards the crossing.
      const bool before = std::abs(piece.to - crossing.from) < 1e-6;
      if (!before && std::abs(piece.from - crossing.to) > 1e-6) continue;
      const double s = before ? crossing.from : crossing.to;
      builder_.Add(plan_.At(s, inner, kKerbHeight), plan_.At(s, outer, kKerbHeight) - plan_.At(s, inner, kKerbHeight),
                   down, look, (before ? 1.0 : -1.0) * plan_.Forward(s));
    }
  }

  // Grass and earth beneath all and on both sides, as wide as it does not reach another stretch of the road.
  void PaveGround(double from, double to, int layer) {
    double reach[2];
    for (const int side : {-1, 1}) {
      const double narrowest = std::abs(plan_.house_line(side)) + 0.3;
      double& width = reach[(side + 1) / 2];
      for (width = 50.0; width > narrowest; width *= 0.7) {
        if (plan_.IsFree({plan_.At(from, side * width, 0.0), plan_.At(to, side * width, 0.0)})) break;
      }
      width = std::max(width, narrowest);
    }
    Look look;
    look.texture = ground_;
    look.texel_origin = {0.0, from * 25.0};
    look.texels = {(reach[0] + reach[1]) * 25.0, (to - from) * 25.0};
    AddStrip(from, to, -reach[0], reach[1], -0.10 - 0.0001 * layer, layer, look);
  }

  const StreetPlan& plan_;
  SceneBuilder& builder_;
  Random random_;
  int lanes_[2] = {0, 0};
  int asphalt_ = 0;
  int zebra_ = 0;
  int pavement_ = 0;
  int kerb_ = 0;
  int ground_ = 0;
};

}  // namespace

void AddRoadSurface(const StreetTask& task) { RoadPaver(task).Pave(); }

}  // namespace evo::simulation

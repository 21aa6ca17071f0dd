#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/world/street.hpp"

namespace evo::simulation {

namespace {

constexpr std::uint64_t kStream = 0x7375726661636500;  // "surface"
constexpr double kZebra = 3.6;                         // m along the road
constexpr double kMaxPieceLength = 8.0;                // m
constexpr double kMaxPieceAngle = 0.03;                // rad from piece to piece: bends look smooth
constexpr double kLayer = 0.0005;                      // m: vertical distance of overlapping pieces in bends
constexpr int kLaneTexels = 2048;                      // length of the lanes' texture
constexpr double kTexelsPerMetre = 100;                // of pavements and kerbs
constexpr double kWetReflectivity = 0.3;               // of a wet road at the grazing angles of a camera on a car

struct Piece {
  double from = 0.0;
  double to = 0.0;
  bool junction = false;
  bool zebra = false;
};

class RoadPaver {
 public:
  explicit RoadPaver(const StreetContext& context)
      : plan_(context.plan),
        builder_(context.builder),
        random_(context.seed, kStream),
        wetness_(context.options.wetness) {
    const double contrast = context.options.road_contrast;
    for (int& lanes : lanes_) lanes = AddRoad(PaintLanes(random_, plan_.layout(), kLaneTexels, contrast));
    asphalt_ = AddRoad(PaintAsphalt(random_, 1024, contrast));
    zebra_ = AddRoad(PaintZebra(random_, plan_.layout(), 512, contrast));
    builder_.SetContrast(contrast);
    pavement_ = builder_.Add(PaintPavement(random_));
    builder_.SetContrast(1.0);
    kerb_ = builder_.Add(PaintKerb(random_));
    builder_.SetContrast(contrast);
    ground_ = builder_.Add(PaintGround(random_));
    builder_.SetContrast(1.0);
  }

  void Pave() {
    const std::vector<Piece> pieces = CutIntoPieces();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      PaveCarriageway(pieces[i], static_cast<int>(i));
      if (pieces[i].junction) continue;
      for (const int side : {-1, 1}) PavePavement(pieces[i], side, static_cast<int>(i));
    }
    int index = 0;
    for (double s = plan_.begin(); s < plan_.end(); s += 10.0) PaveGround(s, std::min(s + 10.0, plan_.end()), index++);
  }

 private:
  /// A wet road is a mirror, through which the lights' mirror images below it are seen.
  int AddRoad(Texture texture) {
    if (wetness_ > 0.0) texture.ScaleCoverage(static_cast<float>(1.0 - kWetReflectivity * wetness_));
    return builder_.Add(std::move(texture));
  }

  double lane_period() const { return kLaneTexels * plan_.layout().width() / kRoadWidthTexels; }

  std::vector<Piece> CutIntoPieces() const {
    std::vector<double> cuts = {plan_.begin(), plan_.end()};
    for (double s = plan_.begin(); s < plan_.end(); s += lane_period()) cuts.push_back(s);
    for (const StreetPlan::Junction& junction : plan_.junctions()) {
      for (const double s : {junction.from - kZebra, junction.from, junction.to, junction.to + kZebra}) {
        cuts.push_back(s);
      }
    }
    std::sort(cuts.begin(), cuts.end());
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      for (double from = cuts[i]; cuts[i + 1] - from > 1e-6;) {
        const double max_curvature = std::max(std::abs(plan_.Curvature(from)), std::abs(plan_.Curvature(from + 2.0)));
        const double to = from + std::clamp(kMaxPieceAngle / std::max(max_curvature, 1e-9), 0.25, kMaxPieceLength);
        Piece piece{from, cuts[i + 1] - to < 0.25 ? cuts[i + 1] : to};
        const double middle = 0.5 * (piece.from + piece.to);
        piece.junction = !plan_.IsClearOfJunctions(middle, middle, 0.0);
        piece.zebra = !piece.junction && !plan_.IsClearOfJunctions(middle, middle, kZebra);
        pieces.push_back(piece);
        from = piece.to;
      }
    }
    return pieces;
  }

  /// Adds a strip along the chord of the road between `from` and `to`. In bends it is extended, so that no wedge stays
  /// open, and lowered by its layer, so that overlapping strips do not coincide.
  void AddStrip(double from, double to, double left, double right, double up, int layer, Material material) {
    const Eigen::Vector3d a = plan_.PointAt(from, 0.0, up);
    const Eigen::Vector3d b = plan_.PointAt(to, 0.0, up);
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
      const double texels_per_m = material.texels.y() / length;
      origin += -before / length * along + Eigen::Vector3d(0.0, kLayer * (1 + layer % 2), 0.0);
      edge *= (length + before + after) / length;
      material.texel_origin.y() -= before * texels_per_m;
      material.texels.y() += (before + after) * texels_per_m;
    }
    builder_.Add(origin, (right - left) * across, edge, material, -Eigen::Vector3d::UnitY());
  }

  void PaveCarriageway(const Piece& piece, int layer) {
    const double texels_per_m = kRoadWidthTexels / plan_.layout().width();
    Material material;
    material.texels = {kRoadWidthTexels, (piece.to - piece.from) * texels_per_m};
    if (piece.zebra) {
      material.texture = zebra_;
      material.texel_origin.y() = 0.0;
      for (const StreetPlan::Junction& junction : plan_.junctions()) {
        for (const double start : {junction.from - kZebra, junction.to}) {
          const double along = piece.from - start;
          if (along > -1e-6 && along < kZebra) material.texel_origin.y() = along * texels_per_m;
        }
      }
    } else if (piece.junction) {
      material.texture = asphalt_;
      material.texel_origin.y() = piece.from * texels_per_m;
    } else {
      // Periods of the two lane textures alternate, every second pair mirrored.
      const int block = static_cast<int>(std::floor((piece.from + 1e-6 - plan_.begin()) / lane_period()));
      material.texture = lanes_[block % 2];
      material.texel_origin.y() = (piece.from - plan_.begin()) * texels_per_m;
      if (block % 4 >= 2) {
        material.texel_origin.x() = kRoadWidthTexels;
        material.texels.x() = -kRoadWidthTexels;
      }
    }
    AddStrip(piece.from, piece.to, plan_.kerb(-1), plan_.kerb(1), 0.0, layer, material);
  }

  void PavePavement(const Piece& piece, int side, int layer) {
    const double length = piece.to - piece.from;
    Material material;
    material.texture = pavement_;
    material.texel_origin = {0.0, piece.from * kTexelsPerMetre};
    material.texels = {plan_.pavement() * kTexelsPerMetre, length * kTexelsPerMetre};
    const double inner = plan_.kerb(side);
    const double outer = plan_.house_line(side);
    AddStrip(piece.from, piece.to, std::min(inner, outer), std::max(inner, outer), kKerbHeight, layer, material);
    material.texture = kerb_;
    material.texel_origin = {piece.from * kTexelsPerMetre, 0.0};
    material.texels = {length * kTexelsPerMetre, 16.0};
    const Eigen::Vector3d a = plan_.PointAt(piece.from, inner, kKerbHeight);
    const Eigen::Vector3d b = plan_.PointAt(piece.to, inner, kKerbHeight);
    // Kerbs reach below the road, which lies lower in bends.
    const Eigen::Vector3d down(0.0, kKerbHeight + 0.02, 0.0);
    builder_.Add(a, b - a, down, material, -side * plan_.Right(piece.from));
    material.texels.x() = plan_.pavement() * kTexelsPerMetre;
    for (const StreetPlan::Junction& junction : plan_.junctions()) {
      // The end of the pavement towards the junction.
      const bool before = std::abs(piece.to - junction.from) < 1e-6;
      if (!before && std::abs(piece.from - junction.to) > 1e-6) continue;
      const double s = before ? junction.from : junction.to;
      builder_.Add(plan_.PointAt(s, inner, kKerbHeight),
                   plan_.PointAt(s, outer, kKerbHeight) - plan_.PointAt(s, inner, kKerbHeight), down, material,
                   (before ? 1.0 : -1.0) * plan_.Forward(s));
    }
  }

  /// Adds ground beneath the road and on both sides, as far as it does not reach another part of the road.
  void PaveGround(double from, double to, int layer) {
    double reach[2];
    for (const int side : {-1, 1}) {
      const double narrowest = std::abs(plan_.house_line(side)) + 0.3;
      double& width = reach[(side + 1) / 2];
      for (width = 50.0; width > narrowest; width *= 0.7) {
        if (plan_.IsFree({plan_.PointAt(from, side * width, 0.0), plan_.PointAt(to, side * width, 0.0)})) break;
      }
      width = std::max(width, narrowest);
    }
    Material material;
    material.texture = ground_;
    material.texel_origin = {0.0, from * 25.0};
    material.texels = {(reach[0] + reach[1]) * 25.0, (to - from) * 25.0};
    const double up = -0.10 - 0.0001 * layer;
    if (wetness_ == 0.0) return AddStrip(from, to, -reach[0], reach[1], up, layer, material);
    AddStrip(from, to, -reach[0], plan_.kerb(-1), up, layer, material);
    AddStrip(from, to, plan_.kerb(1), reach[1], up, layer, material);
  }

  const StreetPlan& plan_;
  SceneBuilder& builder_;
  Random random_;
  double wetness_;
  int lanes_[2] = {0, 0};
  int asphalt_ = 0;
  int zebra_ = 0;
  int pavement_ = 0;
  int kerb_ = 0;
  int ground_ = 0;
};

}  // namespace

void AddRoadSurface(const StreetContext& context) { RoadPaver(context).Pave(); }

}  // namespace evo::simulation

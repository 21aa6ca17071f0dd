#pragma once

#include "evo/core/random.hpp"
#include "evo/simulation/texture.hpp"

namespace evo::simulation {

// What the surfaces of the simulated world look like. Each call draws another picture of the kind from `random`.

/// Lanes of the carriageway, across it in u. Lengths in metres.
struct CarriagewayLayout {
  double lanes_m = 7.0;    ///< both lanes
  double parking_m = 2.2;  ///< strip on each side of them
  bool bays = true;        ///< lines between the places of parked cars
  double width() const { return lanes_m + 2.0 * parking_m; }
};
inline constexpr int kRoadWidthTexels = 1024;
/// Asphalt with patches, cracks and tar; with a dashed centre line, edge lines and bays; with a zebra crossing.
/// Square texels of layout.width() / kRoadWidthTexels.
Texture PaintAsphalt(Random& random, int length);
Texture PaintLanes(Random& random, const CarriagewayLayout& layout, int length);
Texture PaintZebra(Random& random, const CarriagewayLayout& layout, int length);
/// 512 x 512 texels of 1 cm.
Texture PaintPavement(Random& random);
/// 512 x 16 texels of 1 cm.
Texture PaintKerb(Random& random);
/// 512 x 512 texels of 4 cm.
Texture PaintGround(Random& random);

/// Facades are drawn in cells of one window axis by one floor, kFacadeCell texels of about 2.5 cm square.
inline constexpr int kFacadeCell = 128;
inline constexpr int kFacadeAxes = 8;
inline constexpr int kFacadeFloors = 4;
Texture PaintUpperFloors(Random& random);
/// Shop windows, doors, shutters, signs; one floor high.
Texture PaintGroundFloor(Random& random);
/// A wall without windows, 512 x 512.
Texture PaintWall(Random& random);
/// A triangle of it on its base with holes beside it, 128 x 64.
Texture PaintGable(Random& random);
/// The panes of a window, 64 x 64, with holes where its frame and curtains are.
Texture PaintLitWindow(Random& random);
/// 256 x 256 texels of about 3 cm.
Texture PaintRoof(Random& random);

/// One crown, with holes between the leaves, 256 x 256.
Texture PaintFoliage(Random& random);
/// Leaves without a shape, to be repeated, 256 x 256.
Texture PaintHedge(Random& random);
Texture PaintBark(Random& random);
/// Pickets with gaps, 256 x 64 (width x height).
Texture PaintFence(Random& random);

/// Outline of a car seen from its side, with holes around it; 512 x 256: the front at u = 0, the foot of the wind
/// screen at 130, that of the rear window at `rear` (420 to 500, saloon to estate); the roof at v = 0, the bonnet at
/// 110.
Texture PaintCarSide(double rear);
/// Its end with number plate and lamps, 256 x 128, without windows; the rear's lamps are dark.
Texture PaintCarEnd(Random& random, bool front);
/// Its roof and bonnet.
Texture PaintCarPaint(Random& random);
Texture PaintCarGlass(Random& random);
/// The dark under a car, soft at its ends, 64 x 128.
Texture PaintCarShadow();

/// Lettering in a frame, 256 x 64; a round or square traffic sign, 64 x 64 with holes around it.
Texture PaintShopSign(Random& random);
Texture PaintTrafficSign(Random& random);
/// High-contrast shapes, 512 x 512; a few large ones; a picture like a photograph's; a printed box's side, 256 x 256.
Texture PaintPoster(Random& random);
Texture PaintPlacard(Random& random);
Texture PaintPicture(Random& random);
Texture PaintBoxSide(Random& random);
/// Of one reflectance with faint noise, 64 x 64.
Texture PaintPlain(Random& random, double reflectance);

}  // namespace evo::simulation

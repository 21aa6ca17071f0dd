#pragma once

#include "evo/core/random.hpp"
#include "simulation/world/texture.hpp"

namespace evo::simulation {

// Textures of the simulated world. Each call draws a random texture of its kind.

/// Cross-section of the carriageway, along u. Lengths in metres.
struct CarriagewayLayout {
  double lanes_m = 7.0;    ///< both lanes
  double parking_m = 2.2;  ///< strip on each side of them
  bool bays = true;        ///< marked parking bays
  double width() const { return lanes_m + 2.0 * parking_m; }
};
inline constexpr int kRoadWidthTexels = 1024;
// kRoadWidthTexels x `length` square texels of layout.width() / kRoadWidthTexels. `contrast` is that of the asphalt, 1
// for one with patches, cracks, tar and stains, 0 for a plain one. Markings keep theirs.
Texture PaintAsphalt(Random& random, int length, double contrast = 1.0);
/// Asphalt with a dashed centre line, edge lines and parking bays.
Texture PaintLanes(Random& random, const CarriagewayLayout& layout, int length, double contrast = 1.0);
/// Asphalt with a zebra crossing.
Texture PaintZebra(Random& random, const CarriagewayLayout& layout, int length, double contrast = 1.0);
/// 512 x 512 texels of 1 cm.
Texture PaintPavement(Random& random);
/// 512 x 16 texels of 1 cm.
Texture PaintKerb(Random& random);
/// 512 x 512 texels of 4 cm.
Texture PaintGround(Random& random);

// Facades consist of cells of one window axis by one floor: kFacadeCell x kFacadeCell texels of about 2.5 cm.
inline constexpr int kFacadeCell = 128;
inline constexpr int kFacadeAxes = 8;
inline constexpr int kFacadeFloors = 4;
Texture PaintUpperFloors(Random& random);
/// Shop windows, doors, shutters, signs; one floor high.
Texture PaintGroundFloor(Random& random);
/// A wall without windows, 512 x 512.
Texture PaintWall(Random& random);
/// A triangular wall with holes beside it, 128 x 64.
Texture PaintGable(Random& random);
/// The panes of a window, 64 x 64, with holes where its frame and curtains are.
Texture PaintLitWindow(Random& random);
/// 256 x 256 texels of about 3 cm.
Texture PaintRoof(Random& random);

/// One crown, with holes between the leaves, 256 x 256.
Texture PaintFoliage(Random& random);
/// A strip of leaves that repeats in u, 256 x 256.
Texture PaintHedge(Random& random);
Texture PaintBark(Random& random);
/// Pickets with gaps, 256 x 64 (width x height).
Texture PaintFence(Random& random);

/// The side of a car with holes around it, 512 x 256. The front lies at u = 0, the foot of the wind screen at 130, the
/// foot of the rear window at `rear` (420 to 500, saloon to estate), the roof at v = 0 and the bonnet at 110.
Texture PaintCarSide(double rear);
/// The front or rear of a car with number plate and lamps, without windows, 256 x 128.
Texture PaintCarEnd(Random& random, bool front);
/// Roof and bonnet, 64 x 64.
Texture PaintCarPaint(Random& random);
/// 64 x 64.
Texture PaintCarGlass(Random& random);
/// The shadow under a car with soft edges, 64 x 128.
Texture PaintCarShadow();

/// The frame and the wheels of a lorry below its box, with holes around them, 512 x 64.
Texture PaintChassis();
/// Head, trunk and arms of a pedestrian with holes around them, 64 x 128.
Texture PaintTorso(Random& random);

/// A spot of light with soft edges, 64 x 64.
Texture PaintGlow();

/// Lettering in a frame, 256 x 64.
Texture PaintShopSign(Random& random);
/// Round or square, with holes around it, 64 x 64.
Texture PaintTrafficSign(Random& random);
/// Many high-contrast shapes, 512 x 512.
Texture PaintPoster(Random& random);
/// A few large shapes, 512 x 512.
Texture PaintPlacard(Random& random);
/// Detail at all scales as in a photograph, 512 x 512.
Texture PaintPicture(Random& random);
/// A printed cardboard box, 256 x 256.
Texture PaintBoxSide(Random& random);
/// Uniform reflectance with faint noise, 64 x 64.
Texture PaintPlain(Random& random, double reflectance);

}  // namespace evo::simulation

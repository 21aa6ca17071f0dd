#pragma once

#include "evo/geometry/camera.hpp"

namespace evo::geometry {

/// The left DAVIS346 of MVSEC's outdoor_day, as published (A. Z. Zhu et al., RA-L 2018).
inline Calibration MvsecDavis346() {
  return {Distortion::kEquidistant,
          346,
          260,
          223.9940010790056,
          223.61783486959376,
          170.7684322973841,
          128.18711828338436,
          {-0.033904378348448685, -0.01537260902537579, -0.022284741346941413, 0.0069204143687187645, 0.0}};
}

/// The DAVIS240C of UZH's boxes, poster and slider sequences, as published (E. Mueggler et al., IJRR 2017).
inline Calibration UzhDavis240c() {
  return {Distortion::kRadTan,
          240,
          180,
          199.092366542,
          198.82882047,
          132.192071378,
          110.712660011,
          {-0.368436311798, 0.150947243557, -0.000296130534385, -0.000759431726241, 0.0}};
}

}  // namespace evo::geometry

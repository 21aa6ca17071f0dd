#include <algorithm>

#include "simulation/world/painter.hpp"
#include "simulation/world/textures.hpp"

namespace evo::simulation {

namespace {

constexpr int kWidth = kFacadeAxes * kFacadeCell;
constexpr int kHeight = kFacadeFloors * kFacadeCell;

int Between(Random& random, int low, int high) { return low + random.Index(high - low + 1); }

void PaintBricks(Random& random, Painter* painter, double reflectance) {
  constexpr int kBrickWidth = 8;
  constexpr int kBrickHeight = 4;
  for (int row = 0; row < painter->height() / kBrickHeight; ++row) {
    for (int column = 0; column < painter->width() / kBrickWidth; ++column) {
      painter->Rectangle(column * kBrickWidth + (row % 2) * kBrickWidth / 2, row * kBrickHeight, kBrickWidth - 1,
                         kBrickHeight - 1, reflectance * random.Uniform(0.75, 1.25));
    }
  }
}

/// Brick, plaster or concrete panels.
Painter MakeWallPainter(Random& random, int width, int height) {
  const int kind = random.Index(3);
  const double reflectance = kind == 0 ? random.Uniform(0.18, 0.34) : random.Uniform(0.3, 0.62);
  Painter painter(width, height, kind == 0 ? reflectance * 1.5 : reflectance);
  if (kind == 0) PaintBricks(random, &painter, reflectance);
  if (kind == 2) {
    for (int x = 0; x < width; x += kFacadeCell) painter.Rectangle(x, 0, 2, height, reflectance * 0.5);
    for (int y = 0; y < height; y += kFacadeCell / 2) painter.Rectangle(0, y, width, 2, reflectance * 0.5);
  }
  painter.Noise(random, 64, 128, 5, 0.015, 0.75);
  painter.Grain(random, 0.01);
  for (int i = 0; i < width / 64; ++i) {  // rain
    painter.TintGradient(random.Index(width), random.Index(height), Between(random, 3, 12), Between(random, 40, 120),
                         0.8, 1.0);
  }
  return painter;
}

struct WindowStyle {
  int width = 48;
  int height = 60;
  int panes_x = 2;
  int panes_y = 2;
  int frame = 3;
  double frame_reflectance = 0.7;
  bool shutters = false;
  bool sill = true;
  bool lintel = false;
};

WindowStyle DrawStyle(Random& random) {
  WindowStyle style;
  style.width = Between(random, 36, 72);
  style.height = Between(random, 46, 84);
  style.panes_x = Between(random, 1, 3);
  style.panes_y = Between(random, 1, 3);
  style.frame = Between(random, 2, 4);
  style.frame_reflectance = random.Chance(0.7) ? random.Uniform(0.6, 0.85) : random.Uniform(0.08, 0.2);
  style.shutters = style.width < 50 && random.Chance(0.5);
  style.sill = random.Chance(0.8);
  style.lintel = random.Chance(0.5);
  return style;
}

/// Dark glass with a reflection of the sky, some with a curtain or a blind.
void PaintGlass(Random& random, Painter* painter, int x, int y, int width, int height) {
  painter->Rectangle(x, y, width, height, random.Uniform(0.06, 0.13));
  if (random.Chance(0.35))
    painter->Rectangle(x, y, width, Between(random, height / 5, height), random.Uniform(0.3, 0.6));
  if (random.Chance(0.4)) {
    const int curtain = Between(random, width / 8, width / 3);
    painter->Rectangle(x, y, curtain, height, 0.45);
    painter->Rectangle(x + width - curtain, y, curtain, height, 0.45);
  }
  painter->TintGradient(x, y, width, height, random.Uniform(1.3, 2.2), 1.0);
}

void PaintWindow(Random& random, Painter* painter, int x, int y, const WindowStyle& style) {
  if (style.shutters) {
    const int leaf = style.width / 2;
    const double reflectance = random.Uniform(0.12, 0.35);
    for (const int left : {x - leaf - 2, x + style.width + 2}) {
      painter->Rectangle(left, y, leaf, style.height, reflectance);
      for (int j = 3; j < style.height; j += 5) painter->Tint(left + 2, y + j, leaf - 4, 2, 0.5);
    }
  }
  painter->Rectangle(x - 2, y - 2, style.width + 4, style.height + 4, 0.12);  // the shadow in the opening
  PaintGlass(random, painter, x, y, style.width, style.height);
  painter->Outline(x, y, style.width, style.height, style.frame, style.frame_reflectance);
  for (int i = 1; i < style.panes_x; ++i) {
    painter->Rectangle(x + i * style.width / style.panes_x - 1, y, 2, style.height, style.frame_reflectance);
  }
  for (int i = 1; i < style.panes_y; ++i) {
    painter->Rectangle(x, y + i * style.height / style.panes_y - 1, style.width, 2, style.frame_reflectance);
  }
  if (style.lintel) painter->Rectangle(x - 5, y - 9, style.width + 10, 7, 0.6);
  if (style.sill) {
    painter->Rectangle(x - 5, y + style.height + 1, style.width + 10, 5, 0.65);
    painter->Tint(x - 5, y + style.height + 6, style.width + 10, 5, 0.55);
  }
}

void PaintShopWindow(Random& random, Painter* painter, int x) {
  painter->Rectangle(x + 8, 36, 112, 78, 0.08);
  for (int i = 0; i < 9; ++i) {  // goods on display
    const int height = Between(random, 8, 40);
    painter->Rectangle(x + Between(random, 12, 100), 112 - height, Between(random, 5, 16), height,
                       random.Uniform(0.12, 0.7));
  }
  painter->Outline(x + 8, 36, 112, 78, 3, random.Uniform(0.15, 0.7));
  painter->Rectangle(x + 63, 36, 2, 78, 0.5);
  const double board = random.Chance(0.5) ? 0.12 : 0.7;
  painter->Rectangle(x + 4, 8, 120, 24, board);
  painter->Lettering(random, x + 12, 12, 100, 14, board > 0.4 ? 0.1 : 0.8);
  painter->Tint(x + 4, 32, 120, 4, 0.4);
}

void PaintDoor(Random& random, Painter* painter, int x) {
  const double reflectance = random.Uniform(0.1, 0.5);
  painter->Rectangle(x + 36, 24, 56, 104, 0.7);
  painter->Rectangle(x + 42, 30, 44, 98, reflectance);
  for (const int y : {36, 66, 96}) {
    painter->Outline(x + 47, y, 15, 25, 2, reflectance * 0.5);
    painter->Outline(x + 66, y, 15, 25, 2, reflectance * 0.5);
  }
  painter->Ellipse(x + 82, 84, 2.0, 2.0, 0.85);
  painter->Rectangle(x + 98, 50, 8, 10, 0.8);  // number
}

void PaintShutter(Random& random, Painter* painter, int x) {
  const double reflectance = random.Uniform(0.25, 0.6);
  painter->Rectangle(x + 10, 22, 108, 106, reflectance);
  for (int y = 26; y < 128; y += 6) painter->Rectangle(x + 10, y, 108, 2, reflectance * 0.5);
  if (random.Chance(0.5)) {
    for (int i = 0; i < 3; ++i) painter->Crack(random, x + 40.0, 80.0, 70.0, 4.0, random.Chance(0.5) ? 0.1 : 0.8);
  }
}

}  // namespace

Texture PaintUpperFloors(Random& random) {
  Painter painter = MakeWallPainter(random, kWidth, kHeight);
  const WindowStyle style = DrawStyle(random);
  const bool ledges = random.Chance(0.6);
  const bool pilasters = random.Chance(0.35);
  for (int axis = 0; axis < kFacadeAxes && pilasters; ++axis) {
    painter.Tint(axis * kFacadeCell - 6, 0, 12, kHeight, 1.35);
    painter.Tint(axis * kFacadeCell + 6, 0, 2, kHeight, 0.5);
  }
  for (int floor = 0; floor < kFacadeFloors; ++floor) {
    const int top = floor * kFacadeCell;
    if (ledges) {
      painter.Rectangle(0, top, kWidth, 6, 0.62);
      painter.Tint(0, top + 6, kWidth, 4, 0.45);
    }
    for (int axis = 0; axis < kFacadeAxes; ++axis) {
      if (random.Chance(0.06)) continue;  // a blind axis
      PaintWindow(random, &painter, axis * kFacadeCell + (kFacadeCell - style.width) / 2,
                  top + (kFacadeCell - style.height) / 2, style);
    }
  }
  return painter.Finish();
}

Texture PaintGroundFloor(Random& random) {
  Painter painter = MakeWallPainter(random, kWidth, kFacadeCell);
  painter.Rectangle(0, 0, kWidth, 5, 0.6);
  painter.Tint(0, 5, kWidth, 3, 0.5);
  painter.Tint(0, 112, kWidth, 16, 0.7);
  const WindowStyle style = DrawStyle(random);
  for (int axis = 0; axis < kFacadeAxes; ++axis) {
    const int x = axis * kFacadeCell;
    switch (random.Index(5)) {
      case 0:
        PaintDoor(random, &painter, x);
        break;
      case 1:
        PaintShutter(random, &painter, x);
        break;
      case 2:
        PaintWindow(random, &painter, x + (kFacadeCell - style.width) / 2, 26, style);
        break;
      default:
        PaintShopWindow(random, &painter, x);
    }
  }
  return painter.Finish();
}

Texture PaintWall(Random& random) {
  Painter painter = MakeWallPainter(random, 512, 512);
  return painter.Finish();
}

Texture PaintGable(Random& random) {
  Painter painter = MakeWallPainter(random, 128, 64);
  for (int y = 0; y < 64; ++y) {
    painter.CutHole(0, y, 63 - y, 1);
    painter.CutHole(65 + y, y, 63 - y, 1);
  }
  return painter.Finish();
}

Texture PaintLitWindow(Random& random) {
  Painter painter(64, 64, 0.5);
  painter.CutHole(30, 0, 4, 64);
  painter.CutHole(0, 20, 64, 3);
  const int curtain = Between(random, 6, 12);
  painter.CutHole(0, 0, curtain, 64);
  painter.CutHole(64 - curtain, 0, curtain, 64);
  return painter.Finish();
}

Texture PaintRoof(Random& random) {
  const double reflectance = random.Uniform(0.15, 0.35);
  Painter painter(256, 256, reflectance);
  for (int row = 0; row < 256; row += 8) {
    for (int column = 0; column < 256; column += 8) {
      painter.Rectangle(column, row, 7, 6, reflectance * random.Uniform(0.75, 1.25));
    }
    painter.Rectangle(0, row + 6, 256, 2, reflectance * 0.5);
  }
  painter.Noise(random, 64, 64, 3, 0.02);
  return painter.Finish();
}

}  // namespace evo::simulation

#pragma once

#include <random>

namespace evo::odometry {

/// Independent signs, +1 or -1 with equal probability. The same on every platform, which the standard library's
/// distributions are not.
class RademacherSigns {
 public:
  explicit RademacherSigns(unsigned seed) : random_(seed) {}

  double Next() { return random_() % 2 == 0 ? 1.0 : -1.0; }

 private:
  std::mt19937 random_;
};

}  // namespace evo::odometry

#include "evo/core/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace evo {

namespace {

constexpr int kBarWidth = 30;  // characters
constexpr auto kRedrawInterval = std::chrono::milliseconds(100);

}  // namespace

Progress::Progress(std::string label, bool enabled)
    : label_(std::move(label)),
      enabled_(enabled && ::isatty(STDERR_FILENO) != 0),
      start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
  if (enabled_) std::fputs("\r\033[K", stderr);
}

void Progress::Update(double fraction) {
  if (!enabled_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - drawn_ < kRedrawInterval) return;
  drawn_ = now;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int filled = static_cast<int>(fraction * kBarWidth);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double left = fraction > 0.01 ? elapsed * (1.0 - fraction) / fraction : 0.0;
  fmt::print(stderr, "\r{:<9} [{:#<{}}{:{}}] {:3.0f} %  {:.0f} s left\033[K", label_, "", filled, "",
             kBarWidth - filled, 100.0 * fraction, left);
  std::fflush(stderr);
}

}  // namespace evo

#include "report/tables/run_measures.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace evo::report {

const std::vector<RunMeasure>& RunMeasures() {
  static const std::vector<RunMeasure> kMeasures{{"path_m", "Path", "m", 1.0, 1},
                                                 {"coverage", "Coverage", "%", 100.0, 1},
                                                 {"mean_abs_longitudinal_m", "Longitudinal", "m", 1.0, 4},
                                                 {"mean_abs_lateral_m", "Lateral", "m", 1.0, 4},
                                                 {"mean_planar_m", "Planar", "m", 1.0, 4},
                                                 {"mean_planar_percent", "Planar", "%", 1.0, 3},
                                                 {"max_planar_percent", "Max planar", "%", 1.0, 3},
                                                 {"ape_rmse_m", "APE RMSE", "m", 1.0, 4},
                                                 {"lifetime_mean_frames", "Lifetime", "frames", 1.0, 1},
                                                 {"speed_x_real_time", "Speed", "x real time", 1.0, 2}};
  return kMeasures;
}

std::optional<double> ParseMeasure(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [last, failure] = std::from_chars(text.data(), end, value);
  if (failure != std::errc() || last != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string FormatMeasure(const RunMeasure& measure, const std::string& cell) {
  const auto value = ParseMeasure(cell);
  return value ? fmt::format("{:.{}f}", measure.factor * *value, measure.decimals) : "";
}

}  // namespace evo::report

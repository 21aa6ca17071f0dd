#include <fmt/format.h>

#include <algorithm>

#include "evo/report/figures.hpp"
#include "report/figures/figure_style.hpp"

namespace evo::report {

Figure TrackErrorFigure(const std::string& name, const evaluation::TrackAccuracy& accuracy) {
  std::string data =
      fmt::format("# age (s, middle of the bin), error p25 (px), median, p75, tracks; truth: {}\n", accuracy.truth);
  double max_age = 1e-6;
  double max_error = 1e-3;
  std::int64_t max_tracks = 1;
  for (const auto& bin : accuracy.error_over_age) {
    data += DataRow(
        {0.5 * (bin.low_s + bin.high_s), bin.p25_px, bin.median_px, bin.p75_px, static_cast<double>(bin.tracks)});
    max_age = std::max(max_age, bin.high_s);
    max_error = std::max(max_error, bin.p75_px);
    max_tracks = std::max(max_tracks, bin.tracks);
  }
  if (accuracy.error_over_age.empty()) data += "0 0 0 0 0\n";  // gnuplot refuses a file without data

  const bool triangulated = accuracy.truth == "triangulated";
  std::string script =
      BeginFigure(triangulated ? "Triangulation residual over track age" : "Track error over track age");
  script += fmt::format(
      "set border 11 linecolor '#404040'\n"
      "set xrange [0:{}]\n"
      "set xlabel 'track age (s)'\n"
      "set yrange [0:{}]\n"
      "set ylabel '{} (px)'\n"
      "set y2range [0:{}]\n"
      "set y2tics textcolor '#202020'\n"
      "set y2label 'tracks of this age (count)' offset 1\n"
      "set style fill solid 0.35 noborder\n"
      "data = '{}.dat'\n",
      FormatNumber(max_age), FormatNumber(1.1 * max_error), triangulated ? "triangulation residual" : "track error",
      FormatNumber(1.1 * static_cast<double>(max_tracks)), name);
  script += fmt::format(
      "plot data using 1:2:4 with filledcurves linecolor '{}' title 'quartiles', \\\n"
      "  data using 1:3 with linespoints linewidth 3 pointtype 7 pointsize 0.4 linecolor '{}' title 'median', \\\n"
      "  data using 1:5 axes x1y2 with lines linewidth 2 dashtype (8,4) linecolor '{}' title 'tracks (right axis)'\n",
      kSkyBlue, kBlue, kVermilion);
  return {data, script};
}

}  // namespace evo::report

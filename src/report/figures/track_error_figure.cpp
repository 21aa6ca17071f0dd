#include <algorithm>
#include <sstream>

#include "evo/report/track_report.hpp"
#include "report/figures/figure_style.hpp"

namespace evo::report {

Figure TrackErrorFigure(const std::string& name, const evaluation::TrackAccuracy& accuracy) {
  std::ostringstream data;
  data << "# age (s, middle of the bin), error p25 (px), median, p75, tracks; truth: " << accuracy.truth << '\n';
  double end = 1e-6;
  double highest = 1e-3;
  std::int64_t most = 1;
  for (const auto& bin : accuracy.error_over_age) {
    AppendRow(data,
              {0.5 * (bin.low_s + bin.high_s), bin.p25_px, bin.median_px, bin.p75_px, static_cast<double>(bin.tracks)});
    end = std::max(end, bin.high_s);
    highest = std::max(highest, bin.p75_px);
    most = std::max(most, bin.tracks);
  }
  if (accuracy.error_over_age.empty()) data << "0 0 0 0 0\n";  // gnuplot refuses a file without data

  std::ostringstream script;
  script << kStyle << "set border 11 linecolor '#404040'\n"
         << "set xrange [0:" << Number(end) << "]\n"
         << "set xlabel 'age of the track (s)'\n"
         << "set yrange [0:" << Number(1.1 * highest) << "]\n"
         << "set ylabel '"
         << (accuracy.truth == "triangulated" ? "residual of the triangulation" : "error of the track") << " (px)'\n"
         << "set y2range [0:" << Number(1.1 * static_cast<double>(most)) << "]\n"
         << "set y2tics textcolor '#202020'\n"
         << "set y2label 'tracks of this age' offset 1\n"
         << "set style fill solid 0.35 noborder\n"
         << "data = '" << name << ".dat'\n"
         << "plot data using 1:2:4 with filledcurves linecolor '" << kSkyBlue << "' title 'quartiles', \\\n"
         << "  data using 1:3 with linespoints linewidth 3 pointtype 7 pointsize 0.4 linecolor '" << kBlue
         << "' title 'median', \\\n"
         << "  data using 1:5 axes x1y2 with lines linewidth 2 dashtype (8,4) linecolor '" << kVermilion
         << "' title 'tracks'\n";
  return {data.str(), script.str()};
}

}  // namespace evo::report

#include <algorithm>
#include <sstream>

#include "evo/report/figures.hpp"
#include "report/figures/figure_style.hpp"

namespace evo::report {

namespace {

constexpr const char* kMeanStyle = "lines linewidth 3 dashtype (8,4) linecolor";

/// A line across the figure at the mean, told in the legend by the `plot` element that MeanTitle makes.
std::string MeanTitle(const std::string& text) {
  return std::string("NaN with ") + kMeanStyle + " '" + kVermilion + "' title '" + text + "'";
}

/// Boxes of the bins with the mean; `quantity` is the label below them.
template <typename Bin>
Figure HistogramFigure(const std::string& name, const evaluation::LifetimeStatistics& statistics,
                       std::span<const Bin> histogram, const evaluation::LifetimeMoments& moments,
                       const std::string& unit) {
  std::ostringstream data;
  data << "# lifetime from (" << unit << "), to below (" << unit << "), tracks\n";
  std::int64_t most = 1;
  for (const auto& bin : histogram) {
    AppendRow(data, {static_cast<double>(bin.low), static_cast<double>(bin.high), static_cast<double>(bin.tracks)});
    most = std::max(most, bin.tracks);
  }
  if (histogram.empty()) data << "0 1 0\n";  // gnuplot refuses a file without data

  const std::string mean = Number(moments.mean);
  const std::string top = Number(1.05 * static_cast<double>(most));
  std::ostringstream script;
  script << kStyle << "set xrange [0:" << Number(histogram.empty() ? 1.0 : histogram.back().high) << "]\n"
         << "set yrange [0:" << top << "]\n"
         << "set grid noxtics\n"
         << "set xlabel 'lifetime (" << unit << ")'\n"
         << "set ylabel 'tracks'\n"
         << "set style fill solid 0.8 border linecolor '" << kBlue << "'\n"
         << "set arrow from " << mean << ",0 to " << mean << "," << top
         << " nohead linewidth 3 dashtype (8,4) linecolor '" << kVermilion << "' front\n"
         << "plot '" << name << ".dat' using (0.5 * ($1 + $2)):3:($2 - $1) with boxes linecolor '" << kSkyBlue
         << "' title '" << statistics.tracks << " tracks of " << evaluation::kFewestFrames << " frames or more', \\\n  "
         << MeanTitle("mean " + Print("%.3f", moments.mean) + ", std " + Print("%.3f", moments.standard_deviation))
         << "\n";
  return {data.str(), script.str()};
}

}  // namespace

Figure LifetimeFigure(const std::string& name, const evaluation::LifetimeStatistics& statistics) {
  return HistogramFigure<evaluation::LifetimeBin>(name, statistics, statistics.histogram, statistics.in_frames,
                                                  "frames");
}

Figure LifetimeSecondsFigure(const std::string& name, const evaluation::LifetimeStatistics& statistics) {
  return HistogramFigure<evaluation::LifetimeSecondsBin>(name, statistics, statistics.histogram_seconds,
                                                         statistics.in_seconds, "s");
}

Figure LiveFeaturesFigure(const std::string& name, std::span<const LiveFeatures> frames) {
  std::ostringstream data;
  data << "# seconds since the first frame, live features\n";
  double mean = 0.0;
  Range time{0.0, 1e-3};
  Range features{0.0, 1.0};
  for (const auto& frame : frames) {
    const double seconds = ToSeconds(frame.t - frames.front().t);
    const auto live = static_cast<double>(frame.features);
    AppendRow(data, {seconds, live});
    mean += live / static_cast<double>(frames.size());
    time.Add(seconds);
    features.Add(live);
  }
  features.high *= 1.05;

  std::ostringstream script;
  script << kStyle << "set xrange " << time << "\n"
         << "set yrange " << features << "\n"
         << "set xlabel 'time (s)'\n"
         << "set ylabel 'live features'\n"
         << "plot " << Number(mean) << " with " << kMeanStyle << " '" << kVermilion << "' title 'mean "
         << Print("%.1f", mean) << "', \\\n  "
         << Curve{"'" + name + ".dat'", frames.size(), "1:2", std::string("linewidth 2 linecolor '") + kBlue + "'",
                  "features seen in the event frame"}
         << "\n";
  return {data.str(), script.str()};
}

}  // namespace evo::report

#include <fmt/format.h>

#include <algorithm>

#include "evo/report/figures.hpp"
#include "report/figures/figure_style.hpp"

namespace evo::report {

namespace {

constexpr const char* kMeanStyle = "linewidth 3 dashtype (8,4) linecolor";

/// A histogram with a line at its mean; `unit` is that of the lifetimes.
template <typename Bin>
Figure HistogramFigure(const std::string& name, const evaluation::LifetimeStatistics& statistics,
                       std::span<const Bin> histogram, const evaluation::LifetimeSummary& summary,
                       const std::string& unit) {
  std::string data = fmt::format("# lifetime from ({0}), to below ({0}), tracks\n", unit);
  std::int64_t max_tracks = 1;
  for (const auto& bin : histogram) {
    data += DataRow({static_cast<double>(bin.low), static_cast<double>(bin.high), static_cast<double>(bin.tracks)});
    max_tracks = std::max(max_tracks, bin.tracks);
  }
  if (histogram.empty()) data += "0 1 0\n";  // gnuplot refuses a file without data

  const std::string top = FormatNumber(1.05 * static_cast<double>(max_tracks));
  std::string script = BeginFigure("Lifetime of feature tracks");
  script += fmt::format(
      "set xrange [0:{}]\n"
      "set yrange [0:{}]\n"
      "set grid noxtics\n"
      "set xlabel 'lifetime ({})'\n"
      "set ylabel 'tracks (count)'\n"
      "set style fill solid 0.8 border linecolor '{}'\n"
      "set arrow from {},0 to {},{} nohead {} '{}' front\n",
      FormatNumber(histogram.empty() ? 1.0 : histogram.back().high), top, unit, kBlue, FormatNumber(summary.mean),
      FormatNumber(summary.mean), top, kMeanStyle, kVermilion);
  script += fmt::format(
      "plot '{}.dat' using (0.5 * ($1 + $2)):3:($2 - $1) with boxes linecolor '{}' title '{} tracks of at least {} "
      "frames', \\\n"
      "  NaN with lines {} '{}' title 'mean {:.3f}, std {:.3f} {}'\n",
      name, kSkyBlue, statistics.tracks, evaluation::kMinLifetimeFrames, kMeanStyle, kVermilion, summary.mean,
      summary.standard_deviation, unit);
  return {data, script};
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
  std::string data = "# seconds since the first frame, live features\n";
  double mean = 0.0;
  Range time{0.0, 1e-3};
  Range features{0.0, 1.0};
  for (const auto& frame : frames) {
    const double seconds = ToSeconds(frame.t - frames.front().t);
    const auto live = static_cast<double>(frame.features);
    data += DataRow({seconds, live});
    mean += live / static_cast<double>(frames.size());
    time.Add(seconds);
    features.Add(live);
  }
  features.high *= 1.05;

  std::string script = BeginFigure("Live features");
  script += fmt::format(
      "set xrange {}\n"
      "set yrange {}\n"
      "set xlabel 'time since the first event frame (s)'\n"
      "set ylabel 'live features (count)'\n"
      "plot {} with lines {} '{}' title 'mean {:.1f}', \\\n  {}\n",
      FormatRange(time), FormatRange(features), FormatNumber(mean), kMeanStyle, kVermilion, mean,
      PlotElements({"'" + name + ".dat'", frames.size(), "1:2", fmt::format("linewidth 2 linecolor '{}'", kBlue),
                    "features in the event frame"}));
  return {data, script};
}

}  // namespace evo::report

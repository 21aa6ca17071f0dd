#include "evo/report/figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

namespace evo {

namespace {

// Okabe & Ito.
constexpr const char* kBlue = "#0072B2";
constexpr const char* kVermilion = "#D55E00";
constexpr const char* kSkyBlue = "#56B4E9";
// The truth lies wide and light under the thin dark estimate: told apart in grey as well.
constexpr const char* kTruthBlue = "#7DB7E8";
constexpr const char* kEstimateGreen = "#00664A";

constexpr const char* kStyle =
    "set border 3 linecolor '#404040'\n"
    "set tics out nomirror textcolor '#202020'\n"
    "set grid linecolor '#d8d8d8' linetype 1 linewidth 0.5\n"
    "set key outside top center horizontal maxrows 1 samplen 2.5\n";

std::string Print(const char* format, double value) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string Number(double value) { return Print("%.6f", value); }

/// The two axes of the world that span the ground as seen from above: right x away = towards the viewer.
struct MapAxes {
  int right = 0;
  int away = 1;
};

MapAxes ChooseMapAxes(const Eigen::Vector3d& up) {
  Eigen::Index axis = 0;
  up.cwiseAbs().maxCoeff(&axis);
  const int next = static_cast<int>(axis + 1) % 3;
  const int after = static_cast<int>(axis + 2) % 3;
  return up[axis] > 0.0 ? MapAxes{next, after} : MapAxes{after, next};
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void Add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  double length() const { return high - low; }
  void WidenTo(double wanted) {
    const double missing = std::max(0.0, wanted - length());
    low -= 0.5 * missing;
    high += 0.5 * missing;
  }
};

std::ostream& operator<<(std::ostream& out, const Range& range) {
  return out << '[' << Number(range.low) << ':' << Number(range.high) << ']';
}

/// One block of a data file: seconds, right, away; an empty line breaks the curve at a gap.
void AppendTrack(std::ostream& data, const Trajectory& track, const MapAxes& axes, TimeNs start, TimeNs longest_gap) {
  for (std::size_t i = 0; i < track.size(); ++i) {
    if (i > 0 && track[i].t - track[i - 1].t > longest_gap) data << '\n';
    const Eigen::Vector3d& p = track[i].T_world_cam.translation();
    data << Number(ToSeconds(track[i].t - start)) << ' ' << Number(p[axes.right]) << ' ' << Number(p[axes.away])
         << '\n';
  }
}

}  // namespace

Figure TrajectoryFigure(const std::string& name, const Evaluation& evaluation, const AlignedEvaluation& result) {
  const MapAxes axes = ChooseMapAxes(evaluation.up);
  Range right;
  Range away;
  for (const Trajectory* track : {&evaluation.truth, &result.aligned}) {
    for (const auto& pose : *track) {
      right.Add(pose.T_world_cam.translation()[axes.right]);
      away.Add(pose.T_world_cam.translation()[axes.away]);
    }
  }
  // A straight road is long and thin: leave it room to be seen.
  const double length = std::max({right.length(), away.length(), 1e-3});
  right.WidenTo(std::max(1.1 * right.length(), 0.45 * length));
  away.WidenTo(std::max(1.1 * away.length(), 0.45 * length));

  Figure figure;
  figure.height = static_cast<int>(std::lround(std::clamp(760.0 * away.length() / right.length(), 340.0, 900.0))) + 140;
  std::ostringstream data;
  data << "# seconds, right (m), away (m); first block: ground truth, second: estimate (" << result.alignment.name
       << ")\n";
  AppendTrack(data, evaluation.truth, axes, evaluation.from, std::numeric_limits<TimeNs>::max());
  data << "\n\n";
  AppendTrack(data, result.aligned, axes, evaluation.from, evaluation.longest_gap);
  figure.data = data.str();

  const char* const names = "xyz";
  std::ostringstream script;
  script << kStyle << "set size ratio -1\n"
         << "set xrange " << right << "\n"
         << "set yrange " << away << "\n"
         << "set xlabel '" << names[axes.right] << " (m)'\n"
         << "set ylabel '" << names[axes.away] << " (m)'\n"
         << "data = '" << name << ".dat'\n"
         << "plot data index 0 using 2:3 with lines linewidth 7 linecolor '" << kTruthBlue
         << "' title 'ground truth', \\\n"
         << "  data index 1 using 2:3 with lines linewidth 2 linecolor '" << kEstimateGreen << "' title 'estimate ("
         << result.alignment.name << ")', \\\n"
         << "  data index 1 every ::0::0 using 2:3 with points pointtype 7 pointsize 1.1 linecolor '#000000' title "
            "'start'\n";
  figure.script = script.str();
  return figure;
}

Figure ErrorFigure(const std::string& name, const Evaluation& evaluation, const AlignedEvaluation& result) {
  Range time;
  Range meters;
  std::ostringstream data;
  data << "# seconds, longitudinal (m), lateral (m), planar (m); alignment " << result.alignment.name << "\n";
  for (std::size_t i = 0; i < result.errors.size(); ++i) {
    const auto& error = result.errors[i];
    if (i > 0 && error.stamp - result.errors[i - 1].stamp > evaluation.longest_gap) data << '\n';
    data << Number(error.seconds) << ' ' << Number(error.driving.longitudinal) << ' ' << Number(error.driving.lateral)
         << ' ' << Number(error.driving.planar) << '\n';
    time.Add(error.seconds);
    for (const double value : {error.driving.longitudinal, error.driving.lateral, error.driving.planar}) {
      meters.Add(value);
    }
  }
  time.WidenTo(1e-3);
  meters.WidenTo(std::max(1.1 * meters.length(), 1e-3));  // gnuplot refuses an empty range

  std::ostringstream script;
  script << kStyle << "set xrange " << time << "\n"
         << "set xlabel 'time (s)'\n"
         << "set yrange " << meters << "\n"
         << "set ylabel 'error of position (m)'\n"
         << "set xzeroaxis linetype 1 linewidth 1 linecolor '#808080'\n";
  if (evaluation.path_m > 0.0) {
    const double percent = 100.0 / evaluation.path_m;
    script << "set border 11 linecolor '#404040'\n"
           << "set y2range " << Range{percent * meters.low, percent * meters.high} << "\n"
           << "set y2tics textcolor '#202020'\n"
           << "set y2label '% of the path of " << Print("%.1f", evaluation.path_m) << " m' offset 1\n";
  }
  script << "data = '" << name << ".dat'\n"
         << "plot data using 1:4 with lines linewidth 3 linecolor '#000000' title 'planar', \\\n"
         << "  data using 1:2 with lines linewidth 2 linecolor '" << kBlue << "' title 'longitudinal (+ ahead)', \\\n"
         << "  data using 1:3 with lines linewidth 2 dashtype (8,4) linecolor '" << kVermilion
         << "' title 'lateral (+ left)'\n";
  return {data.str(), script.str()};
}

Figure LifetimeFigure(const std::string& name, const LifetimeStatistics& statistics) {
  std::ostringstream data;
  data << "# lifetime from (frames), to below (frames), tracks\n";
  std::int64_t most = 1;
  int end = 1;
  for (const auto& bin : statistics.histogram) {
    data << bin.low << ' ' << bin.high << ' ' << bin.tracks << '\n';
    most = std::max(most, bin.tracks);
    end = bin.high;
  }
  if (statistics.histogram.empty()) data << "0 1 0\n";  // gnuplot refuses a file without data

  const std::string mean = Number(statistics.in_frames.mean);
  const std::string top = Number(1.05 * static_cast<double>(most));
  std::ostringstream script;
  script << kStyle << "set xrange [0:" << end << "]\n"
         << "set yrange [0:" << top << "]\n"
         << "set grid noxtics\n"
         << "set xlabel 'lifetime (frames)'\n"
         << "set ylabel 'tracks'\n"
         << "set style fill solid 0.8 border linecolor '" << kBlue << "'\n"
         << "set arrow from " << mean << ",0 to " << mean << "," << top
         << " nohead linewidth 3 dashtype (8,4) linecolor '" << kVermilion << "' front\n"
         << "plot '" << name << ".dat' using (0.5 * ($1 + $2)):3:($2 - $1) with boxes linecolor '" << kSkyBlue
         << "' title '" << statistics.tracks << " tracks of " << kFewestFrames << " frames or more', \\\n"
         << "  NaN with lines linewidth 3 dashtype (8,4) linecolor '" << kVermilion << "' title 'mean "
         << Print("%.3f", statistics.in_frames.mean) << ", std "
         << Print("%.3f", statistics.in_frames.standard_deviation) << "'\n";
  return {data.str(), script.str()};
}

}  // namespace evo

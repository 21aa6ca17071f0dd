#include "evo/report/track_tables.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "evo/report/figures.hpp"
#include "evo/report/terminal_summary.hpp"
#include "report/fixtures.hpp"

namespace evo::report {
namespace {

using TrackTablesTest = ReportTest;

/// Track 4: 1 px off over 0.2 s, then 6 px; track 9 has no depth.
evaluation::TrackAccuracy SampleAccuracy() {
  std::vector<evaluation::FeatureTrack> tracks{{4, {}}, {9, {}}};
  std::vector<evaluation::TrueTrack> truth(2);
  for (int i = 0; i < 4; ++i) {
    const TimeNs t = 1500000000'000000000 + i * 100'000'000;
    tracks[0].observations.push_back({4, t, i < 3 ? 51.0 : 56.0, 60.0});
    tracks[1].observations.push_back({9, t, 0.0, 0.0});
    truth[0].positions.emplace_back(Eigen::Vector2d(50.0, 60.0));
  }
  truth[0].status = evaluation::TrackStatus::kEvaluated;
  truth[0].visible_until = 1500000000'400000000;
  truth[1].status = evaluation::TrackStatus::kNoDepth;
  return evaluation::EvaluateTracks(tracks, truth, "depth", {5.0, 1.5});
}

void ExpectHas(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << part << " in:\n" << text;
}

TEST_F(TrackTablesTest, QualityIsALongTable) {
  WriteTrackQuality(folder / "track_quality.csv", SampleAccuracy());
  const std::string csv = ReadFile(folder / "track_quality.csv");
  EXPECT_TRUE(csv.starts_with("quantity,unit,threshold_px,age_low_s,age_high_s,value\ntruth,name,,,,depth\n")) << csv;
  for (const char* row :
       {"\ntracks,count,,,,2\n", "\ntracks_judged,count,,,,1\n", "\ntracks_no_depth,count,,,,1\n",
        "\ntracks_too_short,count,,,,0\n", "\ntracks_moves,count,,,,0\n",
        "\nstray_share,share,1.500000000,,,0.000000000\n", "\ncompared_positions,count,1.500000000,,,3\n",
        "\nerror_mean,px,1.500000000,,,1.000000000\n", "\nfeature_age_mean,s,5.000000000,,,0.200000000\n",
        "\nexpected_feature_age_normalized,share,5.000000000,,,0.500000000\n", "\nerror_mean,px,,,,2.250000000\n",
        "\nexceeding_share,share,5.000000000,,,1.000000000\n", "\nexceeding_share,share,,,,0.000000000\n",
        "\nerror_over_age_median,px,,0.300000000,0.310000000,6.000000000\n"}) {
    ExpectHas(csv, row);
  }
}

TEST_F(TrackTablesTest, ErrorsHaveOneRowATrack) {
  WriteTrackErrors(folder / "track_errors.csv", SampleAccuracy());
  EXPECT_EQ(ReadFile(folder / "track_errors.csv"),
            "id,start,verdict,observations,lifetime_s,true_lifetime_s,compared,mean_error_px,median_error_px,"
            "rmse_error_px,max_error_px,surface_error_px,age_1.5px_s,outlier_1.5px,age_5px_s,outlier_5px\n"
            "4,1500000000.000000000,judged,4,0.300000000,0.400000000,4,2.250000000,1.000000000,3.122498999,6.000000000,"
            "1.000000000,0.200000000,0,0.200000000,0\n"
            "9,1500000000.000000000,no_depth,4,0.300000000,,0,,,,,,,,,\n");
}

TEST_F(TrackTablesTest, SummaryNamesTheTruthAndTracksThatAreNotEvaluated) {
  const std::string text = FormatTrackAccuracy(SampleAccuracy());
  ExpectHas(text, "1 of 2 evaluated, truth: depth; 1 without depth\n");
  EXPECT_EQ(text.find("too short"), std::string::npos);
  ExpectHas(text, " 50.0\n");
}

TEST_F(TrackTablesTest, FigureShowsQuartilesOverAge) {
  const Figure figure = TrackErrorFigure("e", SampleAccuracy());
  ExpectHas(figure.data, "\n0.305 6 6 6 1\n");
  ExpectHas(figure.script, "track error (px)");
  evaluation::TrackAccuracy triangulated = SampleAccuracy();
  triangulated.truth = "triangulated";
  ExpectHas(TrackErrorFigure("e", triangulated).script, "triangulation residual (px)");
}

TEST_F(TrackTablesTest, GnuplotDrawsTheFigureAlsoWithoutData) {
  if (std::system("command -v gnuplot >/dev/null 2>&1") != 0) GTEST_SKIP() << "gnuplot is not installed";
  Gnuplot gnuplot(folder);
  gnuplot.Draw("full", TrackErrorFigure("full", SampleAccuracy()));
  gnuplot.Draw("empty", TrackErrorFigure("empty", {}));
  for (const char* name : {"full.svg", "empty.svg"}) ExpectHas(ReadFile(folder / name), "</svg>");
}

}  // namespace
}  // namespace evo::report

#include <algorithm>
#include <iostream>
#include <memory>

#include "app/commands.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/output_folder.hpp"
#include "evo/core/logging.hpp"
#include "evo/core/output_file.hpp"
#include "evo/report/run_page.hpp"
#include "evo/report/run_table.hpp"

namespace evo::app {

namespace {

struct ReportArguments {
  std::vector<std::filesystem::path> runs;
  std::filesystem::path out;
  std::string title = "Runs of evo-run";
  std::string alignment;
  bool force = false;
};

void RunReport(const ReportArguments& arguments) {
  SetUpLogging(0);
  CheckOutputFolder(arguments.out, {"runs.csv", "runs.tex", "index.html"}, arguments.force);
  const auto runs = report::ReadRunFolders(arguments.runs);
  const std::string alignment = report::ChooseAlignment(runs, arguments.alignment);
  const report::CsvTable table = report::MergeRuns(runs);
  const std::string page = report::RunsPage(arguments.title, runs, table);
  const InterruptGuard guard(arguments.out);
  report::WriteCsv(arguments.out / "runs.csv", table);
  WriteText(arguments.out / "runs.tex", report::RunsLatex(table, alignment));
  WriteText(arguments.out / "index.html", page);
  const auto failed = std::ranges::count_if(runs, [](const report::RunFolder& run) { return !run.failure.empty(); });
  std::cout << "runs       " << runs.size() << ", of which " << failed << " failed\n"
            << "results    " << (arguments.out / "index.html").string() << '\n';
}

}  // namespace

Command AddReportCommand(CLI::App& app) {
  auto arguments = std::make_shared<ReportArguments>();
  auto* const parser = app.add_subcommand("report", "Compare runs in one CSV table, one LaTeX table and one HTML page");
  parser->add_option("runs", arguments->runs, "Output folders of earlier runs")->required()->type_name("RUN_DIR");
  parser
      ->add_option("--out", arguments->out,
                   "Folder for runs.csv, runs.tex and index.html, created if it does not exist")
      ->required()
      ->type_name("DIR");
  parser->add_option("--title", arguments->title, "Title of the page")->capture_default_str()->type_name("TEXT");
  parser
      ->add_option("--alignment", arguments->alignment,
                   "Alignment in the LaTeX table; default: the first one of all runs")
      ->type_name("NAME");
  parser->add_flag("--force", arguments->force, "Overwrite an earlier report in the --out folder");
  parser->footer(
      "Examples:\n"
      "  evo-run report out/day1 out/day2 --out out/report\n"
      "  evo-run report out/*/ --title 'Night drives' --alignment sim3 --out out/report --force");
  return {parser, [arguments](const auto&) { RunReport(*arguments); }};
}

}  // namespace evo::app

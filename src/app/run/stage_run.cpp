#include "app/run/stage_run.hpp"

#include <fmt/format.h>

#include <utility>

namespace evo::app {

StageRun::StageRun(const CommonOptions& common, ResultOptions result_options, const Parameters& parameters,
                   const std::vector<std::string>& command_line)
    : results(std::move(result_options)),
      show_progress(!common.quiet),
      record(command_line, parameters),
      guard(results.out),
      pool(common.threads) {}

void StageRun::Finish() {
  record.FinishChecksums();
  record.manifest.seen = report::DiagnosisValues(diagnosis);
  record.manifest.warnings = report::DiagnosisWarnings(diagnosis);
  if (diagnosis.trajectory) record.manifest.losses = diagnosis.trajectory->losses;
  report::WriteManifest(results.out / "manifest.json", record.manifest);
}

std::string FormatSpeed(const StageRun& run) {
  const double recorded = run.record.manifest.recorded_s.value_or(0.0);
  const double factor = report::RealTimeFactor(run.record.manifest).value_or(0.0);
  return fmt::format("speed      {:.1f} s of events in {:.1f} s on {} threads: {:.1f} x real time\n", recorded,
                     factor > 0.0 ? recorded / factor : 0.0, run.pool.size(), factor);
}

}  // namespace evo::app

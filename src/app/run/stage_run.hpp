#pragma once

#include <string>
#include <vector>

#include "app/options.hpp"
#include "app/run/interrupt.hpp"
#include "app/run/run_record.hpp"
#include "evo/core/parallel.hpp"
#include "evo/report/run_diagnosis.hpp"

namespace evo::app {

/// The output folder, record and threads that the stages of one run share.
struct StageRun {
  /// `parameters` and `command_line` are for the record. Starts the threads.
  StageRun(const CommonOptions& common, ResultOptions result_options, const Parameters& parameters,
           const std::vector<std::string>& command_line);
  /// Writes manifest.json, the last file of a run. Throws Error (kOutput).
  void Finish();

  ResultOptions results;
  bool show_progress;
  RunRecord record;
  report::RunDiagnosis diagnosis;  ///< of the stages so far
  InterruptGuard guard;            ///< before the threads, which inherit its signal mask
  ThreadPool pool;
};

/// A summary line: seconds of the recording, seconds of computing and their ratio, see report::RealTimeFactor.
std::string FormatSpeed(const StageRun& run);

}  // namespace evo::app

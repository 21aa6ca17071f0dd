#pragma once

#include <string>
#include <vector>

#include "evo/report/run_folder.hpp"

namespace evo::report {

/// "What was seen": the warnings of each run and a table of the values in their manifests; empty if there are none.
std::string DiagnosisSection(const std::vector<RunFolder>& runs);

}  // namespace evo::report

#pragma once

namespace evo {

/// Sends the log to stderr, one line a message. `verbosity`: -1 errors only, 0 warnings and notes, 1 and above debug.
void SetUpLogging(int verbosity);

}  // namespace evo

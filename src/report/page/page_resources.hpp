#pragma once

namespace evo::report {

// The files in src/report/page, built into the program. The page's {{name}} are places to fill in.
extern const char* const kPageTemplate;
extern const char* const kPageStyle;
extern const char* const kPageScript;

}  // namespace evo::report

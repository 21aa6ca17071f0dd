#pragma once

namespace evo::report {

// The files of src/report/page, embedded by the build. The template's {{name}} are for ExpandTemplate.
extern const char* const kPageTemplate;
extern const char* const kPageStyle;
extern const char* const kPageScript;

}  // namespace evo::report

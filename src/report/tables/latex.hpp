#pragma once

#include <string>

namespace evo::report {

/// Escapes the special characters of LaTeX (# $ % & _ { } ~ ^ \ < > |).
std::string LatexEscape(const std::string& text);

}  // namespace evo::report

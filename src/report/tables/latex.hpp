#pragma once

#include <string>

namespace evo::report {

/// `text` as LaTeX prints it: its special characters (# $ % & _ { } ~ ^ \ < > |) written as commands.
std::string LatexEscape(const std::string& text);

}  // namespace evo::report

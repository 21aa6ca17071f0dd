#pragma once

#include <string>

namespace evo {

/// The shortest text that reads back as the same double; "nan" and "inf" for those.
std::string FormatNumber(double value);

}  // namespace evo

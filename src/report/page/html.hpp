#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace evo::report {

/// Escapes text for an HTML element or a quoted attribute.
std::string HtmlEscape(std::string_view text);

/// "data:TYPE;base64,...", a URI that embeds `bytes`.
std::string DataUri(const std::string& type, const std::string& bytes);

/// Replaces each {{name}} of a template by its value; values are not expanded further.
std::string ExpandTemplate(std::string_view page, const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace evo::report

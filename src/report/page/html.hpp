#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace evo::report {

/// `text` as HTML shows it, in an element or in a quoted attribute.
std::string HtmlEscape(std::string_view text);

/// "data:TYPE;base64,...": `bytes` as an address that needs no file.
std::string DataUri(const std::string& type, const std::string& bytes);

/// `page` with each {{name}} replaced by its value. Values are not searched for further names.
std::string FillIn(std::string_view page, const std::vector<std::pair<std::string, std::string>>& values);

}  // namespace evo::report

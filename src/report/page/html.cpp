#include "report/page/html.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <stdexcept>

namespace evo::report {

std::string HtmlEscape(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string DataUri(const std::string& type, const std::string& bytes) {
  std::string base64(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // OpenSSL appends a zero byte
  const int length =
      ::EVP_EncodeBlock(reinterpret_cast<unsigned char*>(base64.data()),
                        reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
  base64.resize(static_cast<std::size_t>(length));
  return "data:" + type + ";base64," + base64;
}

std::string ExpandTemplate(std::string_view page, const std::vector<std::pair<std::string, std::string>>& values) {
  std::string filled;
  std::size_t position = 0;
  for (auto begin = page.find("{{"); begin != std::string_view::npos; begin = page.find("{{", position)) {
    const std::size_t end = page.find("}}", begin);
    const std::string name(page.substr(begin + 2, end - begin - 2));
    const auto value = std::ranges::find(values, name, &std::pair<std::string, std::string>::first);
    if (value == values.end()) throw std::logic_error("the page template has no value for " + name);
    filled += page.substr(position, begin - position);
    filled += value->second;
    position = end + 2;
  }
  return filled += page.substr(position);
}

}  // namespace evo::report

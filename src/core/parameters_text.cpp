#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "evo/core/number.hpp"
#include "evo/core/parameters.hpp"

namespace evo {

namespace {

constexpr std::size_t kLongestUnit = 12;  // "rise over run" is no unit but a part of the meaning

/// A unit in parentheses at the end of a description; `help` loses it.
std::string CutUnit(std::string* help) {
  const auto open = help->rfind(" (");
  if (open == std::string::npos || !help->ends_with(')')) return "";
  std::string unit = help->substr(open + 2, help->size() - open - 3);
  if (unit.size() > kLongestUnit || unit.find(' ') != std::string::npos) return "";
  help->erase(open);
  return unit;
}

/// Without the bars that would end a table's cell.
std::string TableCell(const std::string& text) {
  std::string cell;
  for (const char c : text) cell += c == '|' ? std::string("\\|") : std::string(1, c);
  return cell;
}

std::string GroupOf(const std::string& name) {
  const auto dot = name.rfind('.');
  return dot == std::string::npos ? "" : name.substr(0, dot);
}

}  // namespace

std::string Parameters::ValueText(const Entry& entry) {
  if (auto* const* number = std::get_if<double*>(&entry.value)) return FormatNumber(**number);
  if (auto* const* integer = std::get_if<int*>(&entry.value)) return std::to_string(**integer);
  if (auto* const* flag = std::get_if<bool*>(&entry.value)) return **flag ? "true" : "false";
  return *std::get<std::string*>(entry.value);
}

/// The value as YAML: a text is quoted where YAML would read something else.
std::string Parameters::YamlValue(const Entry& entry) {
  const auto* const* text = std::get_if<std::string*>(&entry.value);
  return text ? YAML::Dump(YAML::Node(**text)) : ValueText(entry);
}

/// Range, choices or grammar of the values; empty for a switch.
std::string Parameters::RangeText(const Entry& entry) {
  if (std::holds_alternative<double*>(entry.value) || std::holds_alternative<int*>(entry.value)) {
    return FormatNumber(entry.lowest) + " to " + FormatNumber(entry.highest);
  }
  return entry.valid ? entry.expected : fmt::format("{}", fmt::join(entry.choices, ", "));
}

/// Prints the parameters `prefix`NAME, then the groups `prefix`GROUP one by one: each key of the YAML occurs once,
/// whatever the order of registration.
void Parameters::PrintYaml(const std::string& prefix, const std::string& indent, std::string* yaml) const {
  std::vector<std::string> groups;
  for (const auto& entry : entries_) {
    if (!entry.name.starts_with(prefix)) continue;
    const std::string name = entry.name.substr(prefix.size());
    const auto dot = name.find('.');
    if (dot == std::string::npos) {
      const std::string range = RangeText(entry);
      *yaml += fmt::format("{}{}: {}  # {}{}{}\n", indent, name, YamlValue(entry), entry.help,
                           range.empty() ? "" : "; ", range);
    } else if (std::ranges::find(groups, name.substr(0, dot)) == groups.end()) {
      groups.push_back(name.substr(0, dot));
    }
  }
  for (const auto& group : groups) {
    if (!yaml->empty()) *yaml += '\n';
    *yaml += indent + group + ":\n";
    PrintYaml(prefix + group + ".", indent + "  ", yaml);
  }
}

std::string Parameters::ToYaml() const {
  std::string yaml;
  PrintYaml("", "", &yaml);
  return yaml;
}

std::string Parameters::ToMarkdown() const {
  std::vector<std::string> groups;
  for (const auto& entry : entries_) {
    if (std::ranges::find(groups, GroupOf(entry.name)) == groups.end()) groups.push_back(GroupOf(entry.name));
  }
  std::ranges::sort(groups);
  std::string markdown;
  for (const auto& group : groups) {
    if (!markdown.empty()) markdown += '\n';
    markdown += "### " + group + "\n\n| Name | Default | Unit | Values | Meaning |\n|---|---|---|---|---|\n";
    for (const auto& entry : entries_) {
      if (GroupOf(entry.name) != group) continue;
      std::string meaning = entry.help;
      const std::string unit = CutUnit(&meaning);
      for (const auto& old_name : entry.old_names) meaning += "; formerly `" + old_name + "`";
      const bool is_switch = std::holds_alternative<bool*>(entry.value);
      markdown += fmt::format("| `{}` | `{}` | {} | {} | {} |\n", entry.name, TableCell(YamlValue(entry)), unit,
                              is_switch ? "true, false" : TableCell(RangeText(entry)), TableCell(meaning));
    }
  }
  return markdown;
}

std::vector<std::pair<std::string, std::string>> Parameters::Values() const {
  std::vector<std::pair<std::string, std::string>> values;
  for (const auto& entry : entries_) values.emplace_back(entry.name, ValueText(entry));
  return values;
}

}  // namespace evo

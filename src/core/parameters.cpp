#include "evo/core/parameters.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <functional>
#include <iterator>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

#include "evo/core/error.hpp"
#include "evo/core/number.hpp"

namespace evo {

namespace {

Error ConfigurationError(const std::string& where, const std::string& what) {
  return {ErrorKind::kConfiguration, where + ": " + what};
}

template <typename Number>
bool ParseNumber(const std::string& text, Number* value) {
  const char* const end = text.data() + text.size();
  const auto [last, failure] = std::from_chars(text.data(), end, *value);
  return failure == std::errc() && last == end;
}

std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = std::exchange(row[j + 1], std::min({row[j + 1] + 1, row[j] + 1, substituted}));
    }
  }
  return row.back();
}

}  // namespace

void Parameters::Add(std::string name, double* value, double lowest, double highest, std::string help) {
  entries_.push_back({std::move(name), value, lowest, highest, {}, std::move(help), {}, {}, {}});
}

void Parameters::Add(std::string name, int* value, int lowest, int highest, std::string help) {
  entries_.push_back({std::move(name),
                      value,
                      static_cast<double>(lowest),
                      static_cast<double>(highest),
                      {},
                      std::move(help),
                      {},
                      {},
                      {}});
}

void Parameters::Add(std::string name, bool* value, std::string help) {
  entries_.push_back({std::move(name), value, 0, 1, {}, std::move(help), {}, {}, {}});
}

void Parameters::Add(std::string name, std::string* value, std::vector<std::string> choices, std::string help) {
  entries_.push_back({std::move(name), value, 0, 0, std::move(choices), std::move(help), {}, {}, {}});
}

void Parameters::Add(std::string name, std::string* value, std::function<bool(const std::string&)> valid,
                     std::string expected, std::string help) {
  entries_.push_back({std::move(name), value, 0, 0, {}, std::move(help), std::move(valid), std::move(expected), {}});
}

void Parameters::Alias(std::string old_name, std::string_view name) {
  Entry* const entry = Find(name);
  if (!entry) throw std::logic_error(fmt::format("alias '{}' of the unknown parameter '{}'", old_name, name));
  entry->old_names.push_back(std::move(old_name));
}

const std::string& Parameters::CurrentName(const std::string& name) const {
  const auto has_name = [&](const Entry& entry) {
    return std::ranges::find(entry.old_names, name) != entry.old_names.end();
  };
  const auto found = std::ranges::find_if(entries_, has_name);
  return found == entries_.end() ? name : found->name;
}

void Parameters::LoadFile(const std::filesystem::path& path, std::string_view skipped) {
  if (std::filesystem::is_directory(path)) throw ConfigurationError(path.string(), "is a folder; give a YAML file");
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw ConfigurationError(path.string(), "cannot read this file; give a YAML file");
  if (text.empty()) throw ConfigurationError(path.string(), "is an empty file; give a YAML file");
  if (text.find('\0') != std::string::npos) throw ConfigurationError(path.string(), "is no text; give a YAML file");
  LoadText(text, path.string(), skipped);
}

void Parameters::LoadText(const std::string& yaml, const std::string& source, std::string_view skipped) {
  const auto place = [&](const YAML::Mark& mark) { return source + ":" + std::to_string(mark.line + 1); };
  YAML::Node root;
  try {
    root = YAML::Load(yaml);
  } catch (const YAML::ParserException& failure) {
    throw ConfigurationError(place(failure.mark), "not valid YAML: " + failure.msg);
  }
  if (root.IsNull()) return;
  std::set<std::string> seen;
  const std::function<void(const YAML::Node&, const std::string&)> visit = [&](const YAML::Node& node,
                                                                               const std::string& prefix) {
    if (!node.IsMap()) throw ConfigurationError(place(node.Mark()), "expected 'name: value' pairs");
    for (const auto& item : node) {
      const std::string name = prefix + item.first.Scalar();
      if (!skipped.empty() && name == skipped) continue;
      if (item.second.IsScalar()) {
        const std::string& current = CurrentName(name);
        if (!seen.insert(current).second) {
          const std::string former = name == current ? "" : ", here by its former name '" + name + "'";
          throw ConfigurationError(place(item.first.Mark()), "'" + current + "' comes twice" + former);
        }
        Set(name, item.second.Scalar(), place(item.first.Mark()));
      } else if (item.second.IsMap()) {
        visit(item.second, name + ".");
      } else {
        throw ConfigurationError(place(item.first.Mark()), "'" + name + "' needs a single value");
      }
    }
  };
  visit(root, "");
}

void Parameters::Set(std::string_view setting) {
  const auto equals = setting.find('=');
  const std::string where = "--set " + std::string(setting);
  if (equals == std::string_view::npos || equals == 0) throw ConfigurationError(where, "expected name=value");
  Set(std::string(setting.substr(0, equals)), std::string(setting.substr(equals + 1)), where);
}

Parameters::Entry* Parameters::Find(std::string_view name) {
  const auto found = std::ranges::find(entries_, name, &Entry::name);
  return found == entries_.end() ? nullptr : &*found;
}

std::string Parameters::Nearest(std::string_view name) const {
  const auto nearest =
      std::ranges::min_element(entries_, {}, [&](const Entry& e) { return EditDistance(e.name, name); });
  return nearest == entries_.end() ? "" : nearest->name;
}

void Parameters::Set(const std::string& given_name, const std::string& text, const std::string& where) {
  const std::string& name = CurrentName(given_name);
  if (name != given_name) spdlog::warn("{}: parameter '{}' is now called '{}'", where, given_name, name);
  Entry* const entry = Find(name);
  if (!entry) {
    throw ConfigurationError(where, "unknown parameter '" + name + "'; did you mean '" + Nearest(name) + "'?");
  }
  const auto range = [&] { return "[" + FormatNumber(entry->lowest) + ", " + FormatNumber(entry->highest) + "]"; };
  const auto refuse = [&](const std::string& expected) {
    return ConfigurationError(where, "'" + name + "' is '" + text + "' but must be " + expected);
  };
  if (auto* const* number = std::get_if<double*>(&entry->value)) {
    double value = 0.0;
    if (!ParseNumber(text, &value) || !(value >= entry->lowest && value <= entry->highest)) {
      throw refuse("a number in " + range());
    }
    **number = value;
  } else if (auto* const* integer = std::get_if<int*>(&entry->value)) {
    int value = 0;
    if (!ParseNumber(text, &value) || value < entry->lowest || value > entry->highest) {
      throw refuse("a whole number in " + range());
    }
    **integer = value;
  } else if (auto* const* flag = std::get_if<bool*>(&entry->value)) {
    if (text != "true" && text != "false") throw refuse("true or false");
    **flag = text == "true";
  } else {
    if (entry->valid && !entry->valid(text)) throw refuse(entry->expected);
    if (!entry->valid && std::ranges::find(entry->choices, text) == entry->choices.end()) {
      std::string choices;
      for (const auto& choice : entry->choices) choices += (choices.empty() ? "" : ", ") + choice;
      throw refuse("one of: " + choices);
    }
    *std::get<std::string*>(entry->value) = text;
  }
}

}  // namespace evo

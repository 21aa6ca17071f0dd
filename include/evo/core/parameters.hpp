#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace evo {

/// The parameters of the stages by dotted name ("tracker.features"), read from YAML files and NAME=VALUE settings.
/// A parameter refers to one field of a stage's options struct, which must outlive this object.
/// `help` is the only description of a parameter, in the form "what it is (unit)"; the comments of the YAML file and
/// the tables of docs/parameters.md show it.
/// An unknown name or a value out of range is an Error (kConfiguration) that names the place and the remedy.
class Parameters {
 public:
  /// Bounds are inclusive; NaN is refused.
  void Add(std::string name, double* value, double lowest, double highest, std::string help);
  void Add(std::string name, int* value, int lowest, int highest, std::string help);
  void Add(std::string name, bool* value, std::string help);
  void Add(std::string name, std::string* value, std::vector<std::string> choices, std::string help);
  /// Any text that satisfies `valid`; `expected` names such texts in messages.
  void Add(std::string name, std::string* value, std::function<bool(const std::string&)> valid, std::string expected,
           std::string help);
  /// Accepts the former name of parameter `name` in files and settings, with a warning on the log at each use.
  void Alias(std::string old_name, std::string_view name);

  /// `skipped`: the name of a section at the top that the caller reads itself; empty: none.
  void LoadFile(const std::filesystem::path& path, std::string_view skipped = {});
  /// `source` names the text in messages.
  void LoadText(const std::string& yaml, const std::string& source, std::string_view skipped = {});
  /// One setting "name=value", as given by --set.
  void Set(std::string_view setting);
  /// `where` names the place of the setting in messages, for example "run.yaml:3".
  void Set(const std::string& name, const std::string& text, const std::string& where);

  /// All parameters with their present values as a YAML file that LoadFile accepts; comments give help and range.
  std::string ToYaml() const;
  /// A Markdown heading and table for each group: name, present value, unit, values, meaning with former names.
  std::string ToMarkdown() const;
  /// Names and present values, in order of registration.
  std::vector<std::pair<std::string, std::string>> Values() const;

 private:
  struct Entry {
    std::string name;
    std::variant<double*, int*, bool*, std::string*> value;
    double lowest = -std::numeric_limits<double>::infinity();
    double highest = std::numeric_limits<double>::infinity();
    std::vector<std::string> choices;
    std::string help;
    std::function<bool(const std::string&)> valid;  ///< for a text without choices
    std::string expected;
    std::vector<std::string> old_names;
  };

  Entry* Find(std::string_view name);
  /// The present name of the parameter that was called `name`; `name` itself if it is no former name.
  const std::string& CurrentName(const std::string& name) const;
  std::string Nearest(std::string_view name) const;
  /// `where` names the place in messages, for example "run.yaml:3".
  static std::string ValueText(const Entry& entry);
  static std::string YamlValue(const Entry& entry);
  static std::string RangeText(const Entry& entry);
  void PrintYaml(const std::string& prefix, const std::string& indent, std::string* yaml) const;

  std::vector<Entry> entries_;
};

}  // namespace evo

#include "evo/simulation/random_scene.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "evo/core/error.hpp"
#include "evo/core/parameters.hpp"
#include "simulation/random_value.hpp"

namespace evo::simulation {

namespace {

constexpr const char* kSection = "draw";
constexpr const char* kWeight = "weight";

/// FNV-1a of a name: its random stream.
std::uint64_t StreamOf(const std::string& name) {
  std::uint64_t hash = 0xCBF29CE484222325;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  return hash;
}

/// Draws the entries of the section, one after the other.
class SceneDraw {
 public:
  SceneDraw(std::string file, std::uint64_t seed, Parameters* parameters)
      : file_(std::move(file)), seed_(seed), parameters_(*parameters) {}

  DrawnNames Draw(const YAML::Node& section) {
    CheckMap(section);
    for (const auto& entry : section) {
      if (entry.second.IsMap()) {
        DrawAlternative(entry.first.Scalar(), entry.second);
      } else {
        DrawParameter(entry.first, entry.second);
      }
    }
    return names_;
  }

 private:
  Error Refusal(const YAML::Node& node, const std::string& what) const {
    return {ErrorKind::kConfiguration, fmt::format("{}:{}: {}", file_, node.Mark().line + 1, what)};
  }

  void CheckMap(const YAML::Node& node) const {
    if (!node.IsMap() || node.size() == 0) throw Refusal(node, "expected 'name: value' pairs");
  }

  std::string PresentValue(const std::string& name) const {
    for (const auto& [known, value] : parameters_.Values()) {
      if (known == name) return value;
    }
    return "";
  }

  void DrawParameter(const YAML::Node& name, const YAML::Node& range) {
    const auto value = range.IsScalar() ? RandomValue::Parse(range.Scalar()) : std::nullopt;
    if (!value) {
      throw Refusal(name, fmt::format("'{}' needs a value or a range, such as 0.1..0.5, '0.05..5 log' or 'a * 2 | b'",
                                      name.Scalar()));
    }
    try {
      const std::string text = value->Draw(Random(seed_, StreamOf(name.Scalar())),
                                           [this](const std::string& other) { return PresentValue(other); });
      parameters_.Set(name.Scalar(), text, fmt::format("{}:{}", file_, name.Mark().line + 1));
    } catch (const std::invalid_argument& failure) {
      throw Refusal(name, fmt::format("'{}' follows 'of' but is no parameter with a number", failure.what()));
    }
  }

  void DrawAlternative(const std::string& name, const YAML::Node& alternatives) {
    CheckMap(alternatives);
    std::vector<double> weights;
    std::vector<std::pair<std::string, YAML::Node>> choices;
    for (const auto& alternative : alternatives) {
      CheckMap(alternative.second);
      choices.emplace_back(alternative.first.Scalar(), alternative.second);
      const YAML::Node weight = alternative.second[kWeight];
      weights.push_back(weight ? weight.as<double>(-1.0) : 1.0);
      if (!(weights.back() >= 0.0)) throw Refusal(weight, "a weight must be a number from 0 on");
    }
    if (std::ranges::all_of(weights, [](double weight) { return weight == 0.0; })) {
      throw Refusal(alternatives, "all weights are 0; give one of them a weight");
    }
    Random random(seed_, StreamOf(name));
    const auto& [chosen, values] = choices[DrawIndex(weights, &random)];
    names_.emplace_back(name, chosen);
    for (const auto& entry : values) {
      if (entry.first.Scalar() != kWeight) DrawParameter(entry.first, entry.second);
    }
  }

  std::string file_;
  std::uint64_t seed_;
  Parameters& parameters_;
  DrawnNames names_;
};

}  // namespace

std::optional<DrawnNames> LoadScene(const std::filesystem::path& file, std::optional<int> seed, SceneOptions* options,
                                    Parameters* parameters) {
  parameters->LoadFile(file, kSection);
  if (seed) options->seed = *seed;
  const YAML::Node root = YAML::LoadFile(file.string());
  if (!root.IsMap() || !root[kSection]) return {};
  return SceneDraw(file.string(), static_cast<std::uint64_t>(options->seed), parameters).Draw(root[kSection]);
}

}  // namespace evo::simulation

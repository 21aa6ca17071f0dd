#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "evo/simulation/scene_options.hpp"

namespace evo::simulation {

/// The names of what was drawn, such as ("light", "night"), in the order of the scene file.
using DrawnNames = std::vector<std::pair<std::string, std::string>>;

/// Reads a scene file into `parameters`, which hold `options`. `seed` replaces scene.seed.
///
/// A section `draw` of the file makes the scene random: its entries are drawn after all other parameters are read, in
/// their order, by the seed. An entry is either
///   PARAMETER: RANGE                          with a range such as 0.1..0.5 (see RandomValue), or
///   NAME: {ALTERNATIVE: {weight: 2, PARAMETER: RANGE, ...}, ...}
/// where one of the alternatives is drawn, with its parameters. A parameter that comes again replaces the earlier
/// value. Each parameter and name has a random stream of its own: a line that is added leaves the other values alone.
///
/// Throws Error(kConfiguration) that names the file and the line. Returns nothing for a file without `draw`.
std::optional<DrawnNames> LoadScene(const std::filesystem::path& file, std::optional<int> seed, SceneOptions* options,
                                    Parameters* parameters);

}  // namespace evo::simulation

#pragma once

#include "app/simulation/sequence_output.hpp"
#include "evo/core/parameters.hpp"
#include "evo/simulation/scene_options.hpp"

namespace evo::app {

/// The options of a simulated sequence and their names in scene files and --set.
struct SceneConfig {
  SceneConfig() {
    Register(parameters, scene);
    Register(parameters, output);
  }
  SceneConfig(const SceneConfig&) = delete;  // the parameters refer to the fields
  SceneConfig& operator=(const SceneConfig&) = delete;

  simulation::SceneOptions scene;
  SequenceOptions output;
  Parameters parameters;
};

}  // namespace evo::app

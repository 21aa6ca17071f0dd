#pragma once

#include <filesystem>
#include <utility>

#include "evo/core/time.hpp"
#include "evo/events/event_columns.hpp"
#include "evo/simulation/simulate.hpp"

namespace evo::app {

/// Passes a sequence on to `output` and draws, every `every` from the first image on, the image beside the events of
/// the 20 ms before it: frame_SECONDSs.png in `folder`.
class PreviewOutput : public simulation::SimulationSink {
 public:
  PreviewOutput(simulation::SimulationSink* output, std::filesystem::path folder, TimeNs every)
      : output_(output), folder_(std::move(folder)), every_(every) {}

  void OnEvents(const events::EventColumns& events) override;
  void OnImage(TimeNs t, const events::GreyImage& image, std::size_t events_before) override;
  void OnDepth(TimeNs t, const events::DepthMap& depth) override { output_->OnDepth(t, depth); }

 private:
  simulation::SimulationSink* output_;
  std::filesystem::path folder_;
  TimeNs every_;
  TimeNs next_ = 0;
  events::EventColumns recent_;
};

}  // namespace evo::app

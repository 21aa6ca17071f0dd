#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "evo/core/output_file.hpp"
#include "evo/events/tracks.hpp"

namespace evo::io {

/// Reads rows `id t x y` (this project, EKLT, rpg_feature_tracking_analysis) or `t,x,y,theta,id` (HASTE), told by their
/// commas, t in seconds. Rows may come in any order. Rows that repeat an id and a stamp: event-by-event HASTE updates
/// twice on simultaneous events, so its last row counts; elsewhere equal rows are dropped and differing ones refused.
/// Throws Error (kInput) with file and line.
events::Tracks ReadTracks(const std::filesystem::path& path);

/// Rounds the positions to the four decimals that TrackWriter writes, so that who goes on with `tracks` and who reads
/// the file see the same numbers.
void RoundAsWritten(events::Tracks* tracks);

/// Writes rows `id t x y` in the order given: stamps with nine decimals, pixels with four, below the header line
/// `# id timestamp x y` and one comment line for each of `comments`. Throws Error (kOutput, or kInput for a position
/// that is not finite). The file appears with Commit(), whole.
class TrackWriter {
 public:
  explicit TrackWriter(std::filesystem::path path, const std::vector<std::string>& comments = {});
  void Write(std::span<const events::TrackObservation> observations);
  void Commit() { file_.Commit(); }

 private:
  std::filesystem::path path_;
  OutputFile file_;
};

/// All in one call.
void WriteTracks(const std::filesystem::path& path, const events::Tracks& tracks,
                 const std::vector<std::string>& comments = {});

}  // namespace evo::io

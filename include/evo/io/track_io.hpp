#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "evo/core/output_file.hpp"
#include "evo/events/tracks.hpp"

namespace evo::io {

/// Reads rows `id t x y` (evo-run, EKLT, rpg_feature_tracking_analysis) or `t,x,y,theta,id` (HASTE, told by its commas)
/// in any order; t in seconds, x and y in px. Of HASTE's rows with the same id and stamp the last counts, since HASTE
/// updates twice on simultaneous events; in other files equal rows are dropped and differing ones refused.
/// Throws Error (kInput) with file and line.
events::Tracks ReadTracks(const std::filesystem::path& path);

/// Rounds the positions to the four decimals that TrackWriter writes, so that the odometry gives the same result from
/// memory and from the file.
void RoundAsWritten(events::Tracks* tracks);

/// Writes rows `id t x y` in the given order: stamps with nine decimals, pixels with four, below the header line
/// `# id timestamp x y` and a comment line for each of `comments`. The file appears whole on Commit() or not at all.
/// Throws Error (kOutput, or kInput for a position that is not finite).
class TrackWriter {
 public:
  explicit TrackWriter(std::filesystem::path path, const std::vector<std::string>& comments = {});
  void Write(std::span<const events::TrackObservation> observations);
  void Commit() { file_.Commit(); }

 private:
  std::filesystem::path path_;
  OutputFile file_;
};

/// Writes a whole track file.
void WriteTracks(const std::filesystem::path& path, const events::Tracks& tracks,
                 const std::vector<std::string>& comments = {});

}  // namespace evo::io

#pragma once

#include <filesystem>
#include <string>

namespace evo::report {

/// A figure as a gnuplot script.
struct Figure {
  std::string data;    ///< text of NAME.dat, which `script` reads by that name
  std::string script;  ///< all but terminal and output; runs once for each of them, after a `reset`
  int width = 900;     ///< of the SVG (px); the PDF has the same aspect ratio and is 7 inches wide
  int height = 500;    ///< px
};

/// Draws figures into a folder with the program gnuplot. If that is missing or fails, there is one warning in the log
/// and no picture; data and script are written nevertheless.
class Gnuplot {
 public:
  explicit Gnuplot(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Writes NAME.dat, NAME.gp, NAME.svg and NAME.pdf; `gnuplot NAME.gp` in that folder draws them again.
  /// Equal figures give equal bytes. Throws Error (kOutput).
  void Draw(const std::string& name, const Figure& figure);

 private:
  std::filesystem::path folder_;
  bool available_ = true;
};

}  // namespace evo::report

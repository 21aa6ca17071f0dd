#pragma once

#include <filesystem>
#include <string>

namespace evo::report {

/// A drawing in gnuplot's language.
struct Figure {
  std::string data;    ///< text of NAME.dat, which `script` may read by that name
  std::string script;  ///< everything but terminals and outputs; run once for each of them, after a `reset`
  int width = 900;     ///< px of the SVG; the PDF has the same shape, 7 inches wide
  int height = 500;    ///< px
};

/// Draws figures into a folder with the program gnuplot. Where that is missing or fails there is one warning in the
/// log and no picture, but the data and the script are written all the same.
class Gnuplot {
 public:
  explicit Gnuplot(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Writes NAME.dat, NAME.gp, NAME.svg and NAME.pdf; `gnuplot NAME.gp` in that folder draws them again.
  /// The same figure gives the same bytes. Throws Error (kOutput).
  void Draw(const std::string& name, const Figure& figure);

 private:
  std::filesystem::path folder_;
  bool available_ = true;
};

}  // namespace evo::report

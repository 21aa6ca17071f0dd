#include "report/page/run_pictures.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "report/page/html.hpp"
#include "report/text_file.hpp"

namespace evo::report {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestPicture = 2'000'000;  // bytes
constexpr std::array<const char*, 2> kThumbnails{"trajectory.svg", "errors.svg"};

std::string Megabytes(std::uintmax_t bytes) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.1f MB", 1e-6 * static_cast<double>(bytes));
  return buffer;
}

std::uintmax_t Bytes(const fs::path& path) {
  std::error_code failure;
  const std::uintmax_t bytes = fs::file_size(path, failure);
  return failure ? 0 : bytes;  // ReadTextFile says it better
}

struct Size {
  int width = 900;
  int height = 600;
};

/// Of an SVG; another one only leaves margins.
Size ReadSize(const std::string& svg) {
  Size size;
  const auto box = svg.substr(0, 2000).find("viewBox=");
  const bool found = box != std::string::npos &&
                     std::sscanf(svg.c_str() + box, "viewBox=\"0 0 %5d %5d\"", &size.width, &size.height) == 2;
  return found && size.width > 0 && size.height > 0 ? size : Size();
}

bool IsThumbnail(const fs::path& plot) {
  return std::ranges::find(kThumbnails, plot.filename().string()) != kThumbnails.end() &&
         Bytes(plot) <= kLargestPicture;
}

std::string PictureId(const fs::path& plot, std::size_t number) {
  return "picture-" + std::to_string(number) + "-" + plot.stem().string();
}

/// An inline SVG of that size, named `label`, around `content`.
std::string Frame(const Size& size, const std::string& label, const std::string& content) {
  return "<svg viewBox=\"0 0 " + std::to_string(size.width) + " " + std::to_string(size.height) +
         "\" role=\"img\" aria-label=\"" + HtmlEscape(label) + "\">" + content + "</svg>";
}

std::string Thumbnail(const RunFolder& run, const fs::path& plot, std::size_t number) {
  const std::string svg = ReadTextFile(plot);
  const Size size = ReadSize(svg);
  return Frame(size, run.name + ": " + plot.stem().string(),
               "<image id=\"" + PictureId(plot, number) + "\" width=\"" + std::to_string(size.width) + "\" height=\"" +
                   std::to_string(size.height) + "\" href=\"" + DataUri("image/svg+xml", svg) + "\"/>");
}

std::string Picture(const fs::path& path, const std::string& type, std::size_t number) {
  const std::string name = path.filename().string();
  if (const std::uintmax_t bytes = Bytes(path); bytes > kLargestPicture) {
    return "<figure><figcaption>" + HtmlEscape(name) + " (" + Megabytes(bytes) +
           ") is too large for this page.</figcaption></figure>\n";
  }
  const std::string content = ReadTextFile(path);
  const std::string picture = IsThumbnail(path)
                                  ? Frame(ReadSize(content), name, "<use href=\"#" + PictureId(path, number) + "\"/>")
                                  : "<img alt=\"" + HtmlEscape(name) + "\" src=\"" + DataUri(type, content) + "\">";
  return "<figure>" + picture + "<figcaption>" + HtmlEscape(name) + "</figcaption></figure>\n";
}

}  // namespace

std::string RunLink(const RunFolder& run, std::size_t number) {
  return "<a href=\"#run-" + std::to_string(number) + "\">" + HtmlEscape(run.name) + "</a>";
}

std::string Thumbnails(const std::vector<RunFolder>& runs) {
  std::string figures;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::string plots;
    for (const char* const name : kThumbnails) {
      const auto plot = std::ranges::find(runs[i].plots, name, [](const fs::path& path) { return path.filename(); });
      if (plot != runs[i].plots.end() && IsThumbnail(*plot)) plots += Thumbnail(runs[i], *plot, i + 1) + "\n";
    }
    if (plots.empty()) continue;
    figures += "<figure><figcaption>" + RunLink(runs[i], i + 1) + "</figcaption>\n" + plots + "</figure>\n";
  }
  if (figures.empty()) return "";
  return "<h2>At a glance</h2>\n<p class=\"note\">Trajectory and errors over time under the first alignment of each "
         "run; "
         "every plot has its own axes.</p>\n<div class=\"thumbnails\">\n" +
         figures + "</div>\n";
}

std::string Pictures(const RunFolder& run, std::size_t number) {
  std::string pictures;
  for (const auto& plot : run.plots) pictures += Picture(plot, "image/svg+xml", number);
  for (const auto& sheet : run.sheets) pictures += Picture(sheet, "image/png", number);
  return pictures.empty() ? "" : "<div class=\"plots\">\n" + pictures + "</div>\n";
}

}  // namespace evo::report

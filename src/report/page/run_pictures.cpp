#include "report/page/run_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "report/page/html.hpp"
#include "report/text_file.hpp"

namespace evo::report {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxPictureBytes = 2'000'000;  // a page of 50 runs still opens
constexpr std::array<const char*, 2> kThumbnails{"trajectory.svg", "errors.svg"};

std::uintmax_t FileSize(const fs::path& path) {
  std::error_code failure;
  const std::uintmax_t bytes = fs::file_size(path, failure);
  return failure ? 0 : bytes;  // ReadTextFile throws the Error
}

struct Size {
  int width = 900;
  int height = 600;
};

/// Size of an SVG; a default one if it has no view box.
Size ReadSvgSize(const std::string& svg) {
  Size size;
  const auto box = svg.substr(0, 2000).find("viewBox=");
  const bool found = box != std::string::npos &&
                     // NOLINTNEXTLINE(bugprone-unchecked-string-to-number-conversion): five digits always fit.
                     std::sscanf(svg.c_str() + box, "viewBox=\"0 0 %5d %5d\"", &size.width, &size.height) == 2;
  return found && size.width > 0 && size.height > 0 ? size : Size();
}

bool IsThumbnail(const fs::path& plot) {
  return std::ranges::find(kThumbnails, plot.filename().string()) != kThumbnails.end() &&
         FileSize(plot) <= kMaxPictureBytes;
}

std::string PictureId(const fs::path& plot, std::size_t number) {
  return "picture-" + std::to_string(number) + "-" + plot.stem().string();
}

/// An inline SVG around `content`.
std::string InlineSvg(const Size& size, const std::string& label, const std::string& content) {
  return fmt::format(R"(<svg viewBox="0 0 {} {}" role="img" aria-label="{}">{}</svg>)", size.width, size.height,
                     HtmlEscape(label), content);
}

std::string Thumbnail(const RunFolder& run, const fs::path& plot, std::size_t number) {
  const std::string svg = ReadTextFile(plot);
  const Size size = ReadSvgSize(svg);
  return InlineSvg(size, run.name + ": " + plot.stem().string(),
                   fmt::format(R"(<image id="{}" width="{}" height="{}" href="{}"/>)", PictureId(plot, number),
                               size.width, size.height, DataUri("image/svg+xml", svg)));
}

std::string Picture(const fs::path& path, const std::string& type, std::size_t number) {
  const std::string name = path.filename().string();
  if (const std::uintmax_t bytes = FileSize(path); bytes > kMaxPictureBytes) {
    return fmt::format("<figure><figcaption>{} ({:.1f} MB) is too large for this page.</figcaption></figure>\n",
                       HtmlEscape(name), 1e-6 * static_cast<double>(bytes));
  }
  const std::string content = ReadTextFile(path);
  const std::string picture =
      IsThumbnail(path) ? InlineSvg(ReadSvgSize(content), name, "<use href=\"#" + PictureId(path, number) + "\"/>")
                        : "<img alt=\"" + HtmlEscape(name) + "\" src=\"" + DataUri(type, content) + "\">";
  return "<figure>" + picture + "<figcaption>" + HtmlEscape(name) + "</figcaption></figure>\n";
}

}  // namespace

std::string RunLink(const RunFolder& run, std::size_t number) {
  return fmt::format(R"(<a href="#run-{}">{}</a>)", number, HtmlEscape(run.name));
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
  return "<h2>Trajectories and errors</h2>\n<p class=\"note\">Top view of the trajectory and position error over time, "
         "for "
         "the first alignment of each run. Every plot has its own scale.</p>\n<div class=\"thumbnails\">\n" +
         figures + "</div>\n";
}

std::string Pictures(const RunFolder& run, std::size_t number) {
  std::string pictures;
  for (const auto& plot : run.plots) pictures += Picture(plot, "image/svg+xml", number);
  for (const auto& sheet : run.sheets) pictures += Picture(sheet, "image/png", number);
  return pictures.empty() ? "" : "<div class=\"plots\">\n" + pictures + "</div>\n";
}

}  // namespace evo::report

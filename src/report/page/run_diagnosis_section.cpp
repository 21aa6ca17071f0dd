#include "report/page/run_diagnosis_section.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/page/html.hpp"
#include "report/page/run_pictures.hpp"

namespace evo::report {

namespace {

/// A value of `seen` in the manifest and its column.
struct Column {
  const char* name;
  const char* heading;
  const char* unit;
  double factor;
  int decimals;
};

constexpr Column kColumns[] = {{"coverage", "Coverage", "%", 100.0, 1},
                               {"restarts", "Restarts", "", 1.0, 0},
                               {"live_features_median", "Live features", "median", 1.0, 0},
                               {"live_features_min", "Live features", "min", 1.0, 0},
                               {"at_rest_ratio", "At rest", "%", 100.0, 1},
                               {"at_rest_moving_ratio", "At rest, scene moves", "%", 100.0, 1},
                               {"hot_pixel_ratio", "Hot pixels", "%", 100.0, 3},
                               {"hot_event_ratio", "Their events", "%", 100.0, 1},
                               {"flicker_hz", "Flicker", "Hz", 1.0, 1},
                               {"flicker_event_ratio", "Its events", "%", 100.0, 1},
                               {"masked_pixel_ratio", "Masked", "%", 100.0, 1},
                               {"scale_covered_ratio", "Scale held", "% of path", 100.0, 0},
                               {"position_sigma_ratio", "Uncertainty", "% of path", 100.0, 2}};

std::string ValueCell(const Manifest& manifest, const Column& column) {
  const auto found = std::ranges::find(manifest.seen, column.name, [](const auto& entry) { return entry.first; });
  if (found == manifest.seen.end()) return "<td class=\"number\" data-value=\"\"></td>";
  return fmt::format(R"(<td class="number" data-value="{}">{:.{}f}</td>)", found->second, column.factor * found->second,
                     column.decimals);
}

std::string WarningList(const std::vector<RunFolder>& runs) {
  std::string items;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!runs[i].manifest) continue;
    for (const auto& warning : runs[i].manifest->warnings) {
      items += "<li>" + RunLink(runs[i], i + 1) + ": " + HtmlEscape(warning) + "</li>\n";
    }
  }
  return items.empty() ? "<p>Nothing is out of the ordinary.</p>\n" : "<ul>\n" + items + "</ul>\n";
}

}  // namespace

std::string DiagnosisSection(const std::vector<RunFolder>& runs) {
  const auto has_seen = [](const RunFolder& run) { return run.manifest && !run.manifest->seen.empty(); };
  if (std::ranges::none_of(runs, has_seen)) return "";
  std::string text = "<h2>What was seen</h2>\n" + WarningList(runs) +
                     "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"What was seen\">\n<table "
                     "class=\"sortable\">\n<thead><tr><th scope=\"col\">Run</th>";
  for (const Column& column : kColumns) {
    text += fmt::format("<th scope=\"col\" class=\"number\">{}<span class=\"unit\"> {}</span></th>", column.heading,
                        column.unit);
  }
  text += "</tr></thead>\n<tbody>\n";
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (!has_seen(runs[i])) continue;
    text += "<tr><th scope=\"row\">" + RunLink(runs[i], i + 1) + "</th>";
    for (const Column& column : kColumns) text += ValueCell(*runs[i].manifest, column);
    text += "</tr>\n";
  }
  return text + "</tbody>\n</table>\n</div>\n";
}

}  // namespace evo::report

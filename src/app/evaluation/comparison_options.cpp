#include "app/evaluation/comparison_options.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

#include "evo/core/error.hpp"

namespace evo::app {

namespace {

/// Sets a number of seconds in [min, max] if given; NaN is refused.
void SetSeconds(const std::string& name, std::optional<double> given, double min, double max, double* option) {
  if (!given) return;
  if (!(*given >= min && *given <= max)) {
    throw Error(ErrorKind::kUsage, fmt::format("{} must be a number of seconds from {:.0f} to {:.0f}", name, min, max));
  }
  *option = *given;
}

std::optional<TimeNs> ParseStamp(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto stamp = ParseTime(text);
  if (!stamp) throw Error(ErrorKind::kUsage, option + ": '" + text + "' is not a stamp in seconds");
  return stamp;
}

}  // namespace

void ComparisonArguments::Apply(evaluation::EvaluationOptions* options) const {
  const auto set = [](const auto& given, auto* option) {
    if (!given.empty()) *option = given;
  };
  set(association, &options->association.association);
  set(rpe, &options->rpe.deltas);
  set(rpe_pairs, &options->rpe.pairs);
  set(project, &options->project);
  set(up, &options->up);
  set(forward, &options->forward);
  options->rpe.required = !rpe.empty();
  SetSeconds("--max-difference", max_difference_s, 0.0, 1e3, &options->association.max_difference_s);
  SetSeconds("--time-offset", time_offset_s, -1e9, 1e9, &options->association.estimate_clock_offset_s);
  if (max_difference_s && options->association.association == "interpolate") {
    throw Error(ErrorKind::kUsage,
                "--max-difference: the association interpolate, which is the default, compares no stamps; choose "
                "--association nearest, unique or nearest-truth");
  }
  evaluation::ParseDeltas(options->rpe.deltas);  // refuses a wrong --rpe before any file is read
}

void AddComparisonOptions(CLI::App& command, ComparisonArguments& arguments) {
  const auto add_choice = [&](const char* name, std::string& value, std::set<std::string> choices, const char* type,
                              const char* help) {
    command.add_option(name, value, help)->check(CLI::IsMember(std::move(choices)).description(""))->type_name(type);
  };
  add_choice("--association", arguments.association, {"interpolate", "nearest", "unique", "nearest-truth"},
             "interpolate|nearest|unique|nearest-truth",
             "Association of poses: interpolation of the truth, evo's nearest, or unique (evaluate_ate) or "
             "nearest-truth (evaluate_rpe) of TUM; default: interpolate");
  command
      .add_option("--max-difference", arguments.max_difference_s,
                  "Largest difference of associated stamps in s, not for interpolate; default: 0.01 for nearest, 0.02 "
                  "for unique, twice the truth's median interval for nearest-truth")
      ->type_name("S");
  command
      .add_option("--time-offset", arguments.time_offset_s,
                  "Offset in s added to the stamps of the estimate and the tracks, such as --time-offset=-0.1; "
                  "default: 0")
      ->type_name("S");
  command
      .add_option("--rpe", arguments.rpe,
                  "Distances of the relative pose errors in frames, s, m, deg or rad, such as "
                  "1f,0.5s,10m,5deg,0.1rad; default: 1f,1s,10m")
      ->type_name("LIST");
  add_choice("--rpe-pairs", arguments.rpe_pairs, {"consecutive", "all", "closest"}, "consecutive|all|closest",
             "Pairs of the relative pose errors: end to end, from every pose, or the closest as in TUM's evaluate_rpe; "
             "default: consecutive");
  add_choice("--project", arguments.project, {"none", "xy", "xz", "yz"}, "none|xy|xz|yz",
             "Plane of the truth's world in which errors count; default: none, all three axes");
  add_choice("--up", arguments.up, {"auto", "x", "y", "z", "-x", "-y", "-z"}, "auto|[-]x|y|z",
             "Axis of the truth's world that points up, such as --up=-y; default: auto, from the camera");
  add_choice("--forward", arguments.forward, {"travel", "body"}, "travel|body",
             "Direction of longitudinal errors: the travel in the ground plane or the true camera's axis; default: "
             "travel");
}

evaluation::EvaluationInterval IntervalArguments::Parse() const {
  const evaluation::EvaluationInterval interval{ParseStamp("--from-stamp", from), ParseStamp("--to-stamp", to)};
  if (interval.from && interval.to && *interval.from >= *interval.to) {
    throw Error(ErrorKind::kUsage, "--from-stamp must come before --to-stamp");
  }
  return interval;
}

void AddIntervalOptions(CLI::App& command, IntervalArguments& arguments) {
  command
      .add_option("--from-stamp", arguments.from,
                  "First evaluated stamp in s of the ground truth, for KITTI poses their number from 0; default: the "
                  "first")
      ->type_name("S");
  command
      .add_option("--to-stamp", arguments.to,
                  "Last evaluated stamp in s, inclusive, also of true tracks; default: the last")
      ->type_name("S");
}

}  // namespace evo::app

#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace evo::simulation {

/// The times (s) of bumps within [0, duration_s], increasing, from "52,60" or "every 5" (0.1 or more); none for an
/// empty text. nullopt for another text.
std::optional<std::vector<double>> ParseBumpTimes(std::string_view text, double duration_s);

inline constexpr double kBumpDuration = 3.0;  // s, after which the response is below 1e-5 of its peak

/// Response of a car's sprung mass `t` s after a short bump: a damped oscillation with a smooth onset.
double BumpResponse(double t);
/// Largest value of BumpResponse.
double BumpResponsePeak();

}  // namespace evo::simulation

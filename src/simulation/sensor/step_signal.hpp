#pragma once

#include <optional>

namespace evo::simulation {

/// What a pixel compares with its thresholds during one step, over the time t since the step's start: the exact answer
/// of a first-order low-pass to an input that is linear in time, plus the leak. With x = cut_off t,
///   u(t) = output + (input - output) (1 - exp(-x)) + slope t (1 - (1 - exp(-x)) / x) + leak t.
/// It turns once at most.
class StepSignal {
 public:
  /// `input` and `output` of the low-pass at the start, `slope` of the input (1/s), `cut_off` in rad/s (may be
  /// infinite), `leak` (1/s).
  StepSignal(double input, double slope, double output, double cut_off, double leak);

  double At(double t) const;

  struct Crossing {
    double t = 0.0;
    int sign = 0;  ///< +1 upwards through `high`, -1 downwards through `low`
  };
  /// Where it first reaches `high` or `low` within [from, to].
  std::optional<Crossing> FirstCrossing(double from, double to, double low, double high) const;

 private:
  double Slope(double t) const;
  double Share(double t) const;
  /// Where it equals `level`, in [from, to] that it crosses without turning.
  double Solve(double from, double to, double level) const;

  double output_;
  double lag_;  ///< of the output behind the input at the start
  double slope_;
  double cut_off_;
  double leak_;
  double turn_;  ///< infinite: none
};

}  // namespace evo::simulation

#pragma once

#include <optional>

namespace evo::simulation {

/// The amplifier's input during one step, over the time t since the step's start: the exact response of the
/// photoreceptor's first-order low-pass to an input that is linear in time, plus the leak. With x = cut_off t,
///   u(t) = output + (input - output) (1 - exp(-x)) + slope t (1 - (1 - exp(-x)) / x) + leak t.
/// It has at most one extremum.
class PhotoreceptorResponse {
 public:
  /// `input` and `output` of the low-pass at the start, `slope` of the input (1/s), `cut_off` in rad/s (may be
  /// infinite), `leak` (1/s).
  PhotoreceptorResponse(double input, double slope, double output, double cut_off, double leak);

  double Evaluate(double t) const;

  struct Crossing {
    double t = 0.0;
    int polarity = 0;  ///< 1 upwards through `high`, -1 downwards through `low`
  };
  /// The first crossing of `high` or `low` within [from, to].
  std::optional<Crossing> FirstCrossing(double from, double to, double low, double high) const;

 private:
  double Derivative(double t) const;
  /// 1 - exp(-cut_off t).
  double StepResponse(double t) const;
  /// The time in [from, to] of a crossing of `level`, between which there is no extremum.
  double SolveCrossing(double from, double to, double level) const;

  double output_;
  double lag_;  ///< of the output behind the input at the start
  double slope_;
  double cut_off_;
  double leak_;
  double extremum_;  ///< time of it, infinite: none
};

}  // namespace evo::simulation

#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kerf/fitting/segmented.h"
#include "kernels/law_kernel.h"

namespace kerf::fitting {

class ArmMemory;
class SegmentedMemory;

/// What is searched: a law's parameters, some of them held, some of them each recording's own.
struct Problem {
  std::string_view model;
  models::Options law_options;
  std::vector<models::ParameterInfo> parameters;
  std::vector<bool> free;  ///< one a parameter
  std::vector<bool> own;   ///< one a parameter: each recording has its own
  std::size_t runs = 1;
  std::vector<double> breakpoints;  ///< inner knots that were given by hand
  std::size_t points_per_segment = 4;
  Polish polish = Polish::thorough;  ///< of curves of segments
  std::shared_ptr<SegmentedMemory> segmented_memory{};
  std::shared_ptr<ArmMemory> arm_memory{};  ///< of these samples; none: sums are made anew each time

  [[nodiscard]] const models::LawFacts& facts() const { return models::law_facts(model); }
  /// Parameter and recording of a coordinate; the recording of one that is shared is Estimate::shared.
  struct Coordinate {
    std::size_t parameter;
    std::size_t run;
    friend bool operator==(const Coordinate&, const Coordinate&) = default;
  };
  std::vector<Coordinate> held{};  ///< of one recording each, of parameters that are free and its own

  /// How many numbers are searched: one a free parameter, or one a recording where it is its own.
  [[nodiscard]] Eigen::Index coordinates() const;
  [[nodiscard]] std::vector<Coordinate> all() const;
  /// Whether a parameter is searched in the law of a recording.
  [[nodiscard]] bool is_searched(std::size_t parameter, std::size_t run) const;
  [[nodiscard]] Bounds bounds() const;
};

/// The values of each recording's law.
using Values = std::vector<std::vector<double>>;

/// A value on the scale on which a parameter is searched, and back.
[[nodiscard]] double to_search_scale(const models::ParameterInfo& info, double value);
[[nodiscard]] double from_search_scale(const models::ParameterInfo& info, double value);

/// The coordinates of some values, and the values at some coordinates; what is held comes from `near`.
[[nodiscard]] Eigen::VectorXd coordinates_of(const Problem& problem, const Values& values);
[[nodiscard]] Values values_at(const Problem& problem, const Values& near, const Eigen::VectorXd& at);

/// Sum of squares of a law over the samples, by the coordinates of a problem.
class LawObjective final : public Objective {
 public:
  LawObjective(const Problem& problem, const Samples& samples, const Weights& weights, Values near,
               RobustLoss loss = {});
  [[nodiscard]] Eigen::Index size() const override { return static_cast<Eigen::Index>(all_.size()); }
  [[nodiscard]] bool evaluate(const Eigen::VectorXd& at, Sums& sums) const override;
  /// Force of the samples that count and its derivatives by the coordinates, one after the other.
  [[nodiscard]] bool rows(const Eigen::VectorXd& at, Eigen::VectorXd& force, Eigen::MatrixXd& jacobian) const;
  [[nodiscard]] Values values_at(const Eigen::VectorXd& at) const;

  [[nodiscard]] const Samples& samples() const { return samples_; }
  [[nodiscard]] const Weights& weights() const { return weights_; }
  /// The values near which it is looked at: those of what is held.
  [[nodiscard]] const Values& near() const { return near_; }

 private:
  [[nodiscard]] std::vector<double> slopes(const std::vector<double>& values, std::size_t run) const;
  /// The coordinates that move the law of a run, in the order of its parameters.
  [[nodiscard]] std::vector<Eigen::Index> of_run(std::size_t run) const;

  const Problem& problem_;
  const Samples& samples_;
  const Weights& weights_;
  Values near_;
  RobustLoss loss_;
  const LawKernel& kernel_;
  std::vector<Problem::Coordinate> all_;
};

/// The force that each run's law gives along the samples, from a fresh state.
[[nodiscard]] std::vector<double> rendered(const Problem& problem, const Values& values,
                                           const Samples& samples);

}  // namespace kerf::fitting

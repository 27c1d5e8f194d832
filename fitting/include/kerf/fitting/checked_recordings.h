#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "kerf/fitting/fit.h"
#include "kerf/fitting/floor.h"

namespace kerf::fitting {

struct Samples;

/// Recordings that were checked and copied once, for several fits and their floor, which may be found on
/// several threads at once. Of the options, folds and test_share are those of all of them.
class CheckedRecordings {
 public:
  /// @throws std::invalid_argument if the series cannot be fitted at all.
  CheckedRecordings(std::span<const Series> recordings, const FitOptions& options);
  CheckedRecordings(const CheckedRecordings&) = delete;
  CheckedRecordings& operator=(const CheckedRecordings&) = delete;
  ~CheckedRecordings();

  [[nodiscard]] const Samples& samples() const noexcept { return *samples_; }

 private:
  std::unique_ptr<const Samples> samples_;
};

/// As of the series that they are of.
[[nodiscard]] FitResult fit(std::string_view model, const CheckedRecordings& recordings,
                            const FitOptions& options);
[[nodiscard]] Floor floor_of(const CheckedRecordings& recordings);

/// Root mean square error of a straight line of force over penetration on the folds that it was not fitted
/// to, as laws are held out (every sample counts alike) [N]; NaN for fewer than two folds.
[[nodiscard]] double held_out_line_rmse(const CheckedRecordings& recordings);

}  // namespace kerf::fitting

#pragma once

#include <optional>
#include <span>
#include <vector>

#include <kerf/population/group.h>

namespace kerf::population {

/// A number with one part of each source left out after the other: of every source a list.
using WithoutParts = std::vector<std::vector<double>>;

/// The error that they give by the jackknife of groups: of each source of K parts
/// (K - 1) / K sum_k (x_k - mean)^2 with K - 1 degrees of freedom, of several together by Satterthwaite.
/// Nothing if a number is not finite or a source has one part.
[[nodiscard]] std::optional<SharedError> error_of(const WithoutParts& numbers);

/// The same recordings with other values; none where one of these is not known. Refuses values that are not
/// as many.
[[nodiscard]] std::vector<Estimate> with_values(std::span<const Estimate> estimates,
                                                std::span<const double> values);

/// Two independent errors together, and the degrees of freedom of their t by Welch and Satterthwaite.
[[nodiscard]] SharedError together(const SharedError& one, const SharedError& other);

/// By the t of its degrees of freedom.
[[nodiscard]] Interval interval_of(double mean, const SharedError& error, double confidence);

}  // namespace kerf::population

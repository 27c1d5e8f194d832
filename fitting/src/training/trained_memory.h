#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "starts/arm_sums.h"
#include "training/training.h"

namespace kerf::fitting {

/// Laws of one model that were trained on the same samples, by which of them they were shown. Nested folds
/// ask for the same twice: all but the first and then the second, and all but the second and then the first;
/// all but one to judge a size, and again where that fold is held out of everything. Several threads may ask
/// at once; those that ask for the same wait for the one that came first.
class TrainedMemory {
 public:
  /// What `train` gives for these weights, a size of the law and a tolerance, from where it was first asked
  /// for.
  [[nodiscard]] Trained once(const Weights& seen, std::size_t size, double function_tolerance,
                             const std::function<Trained()>& train);
  /// Where a law of all samples ended, of each size by how many parameters it has. Set before folds ask.
  void keep_whole(const Values& values) { whole_[values.at(0).size()] = values; }
  /// That of the size of `like`; nothing where there is none.
  [[nodiscard]] const Values* whole(const Values& like) const {
    const auto found = like.empty() ? whole_.end() : whole_.find(like[0].size());
    return found == whole_.end() ? nullptr : &found->second;
  }
  /// Sums of arms over these samples.
  [[nodiscard]] const std::shared_ptr<ArmMemory>& arms() const { return arms_; }

 private:
  /// Where a column changes, and to what: weights are the same over whole stretches.
  using Changes = std::vector<std::pair<std::size_t, double>>;
  static Changes changes_of(const Weights& weights);

  struct Entry {
    Changes seen;
    std::size_t size;
    double function_tolerance;
    std::once_flag once{};
    Trained law{};  ///< without its weights
    Changes weights{};

    Entry(Changes of, std::size_t parts, double tolerance)
        : seen(std::move(of)), size(parts), function_tolerance(tolerance) {}
  };

  std::mutex mutex_;
  std::list<Entry> entries_;
  std::map<std::size_t, Values> whole_;
  std::shared_ptr<ArmMemory> arms_ = std::make_shared<ArmMemory>();
};

}  // namespace kerf::fitting

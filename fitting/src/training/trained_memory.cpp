#include "training/trained_memory.h"

#include <algorithm>

namespace kerf::fitting {

TrainedMemory::Changes TrainedMemory::changes_of(const Weights& weights) {
  Changes changes;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (changes.empty() || changes.back().second != weights[i]) changes.emplace_back(i, weights[i]);
  }
  return changes;
}

Trained TrainedMemory::once(const Weights& seen, std::size_t size, double function_tolerance,
                            const std::function<Trained()>& train) {
  Changes changes = changes_of(seen);
  const auto same = [&](const Entry& one) {
    return one.size == size && one.function_tolerance == function_tolerance && one.seen == changes;
  };
  Entry& entry = [&]() -> Entry& {
    const std::scoped_lock lock(mutex_);
    const auto found = std::ranges::find_if(entries_, same);
    if (found != entries_.end()) return *found;
    return entries_.emplace_back(std::move(changes), size, function_tolerance);
  }();
  std::call_once(entry.once, [&] {
    Trained law = train();
    entry.weights = changes_of(law.weights);
    law.weights.clear();
    entry.law = std::move(law);
  });
  Trained law = entry.law;
  law.weights.resize(seen.size());
  for (std::size_t k = 0; k < entry.weights.size(); ++k) {
    const std::size_t end = k + 1 < entry.weights.size() ? entry.weights[k + 1].first : seen.size();
    std::fill(law.weights.begin() + static_cast<std::ptrdiff_t>(entry.weights[k].first),
              law.weights.begin() + static_cast<std::ptrdiff_t>(end), entry.weights[k].second);
  }
  return law;
}

}  // namespace kerf::fitting

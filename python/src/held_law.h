#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "laws/law_file.h"
#include "laws/placement.h"

namespace kerf::python {

/// A law with its file. It never changes: states of any thread share it.
struct HeldLaw {
  explicit HeldLaw(bench::LawFile read)
      : file(std::move(read)), axes(bench::axes_of(file)), spatial(file.law.is_spatial()) {}

  bench::LawFile file;
  std::vector<models::LawAxis> axes;
  bool spatial;
};
using SharedLaw = std::shared_ptr<HeldLaw>;

}  // namespace kerf::python

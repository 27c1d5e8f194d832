#pragma once

#include <optional>
#include <string>

#include <kerf/models/motion.h>

#include "program/verb.h"

namespace kerf::bench {

/// A contact that the command line puts in place of the one that is known.
struct ContactArguments {
  std::optional<double> position;
  std::string direction;

  [[nodiscard]] bool given() const { return position || !direction.empty(); }
  [[nodiscard]] models::Contact over(models::Contact known) const;
};

/// Adds --contact and --direction; `known` says where the contact stands otherwise.
void add_contact_options(Verb& verb, ContactArguments& arguments, const std::string& known);

}  // namespace kerf::bench

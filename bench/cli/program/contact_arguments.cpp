#include "program/contact_arguments.h"

namespace kerf::bench {

models::Contact ContactArguments::over(models::Contact known) const {
  if (position) known.position = *position;
  if (!direction.empty()) known.direction = direction == "increasing" ? 1.0 : -1.0;
  return known;
}

void add_contact_options(Verb& verb, ContactArguments& arguments, const std::string& known) {
  verb.add_option("--contact", arguments.position,
                  "Position where the penetration is zero, in the axis' unit (default: " + known + ")");
  verb.add_option("--direction", arguments.direction, "Direction into the tissue (default: " + known + ")")
      .one_of({"increasing", "decreasing"});
}

}  // namespace kerf::bench

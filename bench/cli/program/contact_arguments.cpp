#include "program/contact_arguments.h"

namespace kerf::bench {

void add_contact_options(Verb& verb, AskedContact& contact, const std::string& known) {
  verb.add_option("--contact", contact.position,
                  "Position where the penetration is zero, in the axis' unit (default: " + known + ")");
  verb.add_option("--direction", contact.direction, "Direction into the tissue (default: " + known + ")")
      .one_of({"increasing", "decreasing"});
}

}  // namespace kerf::bench

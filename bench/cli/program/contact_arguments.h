#pragma once

#include <string>

#include "fits/asked_fit.h"
#include "program/verb.h"

namespace kerf::bench {

/// Adds --contact and --direction; `known` says where the contact stands otherwise.
void add_contact_options(Verb& verb, AskedContact& contact, const std::string& known);

}  // namespace kerf::bench

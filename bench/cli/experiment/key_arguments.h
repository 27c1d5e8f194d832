#pragma once

#include <optional>
#include <string>

#include <kerf/schema/session.h>

#include "program/verb.h"
#include "sealed/seal.h"

namespace kerf::bench {

/// How a verb gets at the key of a session: a key file, or else a passphrase that is asked for at the
/// terminal.
struct KeyArguments {
  std::string key_file;
  std::optional<std::string> passphrase;  ///< once it was asked for: it serves for several files
};

void add_key_options(Verb& verb, KeyArguments& arguments);

/// Of a session that exists. @throws std::invalid_argument: the file was sealed the other way, or there is no
/// terminal to ask at; std::system_error.
[[nodiscard]] SealKey key_for(KeyArguments& arguments, const schema::KeyDerivation& derivation);

/// Of a session to be made: a passphrase is asked for twice, and is 8 characters or longer.
[[nodiscard]] SealKey new_key_for(KeyArguments& arguments, const schema::KeyDerivation& derivation);

}  // namespace kerf::bench

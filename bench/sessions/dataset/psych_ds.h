#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dataset/registration_text.h"
#include "sealed/session_store.h"

namespace kerf::bench {

/// What the sessions do not say of themselves.
struct DatasetNotes {
  std::string description;           ///< empty: made of the protocol
  std::string licence;               ///< SPDX or an address; empty: none is given
  std::vector<std::string> authors;  ///< none: nobody is named
};

/// Writes sessions of one protocol, open to all, into a new folder as a Psych-DS dataset (schema 1.5.0):
///
///     dataset_description.json    JSON-LD; variableMeasured has every column of every table, with its unit
///     README.md
///     data/task-DESIGN_description-trials_data.csv, -slots_data.csv, -participants_data.csv
///     documentation/methods.md
///     materials/protocol.toml, materials/laws/
///
/// Of an experiment (or nullptr) also materials/experiment.toml, as it was registered, and
/// documentation/experiment.log.
///
/// @throws std::invalid_argument: no session, two protocols, a session that is there twice; the folder exists
///         and not `replace`. std::system_error.
void write_dataset(const std::vector<const SessionStore*>& sessions, const DatasetExperiment* experiment,
                   const DatasetNotes& notes, const std::filesystem::path& folder, bool replace);

/// Whether it could be written there. @throws as require_output() does.
void require_dataset_output(const std::filesystem::path& folder, bool replace);

}  // namespace kerf::bench

#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <kerf/fitting/fit.h>
#include <kerf/fitting/floor.h>
#include <kerf/schema/recording.h>

#include "inspect/counted_rows.h"
#include "laws/law_file.h"
#include "laws/render.h"
#include "recordings/row_span.h"

namespace kerf::bench {

struct FitRecordingOptions {
  std::vector<std::string> models;  ///< "all": every law whose units fit the axis; empty: models_of()
  std::size_t axis = 0;
  std::optional<models::Contact> contact;  ///< by default contact_of() the recording
  std::size_t segments = 5;                ///< of the piecewise law
  std::vector<std::string> law_options;    ///< NAME=VALUE, each for the laws that have it
  RowChoice rows{};                        ///< that count
  double loop_rate_hz = 1000.0;            ///< of the loop that errors as rendered are of
  bool floor = true;                       ///< also what is possible at all
  fitting::FitOptions fit;
  const std::atomic<bool>* stop = nullptr;   ///< no further law is begun then
  std::atomic<std::size_t>* done = nullptr;  ///< counts to steps_of()
};

/// A recording with what a fit has to know of it.
struct FitSource {
  const schema::Recording* recording = nullptr;
  std::string name;  ///< in the names of law files and in tables
  std::size_t axis = 0;
  models::Contact contact;
  double noise_n = 0.0;  ///< 0: not known
  /// Rows whose force is not the tissue's alone: laws run through them, and are neither fitted to nor judged
  /// by them.
  std::vector<RowSpan> not_the_tissue{};
  std::function<void()> taken{};  ///< called when no row of the recording is asked for any more
};

/// One law fitted to one recording or several: the result, and the law as it will be rendered.
struct FittedLaw {
  fitting::FitResult result;
  LawFile file;                 ///< with the rendering aids of laws that have branches
  std::vector<LawFile> others;  ///< of the further recordings, where their parameters or contacts differ
};

/// What a fit took from a recording.
struct FittedRecording {
  std::string name;
  std::string uuid;
  std::string content_sha256{};  ///< of what was sampled; empty until the fits are written
  std::string cycles_sha256{};   ///< of the cycles along its axis, cycles_sha256_of(); empty without any
  std::string axis;
  models::Contact contact;
  std::optional<double> contact_error{};  ///< standard error; none where nobody says
  std::size_t samples = 0;
  std::size_t left_out = 0;  ///< rows that are not finite
  std::size_t counted = 0;   ///< rows that count
  std::vector<LeftOutCycle> cycles_left_out;
  double noise_n = 0.0;
};

/// A law that could not be fitted.
struct Refusal {
  std::string model;
  std::string why;
};

/// All laws fitted to one recording, or to several at once.
struct RecordingFit {
  std::vector<FittedRecording> recordings;
  double line_rmse_n = 0.0;  ///< of a straight line of force over penetration
  double line_cv_rmse_n = std::numeric_limits<double>::quiet_NaN();  ///< of one on held-out cycles; NaN: none
  double jnd_n = 0.0;                                                ///< at the root mean square force
  std::vector<FittedLaw> laws;
  std::vector<Refusal> refusals;
  fitting::Choice choice;
  std::optional<fitting::Floor> floor;
  std::vector<std::string> warnings;
  fitting::FitOptions settings;  ///< as asked for
  RowChoice rows;                ///< as asked for
  double loop_rate_hz = 0.0;     ///< as asked for

  [[nodiscard]] std::size_t samples() const;
  /// What is to blame for the error of a law, in one sentence; empty where nothing is.
  [[nodiscard]] std::string blame(const FittedLaw& law) const;
  /// Why no law could be fitted, where all refused for one reason; else empty.
  [[nodiscard]] std::string refusal() const;
};

/// Fits laws to an axis of a recording. A law that cannot be fitted is a refusal.
/// @throws std::invalid_argument for an unknown law or option, or a recording without force;
///         std::system_error if it was stopped.
[[nodiscard]] RecordingFit fit_recording(const schema::Recording& recording,
                                         const FitRecordingOptions& options);

/// Fits laws to several recordings at once; `options.axis` and `options.contact` are those of the sources.
[[nodiscard]] RecordingFit fit_recordings(std::span<const FitSource> sources,
                                          const FitRecordingOptions& options);

/// Options of a law with the rendering aids of [Okamura2003] added (velocity filter, ramp band, reversal
/// scaling) if it has branches, scaled to a series of what it met.
[[nodiscard]] models::Options with_rendering_aids(models::Options options, const AxisSeries& series);

/// The laws that say something of any recording along an axis, in the order of their facts.
[[nodiscard]] std::vector<std::string> usual_laws();

/// The laws that are asked for, each once: those named, every scalar law for "all", or the usual ones.
[[nodiscard]] std::vector<std::string> models_of(const FitRecordingOptions& options);

/// The parts of the fits of models_of(), and what is found of all of them together, such as the floor.
[[nodiscard]] std::size_t steps_of(const FitRecordingOptions& options);

}  // namespace kerf::bench

#include "subject/subject_words.h"

#include <algorithm>

#include <fmt/format.h>

namespace kerf::bench {

std::string_view name_of(SessionStage stage) noexcept {
  switch (stage) {
    case SessionStage::welcome:
      return "welcome";
    case SessionStage::consent:
      return "consent";
    case SessionStage::instructions:
      return "instructions";
    case SessionStage::trial:
      return "trial";
    case SessionStage::feedback:
      return "feedback";
    case SessionStage::pause:
      return "pause";
    case SessionStage::finished:
      return "finished";
  }
  return "unknown";
}

std::string heading(const SubjectView& view) {
  switch (view.stage) {
    case SessionStage::welcome:
      return "Welcome";
    case SessionStage::consent:
      return "Your consent";
    case SessionStage::instructions:
      return "What you will do";
    case SessionStage::trial:
      return view.text.empty() ? "Which one?" : view.text;
    case SessionStage::feedback:
      return "After this practice trial";
    case SessionStage::pause:
      return "Time for a break";
    case SessionStage::finished:
      return "Finished";
  }
  return {};
}

std::string text_below(const SubjectView& view) {
  if (view.stage == SessionStage::trial) return {};
  if (!view.text.empty()) return view.text;
  switch (view.stage) {
    case SessionStage::pause:
      return "Take your hand off the device and rest it.";
    case SessionStage::finished:
      return "Thank you. You may let go of the device.";
    default:
      return {};
  }
}

std::string progress(const SubjectView& view) {
  if (view.trial == 0) return {};
  return fmt::format("{} {} of {}{}", view.practice ? "Practice trial" : "Trial", view.trial,
                     view.may_be_fewer ? "at most " : "", view.at_most);
}

std::string what_plays(const SubjectView& view) {
  if (view.stage != SessionStage::trial) return {};
  if (!view.playing || *view.playing >= view.labels.size()) return "Nothing plays now.";
  return fmt::format("You feel {} now.", view.labels[*view.playing]);
}

std::string label_list(const SubjectView& view, std::size_t count) {
  count = std::min(count, view.labels.size());
  std::string list;
  for (std::size_t slot = 0; slot < count; ++slot) {
    if (slot > 0) list += slot + 1 == count ? " or " : ", ";
    list += view.labels[slot];
  }
  return list;
}

}  // namespace kerf::bench

#include "poses/orientation_form.h"

#include <algorithm>

#include "files/trimmed.h"

namespace kerf::bench {
namespace {

using FormKind = OrientationForm::Kind;

std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  const auto end = std::min(text.find(' '), text.size());
  const std::string_view word = text.substr(0, end);
  text = trimmed(text.substr(end));
  return word;
}

/// Three letters, of which no two neighbours are the same: a turn about one axis twice is one turn.
bool is_euler_order(std::string_view order) {
  const auto all_of = [&](std::string_view letters) {
    return order.find_first_not_of(letters) == std::string_view::npos;
  };
  return order.size() == 3 && (all_of("xyz") || all_of("XYZ")) && order[0] != order[1] &&
         order[1] != order[2];
}

std::string_view word_of(FormKind kind) {
  switch (kind) {
    case FormKind::quaternion:
      return "quaternion";
    case FormKind::rotation_vector:
      return "rotvec";
    case FormKind::euler:
      return "euler";
    case FormKind::matrix:
      return "matrix";
  }
  return "";
}

std::optional<OrientationForm> take_form(std::string_view& text) {
  const std::string_view kind = take_word(text);
  if (kind == word_of(FormKind::rotation_vector))
    return OrientationForm{.kind = FormKind::rotation_vector, .order = {}};
  std::string_view rest = text;
  std::string order(take_word(rest));
  if (order == "inverse") {
    order.clear();  // of a matrix, whose rows need not be said
  } else {
    text = rest;
  }
  if (kind == word_of(FormKind::quaternion) && (order == "xyzw" || order == "wxyz"))
    return OrientationForm{.kind = FormKind::quaternion, .order = order};
  if (kind == word_of(FormKind::euler) && is_euler_order(order))
    return OrientationForm{.kind = FormKind::euler, .order = order};
  if (kind == word_of(FormKind::matrix) && (order.empty() || order == "rows" || order == "columns"))
    return OrientationForm{.kind = FormKind::matrix, .order = order.empty() ? "rows" : order};
  return std::nullopt;
}

}  // namespace

std::size_t OrientationForm::columns() const noexcept {
  switch (kind) {
    case Kind::quaternion:
      return 4;
    case Kind::rotation_vector:
    case Kind::euler:
      return 3;
    case Kind::matrix:
      return 9;
  }
  return 0;
}

std::string OrientationForm::text() const {
  std::string text(word_of(kind));
  if (!order.empty()) text += " " + order;
  if (is_inverse) text += " inverse";
  return text;
}

bool OrientationForm::has_angles() const noexcept {
  return kind == Kind::rotation_vector || kind == Kind::euler;
}

std::optional<OrientationForm> take_orientation_form(std::string_view& text) {
  std::optional<OrientationForm> form = take_form(text);
  std::string_view rest = text;
  if (!form || take_word(rest) != "inverse") return form;
  text = rest;
  form->is_inverse = true;
  return form;
}

}  // namespace kerf::bench

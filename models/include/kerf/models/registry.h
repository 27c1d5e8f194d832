#pragma once

#include <tuple>

#include <kerf/models/blade.h>
#include <kerf/models/exponential.h>
#include <kerf/models/fracture.h>
#include <kerf/models/friction.h>
#include <kerf/models/fuzzy_kelvin.h>
#include <kerf/models/fuzzy_kelvin_3d.h>
#include <kerf/models/fuzzy_rupture.h>
#include <kerf/models/hunt_crossley.h>
#include <kerf/models/kelvin.h>
#include <kerf/models/law_facts.h>
#include <kerf/models/maxwell.h>
#include <kerf/models/orthogonal.h>
#include <kerf/models/piecewise.h>
#include <kerf/models/precontact.h>
#include <kerf/models/recording.h>
#include <kerf/models/scissors_analytic.h>
#include <kerf/models/scissors_free.h>
#include <kerf/models/scissors_mesh.h>
#include <kerf/models/springpot.h>

namespace kerf::models {

template <typename L>
struct Registered {
  static_assert(RegistrableLaw<L>, "a law without its facts, or with some that contradict (law_facts.h)");
  using Law = L;
};
template <typename... L>
using LawList = std::tuple<typename Registered<L>::Law...>;

/// Every law, once. A new law is one header, its line here, one test and one example.
///
/// A scalar law is templated, so that the law that is fitted is the one that is rendered, and its step takes
/// a Motion along one axis. A spatial law names its axes and its step takes a SpatialMotion.
using Registry = LawList<Kelvin<double>, Maxwell<double>, Springpot<double>, Exponential<double>,
                         HuntCrossley<double>, Friction<double>, Piecewise<double>, Recording<double>,
                         ScissorsAnalytic<double>, Precontact<double>, Fracture<double>, FuzzyRupture<double>,
                         FuzzyKelvin<double>, FuzzyKelvin3d, Blade, ScissorsFree, ScissorsMesh, Orthogonal>;

}  // namespace kerf::models

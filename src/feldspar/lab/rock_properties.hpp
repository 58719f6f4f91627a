// The properties of a rock over its packings, each once: name, unit, words, which tests they need, where they come from.
//
// summarise() is a loop over this table; so are the words and the order of tables for users (output/user_units.cpp), the tests
// that a claim needs (findings/check_claims.cpp), and the units of a calibration's targets. What is read from one test is told of
// by lab/quantities.hpp.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "feldspar/lab/properties.hpp"
#include "feldspar/lab/quantities.hpp"

namespace feldspar {

struct RockProperty {
    /// Where a packing's value comes from. A formed one stands here for its words alone: what forms it are the studies of
    /// envelopes.
    enum class Source { test, ratio, envelope, shear_envelope, confined_strength, formed };

    std::string_view name;  ///< without unit: "E", "UCS", "cohesion"
    QuantityUnit unit;
    std::string label;   ///< "Uniaxial compressive strength"
    std::string symbol;  ///< "UCS"
    std::string_view definition;
    Source source = Source::formed;
    std::set<MethodId> tests{};              ///< that it needs, all of them
    const TestQuantity* quantity = nullptr;  ///< of source test: the number of it
    bool of_broken_only = false;             ///< of source test: a strength, which a test has whose peak was reached
    std::string_view above{}, below{};       ///< of source ratio: names of properties
    double EnvelopeFit::*fit = nullptr;      ///< of source envelope
    double ShearFit::*shear_fit = nullptr;   ///< of source shear_envelope
    std::string_view laboratory{};           ///< the key of a job's [laboratory] that it compares with; empty without one

    /// In PropertySummary: "E_Pa".
    std::string kept_name() const { return unit.kept_name(name); }
    /// A laboratory has a number of just this: what comparisons begin with. (It may compare with other definitions, too.)
    bool reported() const { return laboratory == name; }
};

/// All, in the order of a table of results: what a laboratory reports first, then how it was reached.
std::span<const RockProperty> rock_properties();

/// By its name without unit ("E"); null if there is none.
const RockProperty* rock_property(std::string_view name);

/// By its name in PropertySummary ("E_Pa"); null if there is none. All confined strengths are one property.
const RockProperty* kept_rock_property(std::string_view kept_name);

/// The strength under a lateral pressure, by its name in PropertySummary: "sigma1_at_sigma3_10MPa_Pa".
std::string confined_strength(double sigma3_Pa);

/// The lateral pressure in such a name, MPa; empty for any other name.
std::optional<double> pressure_of_confined_strength_MPa(std::string_view kept_name);

}  // namespace feldspar
